// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: what a run leaves in its folder.

#include <Eigen/SparseCholesky>
#include <tanktread/base/exceptions.h>
#include <tanktread/base/mpi_errors.h>
#include <tanktread/base/output_file.h>
#include <tanktread/fluid/field_output.h>
#include <tanktread/simulation/results.h>
#include <tanktread/surface/contour.h>
#include <tanktread/surface/interior.h>
#include <tanktread/surface/surface_operators.h>

#include <cmath>
#include <iomanip>
#include <sstream>

namespace tanktread
{
  namespace
  {
    std::vector<std::string>
    names(const Row &row)
    {
      std::vector<std::string> result;
      for (const auto &column : row)
        result.push_back(column.first);
      return result;
    }

    std::vector<double>
    values(const Row &row)
    {
      std::vector<double> result;
      for (const auto &column : row)
        result.push_back(column.second);
      return result;
    }

    /** "_1" and so on where there are several capsules. */
    std::string
    suffix(const std::size_t c, const std::size_t n_capsules)
    {
      return n_capsules == 1 ? "" : "_" + std::to_string(c + 1);
    }

    /** With so many subdivisions the polygon that is cut is close to the smooth surface. */
    constexpr unsigned int contour_subdivisions = 2;

    /** Points of one shell and fields there. */
    struct ShellPoints
    {
      ControlPoints                                        positions;
      std::vector<std::pair<std::string, Eigen::MatrixXd>> fields;
    };

    ShellPoints
    shell_points(const Capsule &capsule, const LimitPicture &picture, const ControlPoints &x, const ControlPoints &velocity)
    {
      const SparseMatrix                                      &limit   = picture.S();
      const SubdivisionSurface                                &surface = capsule.surface();
      const Eigen::VectorXd                                    weights = area_weights(surface, x);
      const ControlPoints                                      f       = capsule.shell().force(x);
      const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> mass(mass_matrix(surface, weights));
      if (mass.info() != Eigen::Success)
        throw NumericalError("The fields on the shell cannot be drawn: its mass matrix at this shape is singular.");
      // Control values of the surface field nearest, in the mean square, to values at the quadrature points.
      const auto projected = [&](const Eigen::VectorXd &at_points) -> Eigen::VectorXd {
        return limit * Eigen::VectorXd(mass.solve(surface.S().transposed_times(weights.cwiseProduct(at_points))));
      };
      ShellPoints result{limit * x,
                         {{"normals", picture.normals(x)},
                          {"velocity", limit * velocity},
                          {"force_density", limit * Eigen::MatrixXd(mass.solve(Eigen::MatrixXd(f)))}}};
      result.fields.emplace_back("area_stretch", projected(weights.cwiseQuotient(capsule.shell().reference_weights())));
      if (surface.derivatives() == Derivatives::second)
        result.fields.emplace_back("mean_curvature", projected(mean_curvature(surface, x)));
      return result;
    }

    /** Puts the fields of one shell below those of the others. */
    void
    append(const ShellPoints &shell, ShellPoints &all)
    {
      if (all.fields.empty())
        {
          all = shell;
          return;
        }
      const auto below = [](const Eigen::MatrixXd &upper, const Eigen::MatrixXd &lower) {
        Eigen::MatrixXd both(upper.rows() + lower.rows(), upper.cols());
        both << upper, lower;
        return both;
      };
      all.positions = below(all.positions, shell.positions);
      for (std::size_t k = 0; k < all.fields.size(); ++k)
        all.fields[k].second = below(all.fields[k].second, shell.fields[k].second);
    }

    Row
    summary_row(const MotionSummary &s)
    {
      Row result = {{"from", s.from},
                    {"end", s.end},
                    {"tank_treading_frequency", s.tank_treading_frequency},
                    {"tumbling_frequency", s.tumbling_frequency},
                    {"D_period", s.D_period},
                    {"D_frequency", 1. / s.D_period},
                    {"D_minimum", s.D_minimum},
                    {"D_maximum", s.D_maximum},
                    {"D_last", s.D_last},
                    {"theta_minimum", s.theta_minimum},
                    {"theta_maximum", s.theta_maximum},
                    {"theta_last", s.theta_last},
                    {"D_mean", s.means.D},
                    {"theta_mean", s.means.theta},
                    {"intrinsic_viscosity_mean", s.means.intrinsic_viscosity},
                    {"N1_mean", s.means.N1},
                    {"N2_mean", s.means.N2}};
      for (const auto &[quantity, limit] : s.limits.named())
        {
          result.emplace_back(quantity + "_limit", limit.value);
          result.emplace_back(quantity + "_limit_error", limit.error);
        }
      result.emplace_back("energy_defect", s.energy_defect);
      return result;
    }
  } // namespace


  Results::Results(const std::string  &folder,
                   const TriangleMesh &topology,
                   const unsigned int  n_capsules,
                   const unsigned int  surface_subdivisions,
                   const MPI_Comm      communicator)
    : folder_(folder)
    , communicator_(communicator)
    , n_capsules_(n_capsules)
    , shell_series_(folder + "/shell.pvd")
    , fluid_series_(folder + "/fluid.pvd")
  {
    on_first_rank(communicator, [&] {
      for (unsigned int c = 0; c < n_capsules; ++c)
        {
          const std::string end = suffix(c, n_capsules) + ".csv";
          histories_.push_back(std::make_unique<CsvWriter>(folder + "/history" + end, names(history_row({}, {}))));
          contours_.push_back(std::make_unique<CsvWriter>(folder + "/contours" + end, std::vector<std::string>{"time", "x", "z"}));
        }
      suspension_      = std::make_unique<CsvWriter>(folder + "/suspension.csv", names(suspension_row({}, {})));
      surface_picture_ = std::make_unique<LimitPicture>(topology, surface_subdivisions);
      contour_picture_ = std::make_unique<LimitPicture>(topology, contour_subdivisions);
    });
  }


