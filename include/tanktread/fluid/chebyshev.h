// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: Chebyshev iteration on full arrays, and the largest eigenvalue that it needs.

#ifndef tanktread_fluid_chebyshev_h
#define tanktread_fluid_chebyshev_h

#include <deal.II/base/mpi.h>

#include <tanktread/fluid/node_space.h>

#include <cmath>
#include <utility>
#include <vector>

namespace tanktread
{
  /** Polynomial of some degree that is small on [lower, upper], one at zero. */
  struct ChebyshevRange
  {
    unsigned int degree;
    double       lower, upper; // eigenvalues of D^{-1} A
  };

  /** Arrays of an iteration for A x = b on the owned nodes of a space; full arrays but for the diagonal, which has one number a node. */
  template <typename Number>
  struct ChebyshevArrays
  {
    const std::vector<Number>           &inverse_diagonal;
    dealii::AlignedVector<Number>       &x;
    const dealii::AlignedVector<Number> &b;
    dealii::AlignedVector<Number>       &Ax, &direction;
  };

  /**
   * x += p(D^{-1} A) D^{-1} (b - A x) with the Chebyshev polynomial of the range; x counts as zero before if `from_zero`. Afterwards Ax is that before the last
   * step.
   *
   * @param apply apply(x, y) makes y = A x on owned nodes. @tparam stride numbers a node.
   */
  template <unsigned int stride, typename Number, typename Apply>
  void
  chebyshev(const Apply &apply, const ChebyshevRange &range, const ChebyshevArrays<Number> &arrays, const bool from_zero)
  {
    const double      center = 0.5 * (range.upper + range.lower), half = 0.5 * (range.upper - range.lower);
    const std::size_t n   = arrays.inverse_diagonal.size();
    double            rho = half / center, of_direction = 0., of_residual = 1. / center;
    for (unsigned int step = 0; step < range.degree; ++step)
      {
        const bool first = step == 0 && from_zero;
        if (!first)
          apply(arrays.x.data(), arrays.Ax.data());
        Number *const x = arrays.x.data(), *const direction = arrays.direction.data();
        const Number *const b = arrays.b.data(), *const Ax = arrays.Ax.data(), *const inverse_diagonal = arrays.inverse_diagonal.data();
        const Number f_d = of_direction, f_r = of_residual;
        if (first)
          for (std::size_t i = 0; i < n; ++i)
            for (std::size_t j = stride * i; j < stride * (i + 1); ++j)
              x[j] = direction[j] = f_r * inverse_diagonal[i] * b[j];
        else if (step == 0)
          for (std::size_t i = 0; i < n; ++i)
            for (std::size_t j = stride * i; j < stride * (i + 1); ++j)
              x[j] += direction[j] = f_r * inverse_diagonal[i] * (b[j] - Ax[j]);
        else
          for (std::size_t i = 0; i < n; ++i)
            for (std::size_t j = stride * i; j < stride * (i + 1); ++j)
              x[j] += direction[j] = f_d * direction[j] + f_r * inverse_diagonal[i] * (b[j] - Ax[j]);
        const double next = 1. / (2. * center / half - rho);
        of_direction      = next * rho;
        of_residual       = 2. * next / half;
        rho               = next;
      }
  }


  /** Largest eigenvalue of the symmetric matrix with `diagonal` and, beside it, `beside` (one shorter). */
  double
  largest_tridiagonal_eigenvalue(const std::vector<double> &diagonal, const std::vector<double> &beside);


  /**
   * Largest eigenvalue of D^{-1} A by `n_steps` of Lanczos' method from a rough start: a lower bound, one to three per cent below, for which power iteration
   * would need a hundred steps. The start depends on the numbering, and so does the last per cent. x, Ax and direction are overwritten. Collective.
   */
  template <unsigned int stride, typename Number, typename Apply>
  double
  largest_eigenvalue(const Apply &apply, const NodeSpace &space, const ChebyshevArrays<Number> &arrays, const unsigned int n_steps = 12)
  {
    const auto        first = space.first_owned();
    const std::size_t n     = space.n_owned();
    Number *const x = arrays.x.data(), *const Ax = arrays.Ax.data(), *const before = arrays.direction.data();
    const Number *const inverse_diagonal = arrays.inverse_diagonal.data();
    const unsigned int  n_numbers        = space.n_components();
    for (std::size_t i = 0; i < n; ++i)
      for (unsigned int c = 0; c < stride; ++c)
        {
          x[stride * i + c]      = c < n_numbers ? ((first + i) * 2654435761u + 40503u * c) % 1024 / Number(512) - Number(1) : Number(0);
          before[stride * i + c] = 0;
        }

    // Orthogonal vectors with respect to D: D^{-1} A x = alpha x + x_next / scale + beta^2 scale_before x_before. Norms are measured, not computed as
    // small differences; the scale keeps them near one.
    std::vector<double> alpha, beta;
    double              xDx_before = 0., scale = 1.;
    for (unsigned int step = 0; step < n_steps; ++step)
      {
        apply(x, Ax);
        std::vector<double> sums(2, 0.); // of x A x and x D x
        for (std::size_t i = 0; i < n; ++i)
          for (std::size_t j = stride * i; j < stride * i + n_numbers; ++j)
            {
              sums[0] += double(x[j]) * Ax[j];
              sums[1] += double(x[j]) * x[j] / inverse_diagonal[i];
            }
        dealii::Utilities::MPI::sum(sums, space.partitioner()->get_mpi_communicator(), sums);
        const double ratio = step > 0 ? sums[1] / (xDx_before * scale) : 0.; // beta^2 times the scale before
        if (step > 0)
          {
            const double next_beta = std::sqrt(ratio / scale);
            if (!(next_beta > 1e-4 * alpha[0]))
              break; // no direction is left but rounding
            beta.push_back(next_beta);
          }
        alpha.push_back(sums[0] / sums[1]);
        xDx_before       = sums[1];
        scale            = 1. / (step > 0 ? beta.back() : alpha.back());
        const Number a_n = alpha.back(), r_n = ratio, s_n = scale;
        for (std::size_t i = 0; i < n; ++i)
          for (std::size_t j = stride * i; j < stride * i + n_numbers; ++j)
            {
              const Number next = s_n * (inverse_diagonal[i] * Ax[j] - a_n * x[j] - r_n * before[j]);
              before[j]         = x[j];
              x[j]              = next;
            }
      }
    return largest_tridiagonal_eigenvalue(alpha, beta);
  }


