// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: energy, nodal forces and tangent of an elastic shell.

#include <Eigen/Eigenvalues>
#include <tanktread/base/exceptions.h>
#include <tanktread/shell/face_kernels.h>
#include <tanktread/shell/helfrich.h>
#include <tanktread/shell/neo_hookean.h>
#include <tanktread/shell/shell.h>
#include <tanktread/shell/skalak.h>
#include <tanktread/surface/surface_geometry.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <stdexcept>
#include <string>

namespace tanktread
{
  /** Workspace for one face; 3-vectors padded to 4 numbers as in face_kernels.h. */
  struct Shell::FaceBuffers
  {
    FaceBuffers(const SubdivisionSurface &surface, const unsigned int n_rows, const bool with_tangent)
      : stencils{nullptr, surface.n_stencils() * surface.support_size(), surface.n_points_per_face(), n_rows, surface.support_size()}
      , x(4 * stencils.n, 0.)
      , y(4 * stencils.n_points * n_rows)
      , gradients(y.size(), 0.)
      , f(4 * stencils.n)
      , hessians(with_tangent ? stencils.n_points : 0)
      , scratch(with_tangent ? 4 * n_rows * stencils.n : 0)
      , block(with_tangent ? 9 * stencils.n * stencils.n : 0)
    {}

    FaceStencils                           stencils;
    std::vector<double>                    x, y, gradients, f;
    std::vector<SurfaceDerivativesTangent> hessians;
    std::vector<double>                    scratch, block;
  };

  namespace
  {
    /** 3 of 4 numbers as a vector. */
    Eigen::Map<const Eigen::Vector3d>
    vector(const std::vector<double> &padded, const unsigned int i)
    {
      return Eigen::Map<const Eigen::Vector3d>(padded.data() + 4 * i);
    }

    /** The five rows of a point. */
    SurfaceDerivatives
    derivatives(const std::vector<double> &padded, const unsigned int point)
    {
      return Eigen::Map<const SurfaceDerivatives, 0, Eigen::OuterStride<4>>(padded.data() + 20 * point);
    }

    /** Metric at a point of a face; throws if the surface is degenerate there. */
    Metric
    metric_at(const std::vector<double> &y, const unsigned int row, const unsigned int face)
    {
      const auto   a_1 = vector(y, row), a_2 = vector(y, row + 1);
      const Metric metric{a_1.squaredNorm(), a_1.dot(a_2), a_2.squaredNorm()};
      const double det = metric.determinant();
      if (!(det > 0.) || !std::isfinite(det))
        throw NumericalError("The shell is degenerate in face " + std::to_string(face) + ": det a is " + std::to_string(det) + ".");
      return metric;
    }

    /** Adds the derivatives of weight * w by a_1 and a_2 to the first two rows of a padded gradient. */
    void
    add_membrane_gradient(const MembraneDensity &w, const double weight, const Eigen::Vector3d &a_1, const Eigen::Vector3d &a_2, double *gradient)
    {
      const Eigen::Vector3d n = weight * w.gradient;
      Eigen::Map<Eigen::Vector3d>(gradient) += 2. * n[0] * a_1 + n[1] * a_2;
      Eigen::Map<Eigen::Vector3d>(gradient + 4) += n[1] * a_1 + 2. * n[2] * a_2;
    }

    /** Adds the second derivatives of weight * w by (a_1, a_2) to the corner of `hessian`. */
    void
    add_membrane_hessian(const MembraneDensity     &w,
                         const double               weight,
                         const Eigen::Vector3d     &a_1,
                         const Eigen::Vector3d     &a_2,
                         SurfaceDerivativesTangent &hessian)
    {
      const Eigen::Vector3d       n = weight * w.gradient;
      Eigen::Matrix<double, 6, 3> metric_gradient; // derivatives of a11, a12, a22
      metric_gradient << 2. * a_1, a_2, Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero(), a_1, 2. * a_2;
      Eigen::Matrix<double, 6, 6> h = metric_gradient * (weight * w.hessian) * metric_gradient.transpose();
      for (unsigned int c = 0; c < 3; ++c)
        {
          h(c, c) += 2. * n[0];
          h(c + 3, c + 3) += 2. * n[2];
          h(c, c + 3) += n[1];
          h(c + 3, c) += n[1];
        }
      hessian.topLeftCorner<6, 6>() += h;
    }

