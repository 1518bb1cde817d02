// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: speed of the element kernels and of what is made of them, beside that of the machine.
//
// Usage: kernels [cells along the box side, default 128]. One thread; Markdown tables on the standard output.

#include <deal.II/base/mpi.h>

#include <tanktread/base/exceptions.h>
#include <tanktread/base/mpi_errors.h>
#include <tanktread/fluid/stokes_preconditioner.h>

#include "machine.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <string>
#include <vector>

using namespace tanktread;

namespace
{
  // ---- The mesh ----

  /** Everything on a mesh that is fine around the unit sphere, as Fluid makes it. */
  struct Scene
  {
    explicit Scene(const int n)
      : mesh(MPI_COMM_WORLD, 10., {10. / n, 2.5, 1.5})
    {
      std::vector<dealii::Point<3>> points;
      const double                  h        = 10. / n;
      const int                     n_points = 50. / (h * h) + 1.; // on a spiral, closer than h
      for (int i = 0; i < n_points; ++i)
        {
          const double z = 1. - (2. * i + 1.) / n_points, r = std::sqrt(1. - z * z), angle = 2.399963229728653 * i;
          points.emplace_back(r * std::cos(angle), r * std::sin(angle), z);
        }
      mesh.aim_at(points);
      for (Multigrid<float> *const climbing : {&pressure_multigrid, &multigrid})
        {
          mesh.restart();
          climbing->start(mesh);
          while (!mesh.on_last_rung())
            climbing->climb(mesh);
        }
      space          = std::make_unique<TaylorHoodSpace>(mesh, multigrid.space());
      stokes         = std::make_unique<StokesOperator>(*space);
      preconditioner = std::make_unique<StokesPreconditioner>(*space, multigrid, pressure_multigrid);
    }

    FluidMesh                             mesh;
    Multigrid<float>                      multigrid, pressure_multigrid{{{}, 1}};
    std::unique_ptr<TaylorHoodSpace>      space;
    std::unique_ptr<StokesOperator>       stokes;
    std::unique_ptr<StokesPreconditioner> preconditioner;
  };


  // ---- Kernels ----

  /**
   * Operations a cell for all three components; multiplications by 0 and 1 and those with the unused fourth number do not count. A cell has 9 lines of three
   * nodes along each axis.
   *
   * Laplace: to_modes() and from_modes() take 6 each, 27 lines; two multiplications a mode.
   * Divergence: a line of values takes 2 x 2, of derivatives 2 x 4; there are 9 lines along x, 6 along y, 4 along z, and each component has derivatives along
   * one of them. Then
   * the sum of the components, the factor and the sum over the cells. Its transpose: 2 and 6 a line.
   * Strain form: three nodes of a line to its three points take 10 for values, 11 for derivatives, and so does the transpose; 8 sweeps of 9 lines each way, 3
   * of them
   * derivatives; adding up two sweeps; at a point the factor, and sum and product for nine derivatives.
   * Inertia: 9 sweeps for value and gradient of a field, 3 of them derivatives, and 3 back; at a point the wind, v . grad u, u . grad u_inf, mass and factors,
   * as for a simple shear. Its derivative does all but the way back for two fields, and v . grad u twice.
   */
  struct Operations
  {
    static constexpr double add         = 3 * 27; // to y_u
    static constexpr double laplace     = 3 * (27 * (6 + 6) + 27 * 2);
    static constexpr double divergence  = 3 * 4 * (9 + 6 + 4) + 4 * (9 + 6 + 4) + 8 * (2 + 1 + 1);
    static constexpr double gradient    = 3 * 2 * (9 + 6 + 4) + 4 * (9 + 6 + 4) + 8;
    static constexpr double strain_form = 3 * (2 * 9 * (3 * 11 + 5 * 10) + 2 * 27) + 27 * (2 + 9 * 2);
    static constexpr double helmholtz   = laplace + 3 * 27;
    static constexpr double point_field = 3 * 9 * (3 * 11 + 6 * 10);
    static constexpr double inertia     = point_field + 3 * 9 * 3 * 10 + 27 * 3 * (2 + 5 + 2 + 4 + 1);
    static constexpr double derivative  = inertia + point_field + 27 * 3 * (5 + 1);
    static constexpr double mass        = 8 + 3 * 4 * 3 + 8;
  };


