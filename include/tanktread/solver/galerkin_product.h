// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: a shell's matrix on the next coarser control mesh.

#ifndef tanktread_solver_galerkin_product_h
#define tanktread_solver_galerkin_product_h

#include <tanktread/solver/block_rows.h>
#include <tanktread/surface/types.h>

#include <vector>

namespace tanktread
{
  /** P^T S P for one P and matrices S of one pattern, from some rows of S. */
  class GalerkinProduct
  {
  public:
    /** @param P for one component. @param fine pattern of S; its rows begin <= i < end contribute here. @param coarse the result's, which has to hold it. */
    GalerkinProduct(const SparseMatrix &P, const BlockPattern &fine, int begin, int end, const BlockPattern &coarse);

    /** Sets the values of the result to the contribution of these rows. */
    void
    compute(const double *fine, std::vector<double> &coarse) const;

    /** Of the result of all rows. */
    static BlockPattern
    pattern(const SparseMatrix &P, const BlockPattern &fine);

  private:
    /** A row of S: its blocks begin at `values` of S; what it contributes has `n_columns` columns on the coarse mesh and goes to `n_targets` rows. */
    struct Row
    {
      int values, length, n_columns, n_targets;
    };
    /** A row of the result that a row of S contributes to: P's entry, and the distance between the rows of a block. */
    struct Target
    {
      double weight;
      int    stride;
    };

    std::size_t                 n_values_;
    std::vector<Row>            rows_;
    std::vector<int>            n_entries_; // of P's row for each block of S
    std::vector<double>         weights_;   // those entries
    std::vector<unsigned short> places_;    // and which of the columns they go to
    std::vector<Target>         targets_;
    std::vector<int>            offsets_; // of the blocks of each target
  };
} // namespace tanktread

#endif
