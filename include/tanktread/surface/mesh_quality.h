// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: how good a control mesh is for the shape that it has taken.

#ifndef tanktread_surface_mesh_quality_h
#define tanktread_surface_mesh_quality_h

#include <tanktread/surface/subdivision_surface.h>
#include <tanktread/surface/triangle_mesh.h>

#include <Eigen/SparseCholesky>

#include <memory>

namespace tanktread
{
  /** 4 sqrt(3) A / (l_1^2 + l_2^2 + l_3^2) of a triangle: 1 if its sides are equal, 0 if it has no area (Bank and Smith 1997). */
  double
  triangle_quality(const Eigen::Vector3d &a, const Eigen::Vector3d &b, const Eigen::Vector3d &c);

  /** The smallest triangle_quality() of all faces of a control mesh. @param x NP x 3. */
  double
  worst_triangle(const std::vector<std::array<int, 3>> &faces, const ControlPoints &x);

  /** 1 / max |kappa| over the quadrature points, kappa the principal curvatures, in a. Needs second derivatives; throws NumericalError where the surface is degenerate. */
  double
  smallest_radius_of_curvature(const SubdivisionSurface &surface, const ControlPoints &x);

  /** Splits control points into what the next coarser control mesh can follow and the rest, see MeshQuality. */
  class LoopDetail
  {
  public:
    /** `fine` is loop_refine() of `coarse` as far as the faces go. */
    LoopDetail(const TriangleMesh &coarse, const TriangleMesh &fine);

    struct Parts
    {
      ControlPoints coarse, detail; // y and d = x - P y
    };
    Parts
    operator()(const ControlPoints &x) const;

    /** The largest |d . n|. */
    double
    largest(const ControlPoints &x, const ControlPoints &detail) const;

  private:
    std::vector<std::array<int, 3>>                                     faces_;
    SparseMatrix                                                        subdivision_;
    std::unique_ptr<Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>>> normal_equations_;
  };

  /** Figures of one shape, see MeshQuality. */
  struct ShapeQuality
  {
    double worst_triangle  = 1.; // see triangle_quality()
    double smallest_radius = 1.; // of curvature, in a
    double detail          = 0.; // in a; not a number if the control mesh is no refinement of another one
    double detail_ratio    = 0.; // not a number if it is not one of a refinement
  };

  /**
   * Measures shapes of one control mesh with its own points, three a face, whatever those of the shell and of the coupling are.
   *
   * Detail is what of a shape the next coarser control mesh cannot follow: the control mesh x, made of a coarser one by Loop's subdivision P, is split into P y, with y by
   * least squares, and d = x - P y; `detail` is the largest |d_I . n_I|, n the normal of the control mesh at vertex I. Of a smooth shape it falls with the third to fourth power of the spacing. y is split
   * alike, and `detail_ratio` is the detail of x over that of y: about a tenth where the mesh resolves the shape, about one and more where it wrinkles from point to point.
   */
  class MeshQuality
  {
  public:
    explicit MeshQuality(const TriangleMesh &topology);

    /** @param x control points, NP x 3. Throws NumericalError where the surface is degenerate. */
    ShapeQuality
    operator()(const ControlPoints &x) const;

  private:
    std::vector<std::array<int, 3>> faces_;
    SubdivisionSurface              surface_;
    std::vector<LoopDetail>         details_; // of the control mesh and of the next coarser one, as far as there are
  };
} // namespace tanktread

#endif
