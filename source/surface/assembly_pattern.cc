// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: the fixed sparsity pattern of matrices assembled face by face.

#include <tanktread/surface/assembly_pattern.h>

#include <algorithm>
#include <stdexcept>

namespace tanktread
{
  AssemblyPattern::AssemblyPattern(const unsigned int n_control_points, const unsigned int support_size, const std::vector<int> &supports)
    : support_size_(support_size)
    , row_starts_(n_control_points + 1, 0)
    , places_(supports.size() * support_size)
  {
    std::vector<std::vector<int>> rows(n_control_points);
    for (std::size_t face = 0; face < supports.size(); face += support_size_)
      for (unsigned int i = 0; i < support_size_; ++i)
        {
          std::vector<int> &row = rows[supports[face + i]];
          row.insert(row.end(), supports.begin() + face, supports.begin() + face + support_size_);
        }
    for (std::size_t row = 0; row < rows.size(); ++row)
      {
        std::sort(rows[row].begin(), rows[row].end());
        rows[row].erase(std::unique(rows[row].begin(), rows[row].end()), rows[row].end());
        row_starts_[row + 1] = row_starts_[row] + int(rows[row].size());
        columns_.insert(columns_.end(), rows[row].begin(), rows[row].end());
      }
    for (std::size_t face = 0; face < supports.size(); face += support_size_)
      for (unsigned int i = 0; i < support_size_; ++i)
        for (unsigned int j = 0; j < support_size_; ++j)
          {
            const std::vector<int> &row             = rows[supports[face + i]];
            places_[(face + i) * support_size_ + j] = int(std::lower_bound(row.begin(), row.end(), supports[face + j]) - row.begin());
          }
  }


  SparseMatrix
  AssemblyPattern::scalar_matrix() const
  {
    const Eigen::Index  n = Eigen::Index(row_starts_.size()) - 1;
    std::vector<double> zeros(columns_.size(), 0.);
    return Eigen::Map<const SparseMatrix>(n, n, Eigen::Index(columns_.size()), row_starts_.data(), columns_.data(), zeros.data());
  }


  SparseMatrix
  AssemblyPattern::block_matrix() const
  {
    const int    n = int(row_starts_.size()) - 1;
    SparseMatrix matrix(3 * n, 3 * n);
    matrix.resizeNonZeros(9 * Eigen::Index(columns_.size()));
    int *starts = matrix.outerIndexPtr(), *columns = matrix.innerIndexPtr();
    for (int row = 0; row < n; ++row)
      for (int c = 0; c < 3; ++c)
        {
          const int start     = 9 * row_starts_[row] + 3 * c * row_length(row);
          starts[3 * row + c] = start;
          for (int k = 0; k < 3 * row_length(row); ++k)
            columns[start + k] = 3 * columns_[row_starts_[row] + k / 3] + k % 3;
        }
    starts[3 * n] = 9 * row_starts_[n];
    matrix.coeffs().setZero();
    return matrix;
  }


  void
  add_for_three_components(const SparseMatrix &matrix, SparseMatrix &blocks, const Eigen::Matrix3d &components)
  {
    if (blocks.rows() != 3 * matrix.rows() || blocks.nonZeros() != 9 * matrix.nonZeros())
      throw std::logic_error("add_for_three_components() got matrices of different patterns.");
    const int *starts = matrix.outerIndexPtr();
    for (int row = 0; row < matrix.rows(); ++row)
      for (int c = 0; c < 3; ++c)
        {
          double *values = blocks.valuePtr() + blocks.outerIndexPtr()[3 * row + c];
          for (int k = starts[row]; k < starts[row + 1]; ++k, values += 3)
            for (int d = 0; d < 3; ++d)
              values[d] += components(c, d) * matrix.valuePtr()[k];
        }
  }
} // namespace tanktread