    /** Takes the negative eigenvalues out of the symmetric part of the leading n x n block. */
    template <int n>
    void
    make_positive(SurfaceDerivativesTangent &hessian)
    {
      using Block                                          = Eigen::Matrix<double, n, n>;
      const Block                                block     = hessian.topLeftCorner<n, n>();
      const Block                                symmetric = 0.5 * (block + block.transpose());
      const Eigen::SelfAdjointEigenSolver<Block> modes(symmetric);
      hessian.topLeftCorner<n, n>() -= modes.eigenvectors() * modes.eigenvalues().cwiseMin(0.).asDiagonal() * modes.eigenvectors().transpose();
    }

    void
    scatter_force(const SubdivisionSurface &surface, const unsigned int face, const std::vector<double> &gradient, ControlPoints &f)
    {
      const int *support = surface.support(face);
      for (unsigned int i = 0; i < surface.support_size(); ++i)
        f.row(support[i]) -= vector(gradient, i);
    }

    void
    scatter_tangent(const SubdivisionSurface &surface, const unsigned int face, const std::vector<double> &block, double *values)
    {
      const AssemblyPattern &pattern = surface.pattern();
      const unsigned int     n       = surface.support_size();
      const int             *support = surface.support(face), *places = pattern.places(face);
      for (unsigned int i = 0; i < n; ++i, places += n)
        for (unsigned int c = 0; c < 3; ++c)
          {
            double       *row    = values + 9 * pattern.row_start(support[i]) + 3 * c * pattern.row_length(support[i]);
            const double *source = block.data() + (3 * c * n + i) * n;
            for (unsigned int j = 0; j < n; ++j)
              {
                double *entry = row + 3 * places[j];
                entry[0] += source[j];
                entry[1] += source[n * n + j];
                entry[2] += source[2 * n * n + j];
              }
          }
    }
  } // namespace


  Shell::Shell(const SubdivisionSurface &surface,
               const ShellParameters    &parameters,
               const ShellModuli        &moduli,
               const ControlPoints      &stress_free,
               const ControlPoints      &initial)
    : surface_(surface)
    , parameters_(parameters)
    , moduli_(moduli)
    , n_rows_(moduli.bending_modulus > 0. || parameters.thickness > 0. ? 5 : 2)
    , all_faces_(surface.n_faces())
    , reference_metric_(surface.n_points())
    , reference_weights_(area_weights(surface, stress_free))
    , reference_curvature_(Eigen::VectorXd::Zero(surface.n_points()))
  {
    parameters.check();
    std::iota(all_faces_.begin(), all_faces_.end(), 0);
    for (const double modulus : {moduli.surface_young_modulus, moduli.bending_modulus})
      if (!(modulus >= 0.) || !std::isfinite(modulus))
        throw InputError("A modulus of the shell is " + std::to_string(modulus) + "; it must not be negative.");

    const ControlPoints a_1 = surface.S_1() * stress_free, a_2 = surface.S_2() * stress_free;
    for (unsigned int q = 0; q < surface.n_points(); ++q)
      reference_metric_[q] = ReferenceMetric(Metric{a_1.row(q).squaredNorm(), a_1.row(q).dot(a_2.row(q)), a_2.row(q).squaredNorm()});

    if (moduli.bending_modulus > 0.)
      set_reference_curvature(initial.size() == 0 ? stress_free : initial);
    if (parameters.thickness > 0.)
      set_thick_reference(stress_free);
  }


