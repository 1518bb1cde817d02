// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: rows of sparse matrices of 3 x 3 blocks.

#include <tanktread/base/target_clones.h>
#include <tanktread/solver/block_rows.h>

#include <algorithm>
#include <cstring>
#include <stdexcept>

namespace tanktread
{
  namespace
  {
    typedef double Four __attribute__((vector_size(32), aligned(8)));
    typedef float  FourSingle __attribute__((vector_size(16), aligned(4)));

    /** y = b + factor A x, b left out if null. */
    TANKTREAD_CLONES_AVX2 void
    add_product(const int                          n_rows,
                const int *const                   starts,
                const int *const                   columns,
                const std::array<float, 12> *const blocks,
                const double *const                x,
                const double                       factor,
                const double *const                b,
                double *const                      y)
    {
      for (int i = 0; i < n_rows; ++i)
        {
          Four sum = {0., 0., 0., 0.};
          for (int k = starts[i]; k < starts[i + 1]; ++k)
            {
              const double *const x_j = x + 4 * columns[k];
              for (int d = 0; d < 3; ++d)
                {
                  FourSingle column;
                  std::memcpy(&column, &blocks[k][4 * d], sizeof(column));
                  sum += __builtin_convertvector(column, Four) * x_j[d];
                }
            }
          sum *= factor;
          if (b != nullptr)
            {
              Four b_i;
              std::memcpy(&b_i, b + 4 * i, sizeof(b_i));
              sum += b_i;
            }
          std::memcpy(y + 4 * i, &sum, sizeof(sum));
        }
    }
  } // namespace


  void
  BlockPattern::add_row(const std::vector<int> &columns_of_row)
  {
    value_starts.push_back(9 * starts.back());
    columns.insert(columns.end(), columns_of_row.begin(), columns_of_row.end());
    starts.push_back(int(columns.size()));
  }


  int
  BlockPattern::place(const int row, const int column) const
  {
    const auto begin = columns.begin() + starts[row], end = columns.begin() + starts[row + 1], found = std::find(begin, end, column);
    if (found == end)
      throw std::logic_error("BlockPattern: there is no such block.");
    return int(found - begin);
  }


  BlockRows::BlockRows(const BlockPattern &pattern, const int begin, const int end)
    : begin_(begin)
    , columns_(pattern.columns.begin() + pattern.starts[begin], pattern.columns.begin() + pattern.starts[end])
    , blocks_(columns_.size(), std::array<float, 12>{})
  {
    for (int i = begin; i < end; ++i)
      starts_.push_back(pattern.starts[i + 1] - pattern.starts[begin]);
  }


  void
  BlockRows::set(const BlockPattern &pattern, const double *const values)
  {
    for (int i = begin(); i < end(); ++i)
      {
        const int           length = pattern.length(i);
        const double *const row    = values + pattern.value_starts[i];
        for (int k = 0; k < length; ++k)
          for (int c = 0; c < 3; ++c)
            for (int d = 0; d < 3; ++d)
              blocks_[starts_[i - begin()] + k][4 * d + c] = float(row[3 * (c * length + k) + d]);
      }
  }


  void
  BlockRows::set_zero()
  {
    std::fill(blocks_.begin(), blocks_.end(), std::array<float, 12>{});
  }


  void
  BlockRows::multiply(const PaddedField &x, PaddedField &y) const
  {
    add_product(end() - begin(), starts_.data(), columns_.data(), blocks_.data(), x.data(), 1., nullptr, &y[4 * begin()]);
  }


  void
  BlockRows::residual(const PaddedField &b, const PaddedField &x, PaddedField &r) const
  {
    add_product(end() - begin(), starts_.data(), columns_.data(), blocks_.data(), x.data(), -1., &b[4 * begin()], &r[4 * begin()]);
  }
} // namespace tanktread
