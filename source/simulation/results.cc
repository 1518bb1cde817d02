// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: what a run leaves in its folder.

#include <deal.II/base/numbers.h>

#include <Eigen/SparseCholesky>
#include <tanktread/base/exceptions.h>
#include <tanktread/base/mpi_errors.h>
#include <tanktread/fluid/field_output.h>
#include <tanktread/simulation/results.h>
#include <tanktread/surface/capsule_shape.h>
#include <tanktread/surface/contour.h>
#include <tanktread/surface/interior.h>
#include <tanktread/surface/surface_operators.h>

#include <cmath>
#include <fstream>
#include <iomanip>
#include <limits>
#include <sstream>

namespace tanktread
{
  namespace
  {
    const std::vector<std::string> history_names = {"time",
                                                    "D_xz",
                                                    "theta",
                                                    "L",
                                                    "B",
                                                    "W",
                                                    "volume",
                                                    "volume_error",
                                                    "area",
                                                    "membrane_energy",
                                                    "bending_energy",
                                                    "dissipation",
                                                    "newton_iterations",
                                                    "linear_iterations",
                                                    "wall_time",
                                                    "alpha",
                                                    "delta",
                                                    "pressure_jump",
                                                    "step",
                                                    "cells",
                                                    "theta_continuous",
                                                    "S_xx",
                                                    "S_yy",
                                                    "S_zz",
                                                    "S_xy",
                                                    "S_xz",
                                                    "S_yz",
                                                    "intrinsic_viscosity",
                                                    "N1",
                                                    "N2"};

  } // namespace


  Observables
  observe(const ShellView &shell, const Fluid &fluid, const State &state)
  {
    Observables result;
    result.ellipsoid = inertia_ellipsoid(shell.surface, state.x);
    result.theta_over_pi =
      result.ellipsoid.taylor_parameter < 1e-4 ? std::numeric_limits<double>::quiet_NaN() : result.ellipsoid.inclination / dealii::numbers::PI;
    result.volume        = enclosed_volume(shell.surface, state.x);
    result.volume_error  = result.volume / shell.initial_volume - 1.;
    result.area          = surface_area(shell.surface, state.x);
    result.energy        = shell.shell.energy(state.x);
    result.pressure_jump = state.pressure_jump;
    result.n_cells       = fluid.mesh().triangulation().n_global_active_cells();
    return result;
  }


  Results::Results(const std::string &folder, const MPI_Comm communicator)
    : folder_(folder)
    , communicator_(communicator)
    , shell_series_(folder + "/shell.pvd")
    , fluid_series_(folder + "/fluid.pvd")
  {
    on_first_rank(communicator, [&] {
      history_  = std::make_unique<CsvWriter>(folder + "/history.csv", history_names);
      contours_ = std::make_unique<CsvWriter>(folder + "/contours.csv", std::vector<std::string>{"time", "x", "z"});
    });
  }


  void
  Results::add_history(const Observables &o)
  {
    const std::vector<double> row = {o.time,
                                     o.ellipsoid.taylor_parameter,
                                     o.theta_over_pi,
                                     o.ellipsoid.L,
                                     o.ellipsoid.B,
                                     o.ellipsoid.W,
                                     o.volume,
                                     o.volume_error,
                                     o.area,
                                     o.energy.membrane,
                                     o.energy.bending,
                                     o.dissipation,
                                     double(o.newton_iterations),
                                     double(o.linear_iterations),
                                     o.wall_time,
                                     o.alpha,
                                     o.delta,
                                     o.pressure_jump,
                                     o.step,
                                     o.n_cells,
                                     o.theta_continuous,
                                     o.stress(0, 0),
                                     o.stress(1, 1),
                                     o.stress(2, 2),
                                     o.stress(0, 1),
                                     o.stress(0, 2),
                                     o.stress(1, 2),
                                     o.rheology.intrinsic_viscosity,
                                     o.rheology.normal_difference_1,
                                     o.rheology.normal_difference_2};
    on_first_rank(communicator_, [&] { history_->row(row); });
  }


