// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: Stokes flows in unbounded liquid, as sums over points.

#include <deal.II/base/numbers.h>

#include <tanktread/base/target_clones.h>
#include <tanktread/fluid/far_field.h>

#include <algorithm>
#include <cmath>

namespace tanktread
{
  namespace
  {
    // Points at a time: their places and velocities stay in the first cache while the sources pass by.
    constexpr std::size_t chunk = 512;

    /** Some points and their velocities. */
    struct Targets
    {
      const double *x, *y, *z;
      double       *u, *v, *w;
      std::size_t   n;
    };

    using Vector = std::array<double, 3>;

    Vector
    row(const Columns &columns, const std::size_t q)
    {
      return {{columns[0][q], columns[1][q], columns[2][q]}};
    }


    // The inner loops go over the targets, so that no sum has to change its order to be computed in vectors.
    TANKTREAD_CLONES void
    add_stokeslet(const Vector &X, const Vector &F, const Targets &t)
    {
      for (std::size_t i = 0; i < t.n; ++i)
        {
          const double x = t.x[i] - X[0], y = t.y[i] - X[1], z = t.z[i] - X[2];
          const double inverse = 1. / std::sqrt(x * x + y * y + z * z);
          const double along   = (x * F[0] + y * F[1] + z * F[2]) * inverse * inverse * inverse;
          t.u[i] += inverse * F[0] + along * x;
          t.v[i] += inverse * F[1] + along * y;
          t.w[i] += inverse * F[2] + along * z;
        }
    }


    TANKTREAD_CLONES void
    add_stresslet(const Vector &X, const Vector &u, const Vector &a, const Targets &t)
    {
      for (std::size_t i = 0; i < t.n; ++i)
        {
          const double x = t.x[i] - X[0], y = t.y[i] - X[1], z = t.z[i] - X[2];
          const double square = x * x + y * y + z * z;
          const double factor = (x * u[0] + y * u[1] + z * u[2]) * (x * a[0] + y * a[1] + z * a[2]) / (square * square * std::sqrt(square));
          t.u[i] += factor * x;
          t.v[i] += factor * y;
          t.w[i] += factor * z;
        }
    }


    TANKTREAD_CLONES void
    add_rotlet(const Vector &X, const Vector &T, const Targets &t)
    {
      for (std::size_t i = 0; i < t.n; ++i)
        {
          const double x = t.x[i] - X[0], y = t.y[i] - X[1], z = t.z[i] - X[2];
          const double square = x * x + y * y + z * z, factor = 1. / (square * std::sqrt(square));
          t.u[i] += factor * (T[1] * z - T[2] * y);
          t.v[i] += factor * (T[2] * x - T[0] * z);
          t.w[i] += factor * (T[0] * y - T[1] * x);
        }
    }


    /** Calls add(q, targets) for all sources and pieces of the targets, and adds factor times the sums to `velocity`. */
    template <typename Add>
    void
    add_sums(const std::size_t n_sources, const double factor, const Columns &x, Columns &velocity, const Add &add)
    {
      std::array<std::array<double, chunk>, 3> sums;
      for (std::size_t begin = 0; begin < x[0].size(); begin += chunk)
        {
          const std::size_t n = std::min(chunk, x[0].size() - begin);
          for (auto &sum : sums)
            sum.fill(0.);
          for (std::size_t q = 0; q < n_sources; ++q)
            add(q, Targets{&x[0][begin], &x[1][begin], &x[2][begin], sums[0].data(), sums[1].data(), sums[2].data(), n});
          for (unsigned int c = 0; c < 3; ++c)
            for (std::size_t i = 0; i < n; ++i)
              velocity[c][begin + i] += factor * sums[c][i];
        }
    }

    constexpr double over_eight_pi = 0.125 / dealii::numbers::PI;
  } // namespace


  void
  add_stokeslets(const Columns &X, const Columns &F, const Columns &x, Columns &velocity)
  {
    add_sums(X[0].size(), over_eight_pi, x, velocity, [&](const std::size_t q, const Targets &targets) { add_stokeslet(row(X, q), row(F, q), targets); });
  }


  void
  add_double_layer(const Columns &X, const Columns &u, const Columns &a, const double factor, const Columns &x, Columns &velocity)
  {
    add_sums(X[0].size(), 6. * factor * over_eight_pi, x, velocity, [&](const std::size_t q, const Targets &targets) {
      add_stresslet(row(X, q), row(u, q), row(a, q), targets);
    });
  }


  void
  add_rotlets(const Columns &X, const Columns &T, const Columns &x, Columns &velocity)
  {
    add_sums(X[0].size(), over_eight_pi, x, velocity, [&](const std::size_t q, const Targets &targets) { add_rotlet(row(X, q), row(T, q), targets); });
  }
} // namespace tanktread
