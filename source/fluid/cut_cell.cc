// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: element matrices of the part of a cube that lies inside the shell.

#include <tanktread/base/target_clones.h>
#include <tanktread/fluid/cut_cell.h>
#include <tanktread/fluid/quadratic_element.h>

#include <numeric>

namespace tanktread
{
  namespace
  {
    constexpr int n_gauss = 5;

    /** One-dimensional functions at the Gauss points, in the pairs that the matrices are made of. */
    struct Tables
    {
      double vv[n_gauss][6], dd[n_gauss][6]; // values times values, slopes times slopes of two quadratic functions
      double mv[n_gauss][6], md[n_gauss][6]; // linear function times value or slope of a quadratic one, at 3 j + a
      double ordered[2][2][n_gauss][9];      // value or slope of one quadratic function times value or slope of another, at 3 b + a

      Tables()
      {
        for (int g = 0; g < n_gauss; ++g)
          {
            const double                x = fine_gauss_abscissae()[g];
            const std::array<double, 3> v = quadratic_values(x), d = quadratic_slopes(x);
            for (int a = 0, pair = 0; a < 3; ++a)
              for (int b = a; b < 3; ++b, ++pair)
                {
                  vv[g][pair] = v[a] * v[b];
                  dd[g][pair] = d[a] * d[b];
                }
            for (int b = 0; b < 3; ++b)
              for (int a = 0; a < 3; ++a)
                {
                  ordered[0][0][g][3 * b + a] = v[b] * v[a];
                  ordered[0][1][g][3 * b + a] = v[b] * d[a];
                  ordered[1][0][g][3 * b + a] = d[b] * v[a];
                  ordered[1][1][g][3 * b + a] = d[b] * d[a];
                }
            for (int a = 0; a < 3; ++a)
              {
                mv[g][a]     = (1 - x) * v[a];
                mv[g][3 + a] = x * v[a];
                md[g][a]     = (1 - x) * d[a];
                md[g][3 + a] = x * d[a];
              }
          }
      }
    };

    const Tables tables;


    /** Position of the pair (a, b) in Tables::vv. */
    constexpr int pair_of[3][3] = {{0, 1, 2}, {1, 3, 4}, {2, 4, 5}};

    /**
     * result[p1][p2][p3] += sum over Gauss points of weight t1[g1][p1] t2[g2][p2] t3[g3][p3]; one direction after the other.
     */
    template <int n>
    inline __attribute__((always_inline)) void
    add_products(const CellWeights &weights,
                 const double (&t1)[n_gauss][n],
                 const double (&t2)[n_gauss][n],
                 const double (&t3)[n_gauss][n],
                 double (&result)[n][n][n])
    {
      double x[n_gauss][n_gauss][n] = {}, y[n_gauss][n][n] = {};
      for (int k = 0; k < n_gauss; ++k)
        for (int j = 0; j < n_gauss; ++j)
          for (int i = 0; i < n_gauss; ++i)
            for (int p = 0; p < n; ++p)
              x[k][j][p] += weights[25 * k + 5 * j + i] * t1[i][p];
      for (int k = 0; k < n_gauss; ++k)
        for (int j = 0; j < n_gauss; ++j)
          for (int p2 = 0; p2 < n; ++p2)
            for (int p1 = 0; p1 < n; ++p1)
              y[k][p2][p1] += t2[j][p2] * x[k][j][p1];
      for (int k = 0; k < n_gauss; ++k)
        for (int p3 = 0; p3 < n; ++p3)
          for (int p2 = 0; p2 < n; ++p2)
            for (int p1 = 0; p1 < n; ++p1)
              result[p3][p2][p1] += t3[k][p3] * y[k][p2][p1];
    }


    TANKTREAD_CLONES void
    set_matrices(const CellWeights &weights, PartialCellMatrices &result)
    {
      result.volume           = std::accumulate(weights.begin(), weights.end(), 0.);
      double laplace[6][6][6] = {};
      add_products(weights, tables.dd, tables.vv, tables.vv, laplace);
      add_products(weights, tables.vv, tables.dd, tables.vv, laplace);
      add_products(weights, tables.vv, tables.vv, tables.dd, laplace);
      for (int a = 0; a < 27; ++a)
        for (int b = 0; b < 27; ++b)
          result.laplace[a][b] = laplace[pair_of[a / 9][b / 9]][pair_of[a / 3 % 3][b / 3 % 3]][pair_of[a % 3][b % 3]];
      for (int c = 0; c < 3; ++c)
        {
          double divergence[6][6][6] = {};
          add_products(weights, c == 0 ? tables.md : tables.mv, c == 1 ? tables.md : tables.mv, c == 2 ? tables.md : tables.mv, divergence);
          for (int j = 0; j < 8; ++j)
            for (int a = 0; a < 27; ++a)
              result.divergence[j][27 * c + a] = divergence[3 * (j / 4) + a / 9][3 * (j / 2 % 2) + a / 3 % 3][3 * (j % 2) + a % 3];
        }
    }


    PartialCellMatrices
    matrices(const CellWeights &weights)
    {
      PartialCellMatrices result;
      set_matrices(weights, result);
      return result;
    }


    TANKTREAD_CLONES void
    set_gradient_products(const CellWeights &weights, GradientProducts &result)
    {
      for (int d = 0; d < 3; ++d)
        for (int c = 0; c <= d; ++c)
          {
            double products[9][9][9] = {};
            add_products(weights, tables.ordered[d == 0][c == 0], tables.ordered[d == 1][c == 1], tables.ordered[d == 2][c == 2], products);
            for (int b = 0; b < 27; ++b)
              for (int a = 0; a < 27; ++a)
                {
                  const double product    = products[3 * (b / 9) + a / 9][3 * (b / 3 % 3) + a / 3 % 3][3 * (b % 3) + a % 3];
                  result[b][a][3 * d + c] = product;
                  result[a][b][3 * c + d] = product;
                }
          }
    }
  } // namespace


  const GradientProducts &
  whole_gradient_products()
  {
    static const GradientProducts result = [] {
      GradientProducts products;
      set_gradient_products(whole_weights(), products);
      return products;
    }();
    return result;
  }


  const PartialCellMatrices &
  whole_cell_matrices()
  {
    static const PartialCellMatrices result = matrices(whole_weights());
    return result;
  }


  PartialCellMatrices
  inside_matrices(const std::array<double, 27> &phi, GradientProducts *const products)
  {
    const CellWeights weights = inside_weights(phi);
    if (products != nullptr)
      set_gradient_products(weights, *products);
    return matrices(weights);
  }
} // namespace tanktread
