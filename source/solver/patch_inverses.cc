// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: the inverses of a shell's matrix on the neighbourhoods of its control points, added up.

#include <tanktread/base/target_clones.h>
#include <tanktread/solver/patch_inverses.h>

#include <algorithm>
#include <set>

namespace tanktread
{
  namespace
  {
    /** Inverts n x n matrices of which the lanes of `a` are one each, in place: Gauss and Jordan's elimination, pivots on the diagonal. */
    template <int n_lanes>
    inline __attribute__((always_inline)) void
    invert_lanes(const int n, double *const a)
    {
      for (int k = 0; k < n; ++k)
        {
          double *const row_k = a + std::size_t(n_lanes) * n * k;
          double        pivot[n_lanes];
          for (int l = 0; l < n_lanes; ++l)
            {
              pivot[l]               = 1. / row_k[n_lanes * k + l];
              row_k[n_lanes * k + l] = 1.;
            }
          for (int j = 0; j < n; ++j)
            for (int l = 0; l < n_lanes; ++l)
              row_k[n_lanes * j + l] *= pivot[l];
          for (int i = 0; i < n; ++i)
            {
              if (i == k)
                continue;
              double *const row_i = a + std::size_t(n_lanes) * n * i;
              double        factor[n_lanes];
              for (int l = 0; l < n_lanes; ++l)
                {
                  factor[l]              = row_i[n_lanes * k + l];
                  row_i[n_lanes * k + l] = 0.;
                }
              for (int j = 0; j < n; ++j)
                for (int l = 0; l < n_lanes; ++l)
                  row_i[n_lanes * j + l] -= factor[l] * row_k[n_lanes * j + l];
            }
        }
    }

    TANKTREAD_CLONES void
    invert_eight(const int n, double *const a)
    {
      invert_lanes<8>(n, a);
    }
  } // namespace


  PatchInverses::PatchInverses(const std::vector<std::vector<int>> &neighbours, const BlockPattern &pattern, const int begin, const int end)
    : begin_(begin)
    , end_(end)
    , size_(0)
  {
    const auto points_of = [&](const int centre) {
      std::vector<int> points(1, centre);
      points.insert(points.end(), neighbours[centre].begin(), neighbours[centre].end());
      return points;
    };
    std::set<int> centres; // of the patches that reach these rows
    for (int i = 0; i < pattern.n_rows(); ++i)
      {
        std::set<int> columns;
        if (i >= begin && i < end)
          for (const int centre : points_of(i))
            {
              const std::vector<int> points = points_of(centre);
              columns.insert(points.begin(), points.end());
              centres.insert(centre);
            }
        pattern_.add_row({columns.begin(), columns.end()});
        size_ = std::max(size_, 1 + int(neighbours[i].size()));
      }
    for (const int centre : centres)
      {
        const std::vector<int> points = points_of(centre);
        n_points_.push_back(int(points.size()));
        for (int a = 0; a < size_; ++a)
          {
            rows_.push_back(a < int(points.size()) ? points[a] : -1);
            for (int b = 0; b < size_; ++b)
              {
                const bool is_point = std::max(a, b) < int(points.size());
                sources_.push_back(is_point ? pattern.value_starts[points[a]] + 3 * pattern.place(points[a], points[b]) : -1);
                const bool is_own = is_point && points[a] >= begin && points[a] < end;
                targets_.push_back(is_own ? pattern_.starts[points[a]] - pattern_.starts[begin] + pattern_.place(points[a], points[b]) : -1);
              }
          }
      }
  }


  void
  PatchInverses::compute(const std::vector<int> &starts, const double *const values, BlockRows &B) const
  {
    const int           n = 3 * size_;
    std::vector<double> a(std::size_t(n_lanes) * n * n);
    B.set_zero();
    for (std::size_t first = 0; first < n_points_.size(); first += n_lanes)
      {
        const std::size_t n_patches = std::min(n_points_.size() - first, std::size_t(n_lanes));
        std::fill(a.begin(), a.end(), 0.);
        for (int l = 0; l < n_lanes; ++l)
          for (int i = 0; i < n; ++i)
            a[n_lanes * (std::size_t(n) * i + i) + l] = 1.; // where a patch is smaller, or missing
        for (std::size_t l = 0; l < n_patches; ++l)
          for (int p = 0; p < n_points_[first + l]; ++p)
            {
              const int row = rows_[size_ * (first + l) + p], stride = 3 * (starts[row + 1] - starts[row]);
              for (int q = 0; q < n_points_[first + l]; ++q)
                {
                  const double *const block = values + sources_[size_ * (size_ * (first + l) + p) + q];
                  for (int c = 0; c < 3; ++c)
                    for (int d = 0; d < 3; ++d)
                      a[n_lanes * (std::size_t(n) * (3 * p + c) + 3 * q + d) + l] = block[stride * c + d];
                }
            }
        invert_eight(n, a.data());
        for (std::size_t l = 0; l < n_patches; ++l)
          for (int p = 0; p < n_points_[first + l]; ++p)
            for (int q = 0; q < n_points_[first + l]; ++q)
              if (const int target = targets_[size_ * (size_ * (first + l) + p) + q]; target >= 0)
                for (int c = 0; c < 3; ++c)
                  for (int d = 0; d < 3; ++d)
                    B.add(target, c, d, a[n_lanes * (std::size_t(n) * (3 * p + c) + 3 * q + d) + l]);
      }
  }
} // namespace tanktread
