// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: the vectors that flexible GMRES keeps.

#include <tanktread/base/counts.h>
#include <tanktread/base/target_clones.h>
#include <tanktread/fluid/krylov_basis.h>

#include <algorithm>
#include <cmath>

namespace tanktread
{
  namespace
  {
    // Short enough that a piece of the double-precision vector stays in the first cache while all the others pass by.
    constexpr std::size_t chunk = 1024;

    TANKTREAD_CLONES double
    product(const float *const v, const double *const w, const std::size_t n)
    {
      // Eight sums, so that the compiler may keep them in registers without changing the order of a sum.
      double      sums[8] = {};
      std::size_t i       = 0;
      for (; i + 8 <= n; i += 8)
        for (unsigned int j = 0; j < 8; ++j)
          sums[j] += v[i + j] * w[i + j];
      for (; i < n; ++i)
        sums[0] += v[i] * w[i];
      return ((sums[0] + sums[4]) + (sums[1] + sums[5])) + ((sums[2] + sums[6]) + (sums[3] + sums[7]));
    }


    TANKTREAD_CLONES void
    add(const double factor, const float *const v, double *const w, const std::size_t n)
    {
      for (std::size_t i = 0; i < n; ++i)
        w[i] += factor * v[i];
    }


    /** Calls f(part of the block, its offset among all blocks, length) for pieces of all blocks. */
    template <typename Vector, typename Function>
    void
    for_chunks(Vector &vector, const Function &f)
    {
      std::size_t offset = 0;
      for (unsigned int b = 0; b < vector.n_blocks(); ++b)
        {
          const std::size_t n = vector.block(b).locally_owned_size();
          for (std::size_t begin = 0; begin < n; begin += chunk)
            f(vector.block(b).begin() + begin, offset + begin, std::min(chunk, n - begin));
          offset += n;
        }
    }
  } // namespace


  void
  KrylovBasis::reinit(const FluidBlockVector &vector)
  {
    n_                       = 0;
    const std::size_t before = length_;
    length_                  = 0;
    for (unsigned int b = 0; b < vector.n_blocks(); ++b)
      length_ += vector.block(b).locally_owned_size();
    if (length_ != before)
      {
        v_.clear();
        z_.clear();
      }
    communicator_ = vector.block(0).get_mpi_communicator();
  }


  float *
  KrylovBasis::grow(Vectors &vectors, const unsigned int n) const
  {
    if (vectors.size() <= n)
      vectors.resize(n + 1);
    vectors[n].resize(length_);
    return vectors[n].data();
  }


  void
  KrylovBasis::append(const FluidBlockVector &vector, const double norm)
  {
    float *const v = grow(v_, n_++);
    for_chunks(vector, [&](const double *const part, const std::size_t offset, const std::size_t n) {
      for (std::size_t i = 0; i < n; ++i)
        v[offset + i] = part[i] / norm;
    });
  }


  void
  KrylovBasis::last(FluidBlockVector &vector) const
  {
    const float *const v = v_[n_ - 1].data();
    for_chunks(vector, [&](double *const part, const std::size_t offset, const std::size_t n) { std::copy(v + offset, v + offset + n, part); });
  }


  void
  KrylovBasis::set_preconditioned(const FluidBlockVector &vector)
  {
    float *const z = grow(z_, n_ - 1);
    for_chunks(vector, [&](const double *const part, const std::size_t offset, const std::size_t n) { std::copy(part, part + n, z + offset); });
  }


  double
  KrylovBasis::orthogonalise(FluidBlockVector &vector, std::vector<double> &coefficients) const
  {
    coefficients.assign(n_, 0.);
    std::vector<double> sums(n_ + 1);
    double              norm = 0.;
    // Once would let the vectors' rounding grow tenfold an iteration.
    for (unsigned int pass = 0; pass < 2; ++pass)
      {
        std::fill(sums.begin(), sums.end(), 0.);
        for_chunks(vector, [&](const double *const part, const std::size_t offset, const std::size_t n) {
          for (unsigned int i = 0; i < n_; ++i)
            sums[i] += product(v_[i].data() + offset, part, n);
          for (std::size_t i = 0; i < n; ++i)
            sums[n_] += part[i] * part[i];
        });
        MPI_Allreduce(MPI_IN_PLACE, sums.data(), mpi_count(sums.size(), "scalar products"), MPI_DOUBLE, MPI_SUM, communicator_);
        for_chunks(vector, [&](double *const part, const std::size_t offset, const std::size_t n) {
          for (unsigned int i = 0; i < n_; ++i)
            add(-sums[i], v_[i].data() + offset, part, n);
        });
        double removed = 0.;
        for (unsigned int i = 0; i < n_; ++i)
          {
            coefficients[i] += sums[i];
            removed += sums[i] * sums[i];
          }
        norm = std::sqrt(std::max(sums[n_] - removed, 0.)); // by Pythagoras; little is removed the second time
      }
    return norm;
  }


  void
  KrylovBasis::add_preconditioned(const std::vector<double> &factors, FluidBlockVector &vector) const
  {
    for_chunks(vector, [&](double *const part, const std::size_t offset, const std::size_t n) {
      for (std::size_t i = 0; i < factors.size(); ++i)
        add(factors[i], z_[i].data() + offset, part, n);
    });
  }
} // namespace tanktread