  template <typename Number>
  struct Arrays
  {
    explicit Arrays(const TaylorHoodSpace &space)
      : u(space.velocity->full_size())
      , p(space.pressure->full_size())
      , y_u(u.size())
      , y_p(p.size())
      , viscosity(27 * std::size_t(space.velocity->n_cells()), Number(1))
      , corners(lower_corners(space))
    {
      for (auto *array : {&u, &p})
        for (std::size_t i = 0; i < array->size(); ++i)
          (*array)[i] = Number(i % 17) - Number(8);
    }
    dealii::AlignedVector<Number> u, p, y_u, y_p, viscosity;
    std::vector<double>           corners;
  };


  struct Kernel
  {
    std::string                         name;
    std::function<void(InstructionSet)> run;
    double                              operations; // a cell
    double                              numbers;    // read and written
    unsigned int                        n_indices;  // a cell
    double                              unknowns;
    bool                                one_instruction_set = false;
  };


  template <typename Number>
  std::vector<Kernel>
  kernels(const TaylorHoodSpace &space, Arrays<Number> &x)
  {
    using Set       = InstructionSet;
    using O         = Operations;
    const Cubes   c = cubes(space);
    const double  u = x.u.size(), p = x.p.size(); // numbers of an array; what a kernel adds to is read and written
    const double  n_u = space.velocity->partitioner()->size(), n_p = space.pressure->partitioner()->size();
    Number *const in_u = x.u.data(), *const in_p = x.p.data(), *const y_u = x.y_u.data(), *const y_p = x.y_p.data(), *const mu = x.viscosity.data();
    const InertiaCoefficients<Number> inertia{1, 1};
    const UndisturbedFlow             shear = simple_shear(), parabola = plane_poiseuille(5.);
    const double *const               at = x.corners.data();
    return {
      {"Laplace", [=](Set s) { add_laplace<Number>(s, c, in_u, y_u); }, O::laplace + O::add, 3 * u, 27, n_u},
      {"Helmholtz", [=](Set s) { add_helmholtz<Number>(s, c, c.size, in_u, y_u); }, O::helmholtz + O::add, 3 * u, 27, n_u},
      {"Stokes",
       [=](Set s) { add_stokes<Number>(s, c, in_u, in_p, y_u, y_p); },
       O::laplace + O::divergence + O::gradient + 2 * O::add,
       3 * (u + p),
       35,
       n_u + n_p},
      {"pressure gradient", [=](Set s) { add_pressure_gradient<Number>(s, c, in_p, y_u); }, O::gradient + O::add, p + 2 * u, 35, n_u + n_p},
      {"divergence", [=](Set s) { add_divergence<Number>(s, c, in_u, y_p); }, O::divergence, u + 2 * p, 35, n_u + n_p},
      {"pressure mass", [=](Set) { add_pressure_mass<Number>(c, in_p, y_p); }, O::mass, 3 * p, 8, n_p, true},
      {"strain form", [=](Set s) { add_viscous<Number>(s, c, mu, in_u, y_u); }, O::strain_form + O::add, 3 * u + 27. * c.n, 27, n_u},
      {"inertia, shear", [=](Set s) { add_inertia<Number>(s, c, at, shear, inertia, in_u, y_u); }, O::inertia + O::add, 3 * u + 3. * c.n, 27, n_u},
      {"its derivative",
       [=](Set s) { add_inertia_derivative<Number>(s, c, at, shear, inertia, in_u, in_u, y_u); },
       O::derivative + O::add,
       3 * u + 3. * c.n,
       27,
       n_u},
      {"inertia, parabola", [=](Set s) { add_inertia<Number>(s, c, at, parabola, inertia, in_u, y_u); }, O::inertia + O::add, 3 * u + 3. * c.n, 27, n_u},
      {"its derivative",
       [=](Set s) { add_inertia_derivative<Number>(s, c, at, parabola, inertia, in_u, in_u, y_u); },
       O::derivative + O::add,
       3 * u + 3. * c.n,
       27,
       n_u},
    };
  }


