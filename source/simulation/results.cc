// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: what a run leaves in its folder.

#include <deal.II/base/numbers.h>

#include <Eigen/SparseCholesky>
#include <tanktread/fluid/field_output.h>
#include <tanktread/simulation/results.h>
#include <tanktread/surface/capsule_shape.h>
#include <tanktread/surface/contour.h>
#include <tanktread/surface/surface_operators.h>

#include <cmath>
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
                                                    "pressure_jump",
                                                    "step",
                                                    "cells"};

    /** Control values of the surface field nearest, in the mean square, to values at the quadrature points. */
    Eigen::MatrixXd
    projected(const SubdivisionSurface &surface, const Eigen::VectorXd &weights, const Eigen::MatrixXd &values)
    {
      const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> mass(mass_matrix(surface, weights));
      return mass.solve(surface.S().transpose() * (weights.asDiagonal() * values));
    }
  } // namespace


  Observables
  observe(const ShellView &shell, const Fluid &fluid, const State &state)
  {
    Observables result;
    result.ellipsoid     = inertia_ellipsoid(shell.surface, state.x);
    result.volume        = enclosed_volume(shell.surface, state.x);
    result.volume_error  = result.volume / shell.initial_volume - 1.;
    result.area          = surface_area(shell.surface, state.x);
    result.energy        = shell.shell.energy(state.x);
    result.pressure_jump = state.pressure_jump;
    result.n_cells       = fluid.mesh().triangulation().n_global_active_cells();
    FluidVector product(state.fluid.block(0));
    for (unsigned int c = 0; c < 3; ++c)
      {
        fluid.stokes().laplace().vmult(product, state.fluid.block(c));
        result.dissipation += product * state.fluid.block(c);
      }
    return result;
  }


  Results::Results(const std::string &folder, const bool first_rank)
    : folder_(folder)
    , first_rank_(first_rank)
    , history_(folder + "/history.csv", history_names, first_rank)
    , contours_(folder + "/contours.csv", {"time", "x", "z"}, first_rank)
    , shell_series_(folder + "/shell.pvd")
    , fluid_series_(folder + "/fluid.pvd")
  {}


  void
  Results::add_history(const Observables &o)
  {
    // The inclination of a circle is not defined.
    const double theta = o.ellipsoid.taylor_parameter < 1e-4 ? std::numeric_limits<double>::quiet_NaN() : o.ellipsoid.inclination / dealii::numbers::PI;
    history_.row({o.time,
                  o.ellipsoid.taylor_parameter,
                  theta,
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
                  o.pressure_jump,
                  o.step,
                  o.n_cells});
  }


  void
  Results::write_shell(const std::string &file, const ShellView &shell, const State &state, const ControlPoints &velocity) const
  {
    const SparseMatrix    limit   = vertex_limit_stencils(shell.topology);
    const Eigen::VectorXd weights = area_weights(shell.surface, state.x);
    const Eigen::VectorXd stretch = weights.cwiseQuotient(shell.shell.reference_weights());
    const ControlPoints   f       = shell.shell.force(state.x);
    const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> mass(mass_matrix(shell.surface, weights));

    std::vector<std::pair<std::string, Eigen::MatrixXd>> fields = {{"velocity", limit * velocity},
                                                                   {"force_density", limit * Eigen::MatrixXd(mass.solve(Eigen::MatrixXd(f)))},
                                                                   {"area_stretch", limit * projected(shell.surface, weights, stretch)}};
    if (shell.surface.derivatives() == Derivatives::second)
      fields.emplace_back("mean_curvature", limit * projected(shell.surface, weights, mean_curvature(shell.surface, state.x)));
    write_surface_vtu(file, limit * state.x, shell.topology.faces, fields);
  }


  void
  Results::add_contour(const double time, const TriangleMesh &limit_surface)
  {
    for (const Eigen::Vector2d &point : shear_plane_contour(limit_surface))
      contours_.row({time, point[0], point[1]});
  }


  void
  Results::add_fields(const double time, const ShellView &shell, const ControlPoints &velocity, const Fluid &fluid, const State &state, const double shear_rate)
  {
    std::ostringstream number;
    number << std::setw(4) << std::setfill('0') << n_fields_;
    const std::string fluid_file = write_fluid_fields(folder_, "fluid", n_fields_, fluid.space(), state.fluid, shear_rate);
    if (first_rank_)
      {
        const std::string shell_file = "shell_" + number.str() + ".vtu";
        write_shell(folder_ + "/" + shell_file, shell, state, velocity);
        add_contour(time, limit_mesh(shell.topology, state.x));
        shell_series_.add(time, shell_file);
        fluid_series_.add(time, fluid_file);
      }
    ++n_fields_;
  }


  std::string
  Results::write_failed(const ShellView &shell, const State &state) const
  {
    const std::string file = folder_ + "/failed_shell.vtu";
    if (first_rank_)
      write_shell(file, shell, state, ControlPoints::Zero(state.x.rows(), 3));
    return file;
  }
} // namespace tanktread
