// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: what a run leaves in its folder.

#ifndef tanktread_simulation_results_h
#define tanktread_simulation_results_h

#include <tanktread/base/csv_writer.h>
#include <tanktread/fluid/fluid.h>
#include <tanktread/shell/shell.h>
#include <tanktread/simulation/motion.h>
#include <tanktread/simulation/particle_stress.h>
#include <tanktread/simulation/surface_vtu.h>
#include <tanktread/solver/state.h>
#include <tanktread/surface/surface_geometry.h>
#include <tanktread/surface/triangle_mesh.h>

#include <memory>
#include <string>

namespace tanktread
{
  /** One row of history.csv. */
  struct Observables
  {
    double           time = 0.;
    InertiaEllipsoid ellipsoid{};
    double           theta_over_pi = 0.; // inclination in units of pi; not a number while the section is round
    double           volume = 0., volume_error = 0., area = 0.;
    Shell::Energy    energy{};
    double           dissipation      = 0.; // in the box, beyond that of the undisturbed flow
    double           pressure_jump    = 0.;
    double           theta_continuous = 0., alpha = 0., delta = 0.; // see PhaseAngles
    Eigen::Matrix3d  stress = Eigen::Matrix3d::Zero();              // see particle_stress()
    Rheology         rheology{};
    double           step              = 0.;
    unsigned int     newton_iterations = 0, linear_iterations = 0;
    double           n_cells   = 0.;
    double           wall_time = 0.;
  };

  /** The shell's fixed data that observables and pictures need; all kept by reference. */
  struct ShellView
  {
    const TriangleMesh       &topology;
    const SubdivisionSurface &surface;
    const Shell              &shell;
    double                    initial_volume;
  };

  /** Shape, energies and dissipation of a state. Collective. */
  Observables
  observe(const ShellView &shell, const Fluid &fluid, const State &state);

  /**
   * history.csv (one row a step), contours.csv (cuts with the plane y = 0 at each field output and when asked for: time, x, z), shell_NNNN.vtu and fluid_NNNNN.pvtu with shell.pvd and
   * fluid.pvd, summary.csv at the end. The first rank writes all but the pieces of the fluid.
   */
  class Results
  {
  public:
    /** The folder must exist. What cannot be written on the first rank throws InputError on all. Collective, as are all members. */
    Results(const std::string &folder, MPI_Comm communicator);

    void
    add_history(const Observables &observables);

    /** Writes shell, contour and fluid. `velocity`: of the control points, NP x 3. */
    void
    add_fields(double time, const ShellView &shell, const ControlPoints &velocity, const Fluid &fluid, const State &state, const UndisturbedFlow &flow);

    /** The cut of the shell with control points x alone. */
    void
    add_contour(double time, const ShellView &shell, const ControlPoints &x);

    /** summary.csv: lines "quantity,value", the first of them `outcome` with the word "done" or "failed". */
    void
    write_summary(const std::string &outcome, const MotionSummary &summary) const;

    /** The last good state of a run that failed: failed_shell.vtu. Returns the file's name. */
    std::string
    write_failed(const ShellView &shell, const State &state) const;

  private:
    void
    write_shell(const std::string &file, const ShellView &shell, const State &state, const ControlPoints &velocity) const;
    void
    write_contour(double time, const TriangleMesh &topology, const ControlPoints &x);

    std::string                folder_;
    MPI_Comm                   communicator_;
    unsigned int               n_fields_ = 0;
    std::unique_ptr<CsvWriter> history_, contours_; // on the first rank only
    PvdFile                    shell_series_, fluid_series_;
  };
} // namespace tanktread

#endif