  /** Which eigenvalues of D^{-1} A a smoother reduces: those from largest / range to largest * safety, by a polynomial of this degree. */
  struct ChebyshevOptions
  {
    unsigned int degree = 2;
    double       range  = 5.;
    double       safety = 1.;
  };

  /**
   * Chebyshev iteration in D^{-1} A for A x = b on the owned nodes of a space, a fixed number of steps. Operator: has apply(x, y), which makes y = A x on owned
   * nodes of full arrays and may fill the rest of x. @tparam stride numbers a node in full arrays.
   */
  template <typename Operator, typename Number, unsigned int stride>
  class ChebyshevSmoother
  {
  public:
    /** Keeps operator and space by reference; prepare() has to be called before anything else. */
    ChebyshevSmoother(const Operator &A, const NodeSpace &space, const ChebyshevOptions &options = {})
      : A_(A)
      , space_(space)
      , options_(options)
      , Ax_(space.full_size())
      , direction_(space.full_size())
    {}

    /**
     * Takes the inverse diagonal of A, one number an owned node, and estimates the largest eigenvalue. Collective. @param scratch a full array, which is
     * overwritten.
     */
    void
    prepare(std::vector<Number> inverse_diagonal, dealii::AlignedVector<Number> &scratch)
    {
      inverse_diagonal_ = std::move(inverse_diagonal);
      largest_          = tanktread::largest_eigenvalue<stride>(apply(), space_, arrays(scratch, scratch));
    }

    /** x = p(D^{-1} A) D^{-1} b. Both are full arrays. Collective. */
    void
    vmult(dealii::AlignedVector<Number> &x, const dealii::AlignedVector<Number> &b) const
    {
      chebyshev<stride>(apply(), polynomial(), arrays(x, b), true);
    }

    /** x += p(D^{-1} A) D^{-1} (b - A x). Collective. */
    void
    step(dealii::AlignedVector<Number> &x, const dealii::AlignedVector<Number> &b) const
    {
      chebyshev<stride>(apply(), polynomial(), arrays(x, b), false);
    }

    /** b - A x in owned entries of an array that the next call overwrites. Collective. */
    const Number *
    residual(dealii::AlignedVector<Number> &x, const dealii::AlignedVector<Number> &b) const
    {
      A_.apply(x.data(), Ax_.data());
      const std::size_t n = std::size_t(stride) * space_.n_owned();
      for (std::size_t j = 0; j < n; ++j)
        Ax_[j] = b[j] - Ax_[j];
      return Ax_.data();
    }

    /** Estimated largest eigenvalue of D^{-1} A. */
    double
    largest_eigenvalue() const
    {
      return largest_;
    }

  private:
    auto
    apply() const
    {
      return [this](Number *const x, Number *const y) { A_.apply(x, y); };
    }
    ChebyshevRange
    polynomial() const
    {
      return {options_.degree, largest_ / options_.range, largest_ * options_.safety};
    }
    ChebyshevArrays<Number>
    arrays(dealii::AlignedVector<Number> &x, const dealii::AlignedVector<Number> &b) const
    {
      return {inverse_diagonal_, x, b, Ax_, direction_};
    }

    const Operator                       &A_;
    const NodeSpace                      &space_;
    const ChebyshevOptions                options_;
    std::vector<Number>                   inverse_diagonal_;
    double                                largest_ = 0.;
    mutable dealii::AlignedVector<Number> Ax_, direction_; // full arrays
  };
} // namespace tanktread

#endif
