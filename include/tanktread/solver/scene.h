// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: capsules in a box of liquid, put together.

#ifndef tanktread_solver_scene_h
#define tanktread_solver_scene_h

#include <tanktread/fluid/box.h>
#include <tanktread/shell/gaps.h>
#include <tanktread/solver/newton_solver.h>
#include <tanktread/surface/place.h>

#include <optional>
#include <string>
#include <vector>

namespace tanktread
{
  /** What capsules of a kind are made of. */
  struct CapsuleKind
  {
    FittedShape                       shape; // about the origin
    std::optional<ControlPoints>      stress_free;
    ShellParameters                   shell;
    ShellModuli                       moduli{1., 0.};
    unsigned int                      shell_quadrature = 3; // points a face
    std::optional<TriangleQuadrature> coupling_quadrature;  // of each face; unless given that which the finest cells ask for

    /** Whether the forces are the derivative of an energy, which the moments of bending alone are not. */
    bool
    has_energy() const
    {
      return shell.form == BendingForm::variational || moduli.bending_modulus == 0.;
    }
  };

  /** What a scene is made of: all that a run, a benchmark or a test has to say about it. */
  struct SceneDescription
  {
    Box                       box;
    Liquids                   liquids;
    std::vector<CapsuleKind>  kinds  = {CapsuleKind()};
    std::vector<Place>        places = {Place()};
    std::vector<unsigned int> kind_of;     // of the capsule at each place, a number in `kinds`; empty: all of the first
    unsigned int              n_teams = 0; // see ShellLayout
    FluidMeshParameters       fluid_mesh;
    SolverParameters          solver;

    /** The kind of capsule c. */
    const CapsuleKind &
    kind(const unsigned int c) const
    {
      return kinds[kind_of.empty() ? 0 : kind_of[c]];
    }
  };

  /**
   * The objects of a scene and who knows whom: the liquid, the kinds of capsules, who holds which of them, their coupling, a time level of all unknowns and its solver, with their memory. The program, the benchmarks and the tests build scenes through this class.
   * All members but the plain accessors are collective.
   */
  class Scene
  {
  public:
    /** Throws what Capsule and Fluid throw. There is no mesh before refine_around(). */
    Scene(SceneDescription description, MPI_Comm communicator);

    /** The rank's own capsules where the description has them, without forces and flow. */
    State
    initial_state() const;

    /** New mesh around the shells of `state`, and of others if there are any; void are then all fluid vectors of before, those of `state` too. */
    void
    refine_around(const State &state, const std::vector<ShellFields> &others = {});

    /** The shells that the present mesh was made around, one set or several, of the rank's own capsules. */
    std::vector<ShellFields> &
    mesh_shells()
    {
      return mesh_shells_;
    }

    /** The mesh that was made around them, with finest cells of that level. Vectors are void. Collective. */
    void
    restore_mesh(std::vector<ShellFields> shells, unsigned int finest_level);

    /** Gives capsules to other teams, see ShellLayout::assign(). States are to be of the new own capsules from then on. */
    void
    reassign(const std::vector<unsigned int> &team_of);

    /**
     * Whether the mesh will do for the shells of `state` and for others: all cells near them are finest ones, within a finest cell with the enriched interface and half of one with the plain
     * one, and finest cells are as small as `Finest cell in gaps` asks for between them, and no smaller.
     */
    bool
    covers(const State &state, const std::vector<ShellFields> &others = {});

    /** Whether no face with prescribed velocity is met by shells with these control points. Collective. */
    bool
    contains(const ShellFields &x) const;

    /** Of the shells of `state`: within four finest cells to the accuracy of the surface. */
    ShellGap
    gap(const State &state);

    /** Distance from the faces of the box with prescribed velocity. */
    double
    distance_from_faces(const State &state);

    /** Why a state must not be accepted: shells that overlap, or too near to a face of a box in unbounded liquid; empty if there is no reason. The same on all ranks. */
    std::string
    refusal(const State &state);

    const SceneDescription &
    description() const
    {
      return description_;
    }
    MPI_Comm
    communicator() const
    {
      return communicator_;
    }
    /** All capsules by their numbers. */
    const Capsules &
    capsules() const
    {
      return capsules_;
    }
    const ShellLayout &
    layout() const
    {
      return layout_;
    }
    /** The kind of the rank's own capsule i. */
    const Capsule &
    capsule(const unsigned int i = 0) const
    {
      return layout_.capsule(i);
    }
    Fluid &
    fluid()
    {
      return fluid_;
    }
    const DistributedShell &
    elasticity() const
    {
      return elasticity_;
    }
    Coupling &
    coupling()
    {
      return coupling_;
    }
    TimeLevel &
    level()
    {
      return level_;
    }
    NewtonSolver &
    solver()
    {
      return solver_;
    }
    SolverMemory &
    memory()
    {
      return memory_;
    }
    Timings &
    timings()
    {
      return timings_;
    }

  private:
    /** What a mesh has to do with: points of the coupling, on the ranks that lead teams, and the width of the thinnest film. */
    struct Surroundings
    {
      std::vector<dealii::Point<3>> points;
      double                        film;
    };
    Surroundings
    surroundings(const State &state, const std::vector<ShellFields> &others);
    std::array<double, 3>
    periods() const;

    /** Width of the thinnest film between two shells, or a shell and a wall, the same on all ranks; infinite where nothing depends on it. */
    double
    thinnest_film(const ShellConfigurations &shells) const;

    /** See distance_from_faces(). */
    double
    distance_from_faces(const ShellConfigurations &shells) const;

    const SceneDescription description_;
    const MPI_Comm         communicator_;
    Timings                timings_;
    SolverMemory           memory_;
    Fluid                  fluid_;
    const Capsules         capsules_;
    ShellLayout            layout_;
    const DistributedShell elasticity_;
    Coupling               coupling_;
    TimeLevel              level_;
    NewtonSolver           solver_;

    std::vector<ShellFields> mesh_shells_;
  };
} // namespace tanktread

#endif