  void
  Results::write_shell(const std::string &file, const ShellView &shell, const State &state, const ControlPoints &velocity) const
  {
    const SparseMatrix                                       limit   = vertex_limit_stencils(shell.topology);
    const Eigen::VectorXd                                    weights = area_weights(shell.surface, state.x);
    const Eigen::VectorXd                                    stretch = weights.cwiseQuotient(shell.shell.reference_weights());
    const ControlPoints                                      f       = shell.shell.force(state.x);
    const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> mass(mass_matrix(shell.surface, weights));

    // Control values of the surface field nearest, in the mean square, to values at the quadrature points.
    const auto projected = [&](const Eigen::VectorXd &values) -> Eigen::VectorXd {
      return mass.solve(shell.surface.S().transpose() * weights.cwiseProduct(values));
    };
    std::vector<std::pair<std::string, Eigen::MatrixXd>> fields = {{"velocity", limit * velocity},
                                                                   {"force_density", limit * Eigen::MatrixXd(mass.solve(Eigen::MatrixXd(f)))},
                                                                   {"area_stretch", limit * projected(stretch)}};
    if (shell.surface.derivatives() == Derivatives::second)
      fields.emplace_back("mean_curvature", limit * projected(mean_curvature(shell.surface, state.x)));
    write_surface_vtu(file, limit * state.x, shell.topology.faces, fields);
  }


  void
  Results::write_contour(const double time, const TriangleMesh &topology, const ControlPoints &x)
  {
    // Refined twice, the polygon that is cut is close to the smooth surface.
    TriangleMesh mesh = topology;
    for (Eigen::Index i = 0; i < x.rows(); ++i)
      mesh.vertices[i] = x.row(i);
    mesh = loop_refine(loop_refine(mesh));
    const Eigen::Map<const ControlPoints> refined(mesh.vertices.front().data(), mesh.vertices.size(), 3);
    for (const Eigen::Vector2d &point : shear_plane_contour(limit_mesh(mesh, refined)))
      contours_->row({time, point[0], point[1]});
  }


  void
  Results::add_fields(const double           time,
                      const ShellView       &shell,
                      const ControlPoints   &velocity,
                      const Fluid           &fluid,
                      const State           &state,
                      const UndisturbedFlow &flow)
  {
    std::ostringstream number;
    number << std::setw(4) << std::setfill('0') << n_fields_;
    const Interior interior(shell.surface, state.x);
    const double   side              = fluid.mesh().side();
    const auto     interior_pressure = [&](const dealii::Point<3> &point) {
      // The periodic image of the point that is nearest to the capsule.
      Eigen::Vector3d y(point[0], point[1], point[2]);
      for (unsigned int d = 0; d < 2; ++d)
        y[d] -= side * std::round((y[d] - interior.centre()[d]) / side);
      return interior.contains(y) ? state.pressure_jump : 0.;
    };
    const std::string fluid_file = write_fluid_fields(folder_, "fluid", n_fields_, fluid.space(), state.fluid, flow, interior_pressure);
    on_first_rank(communicator_, [&] {
      const std::string shell_file = "shell_" + number.str() + ".vtu";
      write_shell(folder_ + "/" + shell_file, shell, state, velocity);
      write_contour(time, shell.topology, state.x);
      shell_series_.add(time, shell_file);
      fluid_series_.add(time, fluid_file);
    });
    ++n_fields_;
  }


  void
  Results::add_contour(const double time, const ShellView &shell, const ControlPoints &x)
  {
    on_first_rank(communicator_, [&] { write_contour(time, shell.topology, x); });
  }


  void
  Results::write_summary(const std::string &outcome, const MotionSummary &s) const
  {
    const std::vector<std::pair<std::string, double>> numbers = {{"from", s.from},
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
                                                                 {"theta_last", s.theta_last}};
    on_first_rank(communicator_, [&] {
      const std::string name = folder_ + "/summary.csv";
      std::ofstream     file(name);
      file << "quantity,value\noutcome," << outcome << "\nmode," << word(s.mode) << '\n' << std::setprecision(10);
      for (const auto &[quantity, value] : numbers)
        file << quantity << ',' << value << '\n';
      if (!(file << std::flush))
        throw InputError("cannot write \"" + name + "\"");
    });
  }


  std::string
  Results::write_failed(const ShellView &shell, const State &state) const
  {
    const std::string file = folder_ + "/failed_shell.vtu";
    on_first_rank(communicator_, [&] { write_shell(file, shell, state, ControlPoints::Zero(state.x.rows(), 3)); });
    return file;
  }
} // namespace tanktread