  void
  Shell::set_reference_curvature(const ControlPoints &initial)
  {
    const Eigen::VectorXd curvature = mean_curvature(surface_, initial); // also makes sure that the surface has second derivatives
    if (parameters_.reference == ReferenceCurvature::initial)
      reference_curvature_ = curvature;
    else if (parameters_.reference == ReferenceCurvature::value)
      reference_curvature_.setConstant(parameters_.reference_curvature_value);
  }


  void
  Shell::set_thick_reference(const ControlPoints &stress_free)
  {
    if (surface_.derivatives() != Derivatives::second)
      throw std::logic_error("A shell of finite thickness needs a surface with second derivatives.");
    const ControlPoints rows[5] = {surface_.S_1() * stress_free,
                                   surface_.S_2() * stress_free,
                                   surface_.S_11() * stress_free,
                                   surface_.S_12() * stress_free,
                                   surface_.S_22() * stress_free};
    for (unsigned int q = 0; q < surface_.n_points(); ++q)
      {
        SurfaceDerivatives y;
        for (unsigned int p = 0; p < 5; ++p)
          y.row(p) = rows[p].row(q);
        thick_reference_.emplace_back(y, parameters_.thickness);
      }
  }


  MembraneDensity
  Shell::membrane(const Metric &metric, const unsigned int point) const
  {
    if (parameters_.law == MembraneLaw::none)
      return {0., Eigen::Vector3d::Zero(), Eigen::Matrix3d::Zero()};
    return parameters_.law == MembraneLaw::skalak ? skalak(metric, reference_metric_[point], moduli_.surface_shear_modulus(), parameters_.area_dilatation)
                                                  : neo_hookean(metric, reference_metric_[point], moduli_.surface_shear_modulus());
  }


  ThickDensity
  Shell::thick(const SurfaceDerivatives &y, const Metric &metric, const unsigned int point, const bool with_hessian) const
  {
    return thick_neo_hookean(metric, CurvatureTensor(y), thick_reference_[point], moduli_.surface_young_modulus, with_hessian);
  }


  void
  Shell::load_face(const unsigned int face, const ControlPoints &x, FaceBuffers &buffers) const
  {
    const int *support = surface_.support(face);
    for (unsigned int i = 0; i < surface_.support_size(); ++i)
      Eigen::Map<Eigen::RowVector3d>(buffers.x.data() + 4 * i) = x.row(support[i]);
    buffers.stencils.values = surface_.stencils(face * surface_.n_points_per_face()) + surface_.support_size(); // without the row of values
    apply_stencils(buffers.stencils, buffers.x.data(), buffers.y.data());
  }


  void
  Shell::differentiate_points(const unsigned int face, const bool with_tangent, FaceBuffers &buffers) const
  {
    const auto bending = parameters_.form == BendingForm::variational ? variational_bending : moment_only_bending;
    for (unsigned int k = 0; k < surface_.n_points_per_face(); ++k)
      {
        const unsigned int         point    = face * surface_.n_points_per_face() + k;
        const Metric               metric   = metric_at(buffers.y, k * n_rows_, face);
        double                    *gradient = buffers.gradients.data() + 4 * k * n_rows_;
        SurfaceDerivativesTangent *hessian  = with_tangent ? &buffers.hessians[k] : nullptr;
        if (n_rows_ == 5)
          {
            const SurfaceDerivatives                                 y    = derivatives(buffers.y, k);
            SurfaceDerivatives                                       by_y = SurfaceDerivatives::Zero();
            Eigen::Map<SurfaceDerivatives, 0, Eigen::OuterStride<4>> padded(gradient);
            if (moduli_.bending_modulus > 0.)
              bending(y, surface_.weights()[point] * moduli_.bending_modulus, reference_curvature_[point], by_y, hessian);
            else if (with_tangent)
              hessian->setZero();
            if (is_thick())
              add_derivatives(thick(y, metric, point, with_tangent), reference_weights_[point], y, by_y, hessian);
            padded = by_y;
          }
        else
          {
            std::fill_n(gradient, 8, 0.);
            if (with_tangent)
              hessian->topLeftCorner<6, 6>().setZero();
          }
        if (is_thick() || parameters_.law == MembraneLaw::none)
          continue;
        const MembraneDensity w   = membrane(metric, point);
        const Eigen::Vector3d a_1 = vector(buffers.y, k * n_rows_), a_2 = vector(buffers.y, k * n_rows_ + 1);
        add_membrane_gradient(w, reference_weights_[point], a_1, a_2, gradient);
        if (with_tangent)
          add_membrane_hessian(w, reference_weights_[point], a_1, a_2, *hessian);
      }
    std::fill(buffers.f.begin(), buffers.f.end(), 0.);
    add_transposed_stencils(buffers.stencils, buffers.gradients.data(), buffers.f.data());
  }


