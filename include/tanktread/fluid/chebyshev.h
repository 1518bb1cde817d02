// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: Chebyshev iteration on full arrays, and the largest eigenvalue that it needs.

#ifndef tanktread_fluid_chebyshev_h
#define tanktread_fluid_chebyshev_h

#include <deal.II/base/mpi.h>

#include <tanktread/fluid/node_space.h>

#include <algorithm>
#include <cmath>
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
    const std::vector<Number>     &inverse_diagonal;
    dealii::AlignedVector<Number> &x, &b, &Ax, &direction;
  };

  /**
   * x += p(D^{-1} A) D^{-1} (b - A x) with the Chebyshev polynomial of the range; x counts as zero before if `from_zero`. Afterwards Ax is that before the last step.
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


  /** Largest eigenvalue of the symmetric matrix with `diagonal` and, beside it, `beside` (one shorter), by bisection: above it all pivots of the matrix minus x are negative. */
  inline double
  largest_tridiagonal_eigenvalue(const std::vector<double> &diagonal, const std::vector<double> &beside)
  {
    double low = diagonal[0], high = diagonal[0];
    for (std::size_t i = 0; i < diagonal.size(); ++i)
      high = std::max(high, diagonal[i] + (i > 0 ? beside[i - 1] : 0.) + (i < beside.size() ? beside[i] : 0.));
    while (high - low > 1e-6 * high)
      {
        const double middle = 0.5 * (low + high);
        double       pivot  = diagonal[0] - middle;
        for (std::size_t i = 1; i < diagonal.size() && pivot < 0.; ++i)
          pivot = diagonal[i] - middle - beside[i - 1] * beside[i - 1] / pivot;
        (pivot < 0. ? high : low) = middle;
      }
    return high;
  }


  /**
   * Largest eigenvalue of D^{-1} A by `n_steps` of Lanczos' method from a rough start: a lower bound, one to three per cent below, for which power iteration would need a hundred
   * steps. The start depends on the numbering, and so does the last per cent. x, Ax and direction are overwritten. Collective.
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

    // Orthogonal vectors with respect to D: D^{-1} A x = alpha x + x_next / scale + beta^2 scale_before x_before. Norms are measured, not computed as small differences; the scale keeps them near one.
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
} // namespace tanktread

#endif