  template <typename Number>
  void
  measure_kernels(const TaylorHoodSpace &space, const Machine &machine)
  {
    Arrays<Number>    arrays(space);
    const bool        is_float = sizeof(Number) == sizeof(float);
    const double      peak = is_float ? machine.peak_float : machine.peak_double, n_cells = space.velocity->n_cells();
    const char *const names[] = {"baseline", "AVX2", "AVX-512"};
    for (const Kernel &kernel : kernels(space, arrays))
      for (int set = 0; set <= (kernel.one_instruction_set ? 0 : int(best_instruction_set())); ++set)
        {
          const double seconds = best_time([&] { kernel.run(InstructionSet(set)); });
          const double bytes   = kernel.numbers * sizeof(Number) + n_cells * (4. * kernel.n_indices + 8.); // 8: size of the cell
          const double bound   = std::max(bytes / machine.bandwidth(), n_cells * kernel.operations / peak);
          std::printf("| %s | %s | %s | %.1f | %.0f | %.1f | %.0f%% |\n",
                      kernel.name.c_str(),
                      is_float ? "float" : "double",
                      names[set],
                      1e9 * seconds / n_cells,
                      1e-6 * kernel.unknowns / seconds,
                      1e-9 * n_cells * kernel.operations / seconds,
                      100. * bound / seconds);
        }
  }


  // ---- What is made of them ----

  void
  measure_operators(Scene &scene)
  {
    const TaylorHoodSpace       &space = *scene.space;
    const LaplaceOperator<float> laplace(*space.velocity);
    Arrays<float>                arrays(space);
    FluidBlockVector             x, y;
    space.reinit(x);
    space.reinit(y);
    for (unsigned int b = 0; b < 2; ++b)
      for (auto &entry : x.block(b))
        entry = std::sin(double(&entry - x.block(b).begin()));
    const double n_u = x.block(velocity_block).size(), n = x.size();
    std::printf("\n| operator | ms | MDoF/s |\n|---|---:|---:|\n");
    const auto row = [](const char *name, const double unknowns, const std::function<void()> &call) {
      const double seconds = best_time(call);
      std::printf("| %s | %.2f | %.1f |\n", name, 1e3 * seconds, 1e-6 * unknowns / seconds);
    };
    std::copy(arrays.u.begin(), arrays.u.end(), scene.multigrid.right_hand_side());
    row("LaplaceOperator<float>::apply", n_u, [&] { laplace.apply(arrays.u.data(), arrays.y_u.data()); });
    row("StokesOperator::vmult", n, [&] { scene.stokes->vmult(y, x); });
    row("Multigrid<float>::v_cycle", n_u, [&] { scene.multigrid.v_cycle(); });
    row("the same of the pressures", space.pressure->partitioner()->size(), [&] { scene.pressure_multigrid.v_cycle(); });
    row("StokesPreconditioner::vmult", n, [&] { scene.preconditioner->vmult(y, x); });
  }


  void
  work(const int n)
  {
    const Machine          machine = measure_machine();
    Scene                  scene(n);
    const TaylorHoodSpace &space = *scene.space;
    std::printf(
      "h = 10a/%d: %u cells, %u velocity and %u pressure unknowns. DoF: unknowns of the fields that a kernel reads or writes. Bound: time that "
      "the machine\nneeds at least, with arrays and indices read once and results read and written once, all from memory (arrays that fit into the caches may be faster).\n\n",
      n,
      space.velocity->n_cells(),
      unsigned(space.velocity->partitioner()->size()),
      unsigned(space.pressure->partitioner()->size()));
    std::printf("| kernel | numbers | instructions | ns/cell | MDoF/s | GFlop/s | bound/time |\n|---|---|---|---:|---:|---:|---:|\n");
    measure_kernels<float>(space, machine);
    measure_kernels<double>(space, machine);
    measure_operators(scene);
  }
} // namespace

int
main(int argc, char *argv[])
{
  const int n = argc > 1 ? std::atoi(argv[1]) : 128;
  argc        = 1; // PETSc would take our argument for its own.
  const dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  return exit_code_of(MPI_COMM_WORLD, [n] {
    if (n < 4 || dealii::Utilities::MPI::n_mpi_processes(MPI_COMM_WORLD) > 1)
      throw InputError("kernels: one rank, and at least 4 cells along the side of the box.");
    work(n);
  });
}
