// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: how good a control mesh is for the shape that it has taken.

#include <Eigen/Geometry>
#include <tanktread/surface/mesh_quality.h>
#include <tanktread/surface/surface_geometry.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

namespace tanktread
{
  namespace
  {
    /** Unit normals of the control mesh at its vertices, means of those of the faces weighted with their areas. */
    ControlPoints
    vertex_normals(const std::vector<std::array<int, 3>> &faces, const ControlPoints &x)
    {
      ControlPoints result = ControlPoints::Zero(x.rows(), 3);
      for (const auto &face : faces)
        {
          const Eigen::RowVector3d a = x.row(face[0]), ab = x.row(face[1]) - a, ac = x.row(face[2]) - a, area = ab.cross(ac);
          for (const int vertex : face)
            result.row(vertex) += area;
        }
      return result.rowwise().normalized();
    }
  } // namespace


  double
  triangle_quality(const Eigen::Vector3d &a, const Eigen::Vector3d &b, const Eigen::Vector3d &c)
  {
    const double squares = (b - a).squaredNorm() + (c - b).squaredNorm() + (a - c).squaredNorm();
    return squares > 0. ? 2. * std::sqrt(3.) * (b - a).cross(c - a).norm() / squares : 0.;
  }


  double
  worst_triangle(const std::vector<std::array<int, 3>> &faces, const ControlPoints &x)
  {
    double result = 1.;
    for (const auto &face : faces)
      result = std::min(result, triangle_quality(x.row(face[0]), x.row(face[1]), x.row(face[2])));
    return result;
  }


  double
  smallest_radius_of_curvature(const SubdivisionSurface &surface, const ControlPoints &x)
  {
    return 1. / largest_curvature(surface, x).maxCoeff();
  }


  LoopDetail::LoopDetail(const TriangleMesh &coarse, const TriangleMesh &fine)
    : faces_(fine.faces)
    , subdivision_(loop_subdivision(coarse))
    , normal_equations_(
        std::make_unique<Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>>>(Eigen::SparseMatrix<double>(subdivision_.transpose() * subdivision_)))
  {}


  LoopDetail::Parts
  LoopDetail::operator()(const ControlPoints &x) const
  {
    Parts result;
    result.coarse = normal_equations_->solve(Eigen::MatrixXd(subdivision_.transpose() * x));
    result.detail = x - subdivision_ * result.coarse;
    return result;
  }


  double
  LoopDetail::largest(const ControlPoints &x, const ControlPoints &detail) const
  {
    return detail.cwiseProduct(vertex_normals(faces_, x)).rowwise().sum().cwiseAbs().maxCoeff();
  }


  MeshQuality::MeshQuality(const TriangleMesh &topology)
    : faces_(topology.faces)
    , surface_(topology, triangle_quadrature(3), Derivatives::second)
  {
    TriangleMesh mesh = topology;
    for (unsigned int i = 0; i < 2; ++i)
      if (const std::optional<TriangleMesh> coarse = loop_coarsen(mesh))
        {
          details_.emplace_back(*coarse, mesh);
          mesh = *coarse;
        }
      else
        break;
  }


  ShapeQuality
  MeshQuality::operator()(const ControlPoints &x) const
  {
    ShapeQuality result;
    result.worst_triangle  = worst_triangle(faces_, x);
    result.smallest_radius = smallest_radius_of_curvature(surface_, x);
    result.detail = result.detail_ratio = std::numeric_limits<double>::quiet_NaN();
    if (details_.empty())
      return result;
    const LoopDetail::Parts parts = details_[0](x);
    result.detail                 = details_[0].largest(x, parts.detail);
    if (details_.size() > 1)
      result.detail_ratio = result.detail / details_[1].largest(parts.coarse, details_[1](parts.coarse).detail);
    return result;
  }
} // namespace tanktread
