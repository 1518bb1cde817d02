// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: a V-cycle on Loop's control meshes for matrices of the shell.

#include <tanktread/base/vector4.h>
#include <tanktread/solver/shell_multigrid.h>

#include <algorithm>
#include <cmath>
#include <random>

namespace tanktread
{
  namespace
  {
    /** Chebyshev's method is for the eigenvalues of B S above a part of the largest one, which power iterations find and this factor makes safe. */
    constexpr double       lowest_part = 0.2, safety = 1.1;
    constexpr unsigned int n_power_iterations = 10, n_test_cycles = 4;

    double
    norm(const PaddedField &field)
    {
      double sum = 0.;
      for (const double value : field)
        sum += value * value;
      return std::sqrt(sum);
    }

    void
    fill_randomly(PaddedField &field)
    {
      std::minstd_rand random(1);
      for (std::size_t i = 0; i < field.size(); ++i)
        field[i] = i % 4 == 3 ? 0. : double(random()) / std::minstd_rand::max() - 0.5;
    }

    /** Entry of row i of matrix times a field. */
    Vector4
    product(const SparseMatrix &matrix, const int i, const PaddedField &field)
    {
      Vector4 sum;
      for (SparseMatrix::InnerIterator entry(matrix, i); entry; ++entry)
        sum += entry.value() * Vector4(&field[4 * entry.col()]);
      return sum;
    }

    Eigen::MatrixXd
    dense(const BlockPattern &pattern, const double *const values)
    {
      const int       n      = pattern.n_rows();
      Eigen::MatrixXd result = Eigen::MatrixXd::Zero(3 * n, 3 * n);
      for (int i = 0; i < n; ++i)
        for (int k = 0; k < pattern.length(i); ++k)
          for (int c = 0; c < 3; ++c)
            for (int d = 0; d < 3; ++d)
              result(3 * i + c, 3 * pattern.columns[pattern.starts[i] + k] + d) = values[pattern.value_starts[i] + 3 * (c * pattern.length(i) + k) + d];
      return result;
    }
  } // namespace


  ShellMultigrid::ShellMultigrid(std::shared_ptr<const LoopHierarchy> hierarchy, const MPI_Comm team)
    : hierarchy_(std::move(hierarchy))
    , team_(team)
  {
    int n_ranks;
    MPI_Comm_size(team, &n_ranks);
    for (const LoopLevel &level : hierarchy_->levels())
      {
        levels_.emplace_back();
        for (PaddedField *field : {&levels_.back().b, &levels_.back().x, &levels_.back().r, &levels_.back().z})
          field->assign(4 * std::size_t(level.n), 0.);
        if (!level.patches)
          break;
        for (int rank = 0; level.is_divided && rank < n_ranks; ++rank)
          {
            levels_.back().starts.push_back(4 * level.first_point(rank, n_ranks));
            levels_.back().counts.push_back(4 * level.first_point(rank + 1, n_ranks) - levels_.back().starts.back());
          }
        levels_.back().S = BlockRows(level.pattern, level.begin, level.end);
        levels_.back().B = level.patches->matrix();
      }
  }


  void
  ShellMultigrid::set_up(const SparseMatrix &S)
  {
    std::vector<double> present, coarse;
    const double       *values = S.valuePtr();
    for (std::size_t l = 0; l + 1 < levels_.size(); ++l)
      {
        const LoopLevel &level = hierarchy_->levels()[l];
        levels_[l].S.set(level.pattern, values);
        level.patches->compute(level.pattern.starts, values, levels_[l].B);
        estimate_eigenvalue(l);
        level.product->compute(values, coarse);
        if (level.is_divided)
          MPI_Allreduce(MPI_IN_PLACE, coarse.data(), int(coarse.size()), MPI_DOUBLE, MPI_SUM, team_);
        present.swap(coarse);
        values = present.data();
      }
    coarsest_.compute(dense(hierarchy_->levels().back().pattern, values));
  }


  void
  ShellMultigrid::estimate_eigenvalue(const std::size_t l)
  {
    Level &level = levels_[l];
    fill_randomly(level.x);
    double growth = 0.;
    for (unsigned int i = 0; i < n_power_iterations; ++i)
      {
        level.S.multiply(level.x, level.r);
        exchange(l, level.r);
        const double before = norm(level.x);
        level.B.multiply(level.r, level.x);
        exchange(l, level.x);
        growth = norm(level.x) / before;
      }
    level.largest_eigenvalue = safety * growth;
  }