  void
  Results::add_history(const StepObservables &step, const std::vector<CapsuleObservables> &capsules, const SuspensionObservables &suspension)
  {
    on_first_rank(communicator_, [&] {
      for (unsigned int c = 0; c < n_capsules_; ++c)
        histories_[c]->row(values(history_row(step, capsules[c])));
      suspension_->row(values(suspension_row(step, suspension)));
    });
  }


  void
  Results::write_shells(const std::string &file, const Capsule &capsule, const State &state, const ShellFields &velocities) const
  {
    ShellPoints                     all;
    std::vector<std::array<int, 3>> faces;
    const int                       n_points = int(surface_picture_->S().rows());
    Eigen::VectorXd                 number(n_points * Eigen::Index(n_capsules_));
    for (unsigned int c = 0; c < n_capsules_; ++c)
      {
        append(shell_points(capsule, *surface_picture_, state.capsules[c].x, velocities[c]), all);
        const int first = int(c) * n_points;
        for (const auto &face : surface_picture_->faces())
          faces.push_back({face[0] + first, face[1] + first, face[2] + first});
        number.segment(first, n_points).setConstant(c + 1);
      }
    if (n_capsules_ > 1)
      all.fields.emplace_back("capsule", number);
    write_surface_vtu(file, all.positions, faces, all.fields);
  }


  void
  Results::write_contours(const double time, const ShellFields &x)
  {
    for (unsigned int c = 0; c < n_capsules_; ++c)
      {
        const Eigen::RowVector3d middle(0., x[c].col(1).mean(), 0.);
        const ControlPoints      limit = contour_picture_->S() * (x[c].rowwise() - middle);
        TriangleMesh             mesh{{}, contour_picture_->faces()};
        for (Eigen::Index i = 0; i < limit.rows(); ++i)
          mesh.vertices.emplace_back(limit.row(i));
        for (const Eigen::Vector2d &point : shear_plane_contour(mesh))
          contours_[c]->row({time, point[0], point[1]});
      }
  }


  void
  Results::add_fields(const double time, Scene &scene, const State &state, const ShellFields &velocities)
  {
    std::ostringstream number;
    number << std::setw(4) << std::setfill('0') << n_fields_;
    const Capsule        &capsule = scene.capsule();
    const Box            &box     = scene.description().box;
    std::vector<Interior> interiors;
    for (const CapsuleState &of_capsule : state.capsules)
      interiors.emplace_back(capsule.surface(), of_capsule.x);
    const auto interior_pressure = [&](const dealii::Point<3> &point) {
      for (std::size_t c = 0; c < interiors.size(); ++c)
        {
          // The periodic image of the point that is nearest to the capsule.
          Eigen::Vector3d y(point[0], point[1], point[2]);
          for (unsigned int d = 0; d < 3; ++d)
            if (box.is_periodic(d))
              y[d] -= box.side[d] * std::round((y[d] - interiors[c].centre()[d]) / box.side[d]);
          if (interiors[c].contains(y))
            return state.capsules[c].pressure_jump;
        }
      return 0.;
    };
    const std::string fluid_file =
      write_fluid_fields(folder_, "fluid", n_fields_, scene.level().whole_space(), scene.level().whole_fields(state), scene.level().flow(), interior_pressure);
    on_first_rank(communicator_, [&] {
      const std::string shell_file = "shell_" + number.str() + ".vtu";
      write_shells(folder_ + "/" + shell_file, capsule, state, velocities);
      write_contours(time, positions(state));
      shell_series_.add(time, shell_file);
      fluid_series_.add(time, fluid_file);
    });
    ++n_fields_;
  }


  void
  Results::add_contours(const double time, const ShellFields &x)
  {
    on_first_rank(communicator_, [&] { write_contours(time, x); });
  }


  void
  Results::write_summary(const std::string &outcome, const std::vector<MotionSummary> &capsules, const Row &of_run) const
  {
    on_first_rank(communicator_, [&] {
      std::ostringstream file;
      file << "quantity,value\noutcome," << outcome << '\n' << std::setprecision(10);
      for (std::size_t c = 0; c < capsules.size(); ++c)
        {
          const std::string number = suffix(c, capsules.size());
          file << "mode" << number << ',' << word(capsules[c].mode) << '\n';
          for (const auto &[quantity, value] : summary_row(capsules[c]))
            file << quantity << number << ',' << value << '\n';
        }
      for (const auto &[quantity, value] : of_run)
        file << quantity << ',' << value << '\n';
      replace_file(folder_ + "/summary.csv", file.str());
    });
  }


  std::string
  Results::write_failed(Scene &scene, const State &state) const
  {
    const std::string file = folder_ + "/failed_shell.vtu";
    ShellFields       rest;
    for (const CapsuleState &capsule : state.capsules)
      rest.push_back(ControlPoints::Zero(capsule.x.rows(), 3));
    on_first_rank(communicator_, [&] { write_shells(file, scene.capsule(), state, rest); });
    return file;
  }
} // namespace tanktread