  Shell::Energy
  Shell::energy(const ControlPoints &x) const
  {
    return energy(x, all_faces_);
  }


  Shell::Energy
  Shell::energy(const ControlPoints &x, const std::vector<unsigned int> &faces) const
  {
    FaceBuffers buffers(surface_, n_rows_, false);
    Energy      energy{0., 0.};
    for (const unsigned int face : faces)
      {
        load_face(face, x, buffers);
        for (unsigned int k = 0; k < surface_.n_points_per_face(); ++k)
          {
            const unsigned int point  = face * surface_.n_points_per_face() + k;
            const Metric       metric = metric_at(buffers.y, k * n_rows_, face);
            energy.membrane +=
              reference_weights_[point] * (is_thick() ? thick(derivatives(buffers.y, k), metric, point, false).energy : membrane(metric, point).energy);
            if (moduli_.bending_modulus > 0.)
              energy.bending += surface_.weights()[point] * bending_energy(derivatives(buffers.y, k), moduli_.bending_modulus, reference_curvature_[point]);
          }
      }
    return energy;
  }


  ControlPoints
  Shell::force(const ControlPoints &x) const
  {
    return force(x, all_faces_);
  }


  ControlPoints
  Shell::force(const ControlPoints &x, const std::vector<unsigned int> &faces) const
  {
    FaceBuffers   buffers(surface_, n_rows_, false);
    ControlPoints f = ControlPoints::Zero(x.rows(), 3);
    for (const unsigned int face : faces)
      {
        load_face(face, x, buffers);
        differentiate_points(face, false, buffers);
        scatter_force(surface_, face, buffers.f, f);
      }
    return f;
  }


  void
  Shell::force_and_tangent(const ControlPoints &x, ControlPoints &f, SparseMatrix &K, const Tangent tangent) const
  {
    force_and_tangent(x, all_faces_, f, K, tangent);
  }


  void
  Shell::force_and_tangent(const ControlPoints &x, const std::vector<unsigned int> &faces, ControlPoints &f, SparseMatrix &K, const Tangent tangent) const
  {
    if (K.rows() != 3 * x.rows() || !K.isCompressed() || K.nonZeros() != surface_.pattern().n_block_entries())
      K = surface_.pattern().block_matrix();
    else
      K.coeffs().setZero();

    FaceBuffers buffers(surface_, n_rows_, true);
    const bool  symmetric = moduli_.bending_modulus == 0. || parameters_.form == BendingForm::variational;
    f.setZero(x.rows(), 3);
    for (const unsigned int face : faces)
      {
        load_face(face, x, buffers);
        differentiate_points(face, true, buffers);
        if (tangent == Tangent::positive)
          for (SurfaceDerivativesTangent &hessian : buffers.hessians)
            n_rows_ == 5 ? make_positive<15>(hessian) : make_positive<6>(hessian);
        scatter_force(surface_, face, buffers.f, f);
        stencil_congruence(buffers.stencils, buffers.hessians.front().data(), symmetric, buffers.scratch.data(), buffers.block.data());
        scatter_tangent(surface_, face, buffers.block, K.valuePtr());
      }
  }
} // namespace tanktread