  void
  ShellMultigrid::exchange(const std::size_t l, PaddedField &field) const
  {
    const Level &level = levels_[l];
    if (!level.counts.empty())
      MPI_Allgatherv(MPI_IN_PLACE, 0, MPI_DATATYPE_NULL, field.data(), level.counts.data(), level.starts.data(), MPI_DOUBLE, team_);
  }


  void
  ShellMultigrid::residual(const std::size_t l) const
  {
    const Level &level = levels_[l];
    level.S.residual(level.b, level.x, level.r);
  }


  void
  ShellMultigrid::smooth(const std::size_t l, const bool from_zero) const
  {
    const Level &level = levels_[l];
    const double upper = level.largest_eigenvalue, theta = 0.5 * (1. + lowest_part) * upper, delta = 0.5 * (1. - lowest_part) * upper;
    const double sigma = theta / delta, rho_1 = 1. / sigma, rho_2 = 1. / (2. * sigma - rho_1);
    const auto   begin = 4 * std::size_t(level.B.begin()), end = 4 * std::size_t(level.B.end());
    // x_1 = x_0 + B r_0/theta, x_2 = x_1 + rho_2 rho_1 (x_1 - x_0) + 2 rho_2/delta B r_1
    if (!from_zero)
      {
        residual(l);
        exchange(l, level.r);
      }
    level.B.multiply(from_zero ? level.b : level.r, level.z);
    for (std::size_t i = begin; i < end; ++i)
      {
        level.z[i] /= theta;
        level.x[i] = level.z[i] + (from_zero ? 0. : level.x[i]);
      }
    exchange(l, level.x);
    residual(l);
    exchange(l, level.r);
    for (std::size_t i = begin; i < end; ++i)
      level.x[i] += rho_1 * rho_2 * level.z[i];
    level.B.multiply(level.r, level.z);
    for (std::size_t i = begin; i < end; ++i)
      level.x[i] += 2. * rho_2 / delta * level.z[i];
    exchange(l, level.x);
  }


  void
  ShellMultigrid::cycle(const std::size_t l) const
  {
    const Level &level = levels_[l];
    if (l + 1 == levels_.size())
      {
        const int       n = hierarchy_->levels()[l].n;
        Eigen::VectorXd b(3 * n);
        for (int i = 0; i < 3 * n; ++i)
          b[i] = level.b[4 * (i / 3) + i % 3];
        b = coarsest_.solve(b);
        for (int i = 0; i < 3 * n; ++i)
          level.x[4 * (i / 3) + i % 3] = b[i];
        return;
      }
    const LoopLevel &pattern = hierarchy_->levels()[l];
    const Level     &coarse  = levels_[l + 1];
    smooth(l, true);
    residual(l);
    // The transposed prolongation of the rows that this rank has.
    std::fill(coarse.b.begin(), coarse.b.end(), 0.);
    for (int i = pattern.begin; i < pattern.end; ++i)
      {
        const Vector4 r(&level.r[4 * i]);
        for (SparseMatrix::InnerIterator entry(pattern.prolongation, i); entry; ++entry)
          {
            double *const b = &coarse.b[4 * entry.col()];
            (Vector4(b) + entry.value() * r).store(b);
          }
      }
    if (pattern.is_divided)
      MPI_Allreduce(MPI_IN_PLACE, coarse.b.data(), int(coarse.b.size()), MPI_DOUBLE, MPI_SUM, team_);
    cycle(l + 1);
    for (int i = pattern.begin; i < pattern.end; ++i)
      (Vector4(&level.x[4 * i]) + product(pattern.prolongation, i, coarse.x)).store(&level.x[4 * i]);
    exchange(l, level.x);
    smooth(l, false);
  }


  ControlPoints
  ShellMultigrid::solve(const ControlPoints &f) const
  {
    const std::vector<int> &order  = hierarchy_->order();
    const Level            &finest = levels_.front();
    for (std::size_t i = 0; i < order.size(); ++i)
      std::copy_n(f.data() + 3 * order[i], 3, &finest.b[4 * i]);
    cycle(0);
    ControlPoints result(f.rows(), 3);
    for (std::size_t i = 0; i < order.size(); ++i)
      std::copy_n(&finest.x[4 * i], 3, result.data() + 3 * order[i]);
    return result;
  }


  double
  ShellMultigrid::convergence_factor() const
  {
    if (levels_.size() == 1)
      return 0.;
    const Level &finest = levels_.front();
    fill_randomly(finest.b);
    double before = 0., after = norm(finest.b);
    for (unsigned int i = 0; i < n_test_cycles; ++i)
      {
        before = after;
        cycle(0);
        residual(0);
        exchange(0, finest.r);
        finest.b = finest.r;
        after    = norm(finest.b);
      }
    return after / before;
  }
} // namespace tanktread
