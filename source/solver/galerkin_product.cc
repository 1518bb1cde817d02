// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: a shell's matrix on the next coarser control mesh.

#include <tanktread/base/target_clones.h>
#include <tanktread/solver/galerkin_product.h>

#include <algorithm>
#include <set>

namespace tanktread
{
  namespace
  {
    /** Columns of row i of S P. */
    std::vector<int>
    product_columns(const SparseMatrix &P, const BlockPattern &fine, const int i)
    {
      std::set<int> result;
      for (int k = fine.starts[i]; k < fine.starts[i + 1]; ++k)
        for (SparseMatrix::InnerIterator entry(P, fine.columns[k]); entry; ++entry)
          result.insert(int(entry.col()));
      return {result.begin(), result.end()};
    }

    /** sum += factor block, a block's rows being `stride` apart and those of the sum 3. */
    inline __attribute__((always_inline)) void
    add_block(const double factor, const double *const block, const int stride, double *const sum)
    {
      for (int c = 0; c < 3; ++c)
        for (int d = 0; d < 3; ++d)
          sum[3 * c + d] += factor * block[stride * c + d];
    }
  } // namespace


  BlockPattern
  GalerkinProduct::pattern(const SparseMatrix &P, const BlockPattern &fine)
  {
    std::vector<std::set<int>> rows(P.cols());
    for (int i = 0; i < fine.n_rows(); ++i)
      {
        const std::vector<int> columns = product_columns(P, fine, i);
        for (SparseMatrix::InnerIterator entry(P, i); entry; ++entry)
          rows[entry.col()].insert(columns.begin(), columns.end());
      }
    BlockPattern result;
    for (const std::set<int> &row : rows)
      result.add_row({row.begin(), row.end()});
    return result;
  }


  GalerkinProduct::GalerkinProduct(const SparseMatrix &P, const BlockPattern &fine, const int begin, const int end, const BlockPattern &coarse)
    : n_values_(9 * coarse.columns.size())
  {
    for (int i = begin; i < end; ++i)
      {
        const std::vector<int> columns = product_columns(P, fine, i);
        Row                    row{fine.value_starts[i], fine.length(i), int(columns.size()), 0};
        for (int k = fine.starts[i]; k < fine.starts[i + 1]; ++k)
          {
            n_entries_.push_back(0);
            for (SparseMatrix::InnerIterator entry(P, fine.columns[k]); entry; ++entry, ++n_entries_.back())
              {
                weights_.push_back(entry.value());
                places_.push_back(std::lower_bound(columns.begin(), columns.end(), entry.col()) - columns.begin());
              }
          }
        for (SparseMatrix::InnerIterator entry(P, i); entry; ++entry, ++row.n_targets)
          {
            const int target = int(entry.col());
            targets_.push_back({entry.value(), 3 * coarse.length(target)});
            for (const int column : columns)
              offsets_.push_back(coarse.value_starts[target] + 3 * coarse.place(target, column));
          }
        rows_.push_back(row);
      }
  }


  void
  GalerkinProduct::compute(const double *const fine, std::vector<double> &coarse) const
  {
    coarse.assign(n_values_, 0.);
    std::vector<double>   sums;
    const int            *n_entries = n_entries_.data(), *offset = offsets_.data();
    const double         *weight = weights_.data();
    const unsigned short *place  = places_.data();
    const Target         *target = targets_.data();
    for (const Row &row : rows_)
      {
        sums.assign(9 * std::size_t(row.n_columns), 0.);
        for (int k = 0; k < row.length; ++k, ++n_entries)
          for (int e = 0; e < *n_entries; ++e, ++weight, ++place)
            add_block(*weight, fine + row.values + 3 * k, 3 * row.length, &sums[9 * *place]);
        for (int t = 0; t < row.n_targets; ++t, ++target)
          for (int k = 0; k < row.n_columns; ++k, ++offset)
            for (int c = 0; c < 3; ++c)
              for (int d = 0; d < 3; ++d)
                coarse[*offset + target->stride * c + d] += target->weight * sums[9 * k + 3 * c + d];
      }
  }
} // namespace tanktread
