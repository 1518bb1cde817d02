// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: errors of the flow that given forces on a shell make, plain and enriched, and what it costs.
//
// Usage: interface_study [--scenes sphere2,...] [--cells 32,64,128] [--interfaces plain,enriched] [--box 40] [--coarsest 2.5] [--band 1.5] [--grading 0]
// [--finer-shell 0]
//                        [--repeat 3] [--boundary faces|unbounded]
// boundary: a box between walls and periodic faces, or in unbounded liquid.
// One line of CSV a scene, interface and mesh on the standard output. h = 10a/cells, control mesh of level log2(cells/8) and `finer-shell` more. Scenes:
//   sphere2, sphere4   sphere off the centre, tractions of degree 2 and 4; error against the exact flow in unbounded liquid
//   ellipsoid          2:1:1, tilted; smooth traction (waves)
//   biconcave          biconcave disk, tilted; smooth traction
//   ellipsoid3, oblate 3:1:1, and a spheroid 0.4 times as high as wide, tilted; smooth traction (waves)
//   steady, soft       sphere sheared at G = 0.2, khat = 0.04 or 0, until it is nearly steady; smooth traction (waves)
//   ellipsoid_tension, ellipsoid3_tension, oblate_tension, biconcave_tension, steady_tension, soft_tension   the same shapes with the forces of a uniform tension
//   periodic           sphere in the edge of a box of 10a, cut into four by the periodic faces; traction of degree 2
// Errors of all but the first two are differences from two finer meshes, 10a/128 and 10a/256 (enriched, graded), extrapolated with second order on the same
// control mesh; with each control
// mesh of `ellipsoid` and `biconcave` a line `shell` says how far that is from the one of level 4.

#include <deal.II/base/mpi.h>

#include <tanktread/base/mpi_errors.h>

#include "force_problems.h"
#include "measurement.h"

#include <sys/resource.h>

#include <functional>
#include <iostream>
#include <map>
#include <memory>
#include <sstream>

using namespace tanktread;
using oracle::GivenForces;

namespace
{
  constexpr double       tolerance    = 1e-8; // of the linear solver
  constexpr unsigned int finest_level = 4;    // of control meshes that others are compared with

  struct Options
  {
    std::vector<std::string>  scenes     = {"sphere2", "sphere4", "ellipsoid", "biconcave", "steady", "periodic"};
    std::vector<std::string>  interfaces = {"plain", "enriched"};
    std::vector<unsigned int> cells      = {32, 64, 128};
    double                    box = 40., coarsest = 2.5, band = 1.5;
    unsigned int              grading = 0, finer_shell = 0, repeat = 3;
    bool                      unbounded = false;
  };


  /** User time of this process (s). */
  double
  cpu_seconds()
  {
    rusage usage;
    getrusage(RUSAGE_SELF, &usage);
    return usage.ru_utime.tv_sec + 1e-6 * usage.ru_utime.tv_usec;
  }


  /** Median of the CPU seconds of `n` calls. */
  double
  median_cpu(const unsigned int n, const std::function<void()> &call)
  {
    std::vector<double> times;
    for (unsigned int i = 0; i < n; ++i)
      {
        const double start = cpu_seconds();
        call();
        times.push_back(cpu_seconds() - start);
      }
    std::sort(times.begin(), times.end());
    return times[n / 2];
  }


  /** What the errors on one control mesh are measured against. */
  struct Reference
  {
    ControlPoints velocity;        // of the control points, extrapolated from two meshes
    double        power, estimate; // f . U and the relative difference of velocity from the finer of the two meshes
  };


  /** Computed once for each scene and level. */
  const Reference &
  reference(const std::string &name, const unsigned int level, const Options &options)
  {
    static std::map<std::pair<std::string, unsigned int>, Reference> known;
    const auto                                                       found = known.find({name, level});
    if (found != known.end())
      return found->second;
    Reference     result;
    ControlPoints coarse;
    double        coarse_power = 0.;
    for (const unsigned int cells : {128, 256})
      {
        const Problem problem = make_problem(name, level, options.box);
        GivenForces   scene(problem.shape, Interface::enriched, problem.box, {10. / cells, options.coarsest, 2., 4}, {problem.centre}, {}, options.unbounded);
        const ControlPoints F        = problem.forces(scene);
        const ControlPoints velocity = scene.flow({F}, tolerance).velocity[0];
        const double        power    = F.cwiseProduct(velocity).sum();
        if (cells == 256)
          {
            result.velocity = velocity + (velocity - coarse) / 3.;
            result.power    = power + (power - coarse_power) / 3.;
            result.estimate = scene.difference(velocity, result.velocity);
          }
        coarse       = velocity;
        coarse_power = power;
      }
    std::cerr << name << ", level " << level << ": finest mesh and extrapolated differ by " << result.estimate << std::endl;
    return known[{name, level}] = result;
  }


  const char *const header =
    "scene,interface,cells,level,fluid_cells,points,error,power_error,reference_error,iterations,solve_cpu,geometry_cpu,stokes_cpu,mesh_cpu,box,coarsest,band,grading,boundary,radius,curved_share";


  /** One line of the table. */
  void
  measure(const std::string &name, const std::string &interface, const unsigned int cells, const Options &options)
  {
    const unsigned int  level   = std::lround(std::log2(cells / 8.)) + options.finer_shell;
    const Problem       problem = make_problem(name, level, options.box);
    const double        start   = cpu_seconds();
    GivenForces         scene(problem.shape,
                      interface == "plain" ? Interface::plain : Interface::enriched,
                      problem.box,
                      {10. / cells, options.coarsest, options.band, options.grading},
                      {problem.centre},
                      {},
                      options.unbounded);
    const double        mesh_cpu = cpu_seconds() - start;
    const ControlPoints F        = problem.forces(scene);

    GivenForces::Flow flow;
    const double      solve_cpu = median_cpu(options.repeat, [&] { flow = scene.flow({F}, tolerance); });
    const double geometry_cpu   = median_cpu(options.repeat, [&] { scene.coupling.move(shell_configurations(scene.scene.capsule(), positions(scene.state))); });
    const double stokes_cpu     = median_cpu(options.repeat, [&] {
      FluidBlockVector load, fields;
      scene.fluid.space().reinit(load);
      scene.fluid.space().reinit(fields);
      scene.coupling.spread_plainly(scene.coupling.density({F}), load);
      solve_fgmres(scene.fluid.stokes(), scene.fluid.preconditioner(), fields, load, 1e-6, 200);
    });

    const double  power = F.cwiseProduct(flow.velocity[0]).sum();
    double        error, wanted_power, reference_error = 0.;
    ControlPoints at_points = scene.coupling_surface.S() * flow.velocity[0];
    if (problem.degree > 0)
      {
        const auto [traction, exact] = oracle::exact_on_sphere(scene.X(), scene.centre(), problem.degree);
        error                        = scene.difference_at_points(at_points, exact);
        at_points -= exact;
        wanted_power = traction.cwiseProduct(exact).rowwise().sum().dot(scene.weights());
      }
    else
      {
        const Reference &wanted = reference(name, level, options);
        error                   = scene.difference(flow.velocity[0], wanted.velocity);
        wanted_power            = wanted.power;
        reference_error         = wanted.estimate;
        at_points -= scene.coupling_surface.S() * wanted.velocity;
      }
    const OfCurvature curvature = of_curvature(scene, at_points.rowwise().squaredNorm());
    std::cout << name << ',' << interface << ',' << cells << ',' << level << ',' << scene.fluid.mesh().triangulation().n_global_active_cells() << ','
              << scene.coupling_surface.n_points() << ',' << error << ',' << power / wanted_power - 1. << ',' << reference_error << ',' << flow.iterations
              << ',' << solve_cpu << ',' << geometry_cpu << ',' << stokes_cpu << ',' << mesh_cpu << ',' << problem.box << ',' << options.coarsest << ','
              << options.band << ',' << options.grading << ',' << (options.unbounded ? "unbounded" : "faces") << ',' << curvature.radius << ','
              << curvature.curved_share << std::endl;
  }


  /** Error of a control mesh: the extrapolated velocity on it beside that on the mesh of level 4, at the same material points. */
  void
  measure_shell(const std::string &name, const unsigned int level, const Options &options)
  {
    const auto field = [&](const unsigned int l) {
      return refined({make_problem(name, l, options.box).shape.topology, reference(name, l, options).velocity}, finest_level - l).control_points;
    };
    const Problem            problem = make_problem(name, finest_level, options.box);
    const SubdivisionSurface surface(problem.shape.topology, triangle_quadrature(3), Derivatives::first);
    const Eigen::VectorXd    weights    = area_weights(surface, problem.shape.control_points);
    const ControlPoints      fine       = surface.S() * field(finest_level);
    const ControlPoints      difference = surface.S() * field(level) - fine;
    const double             error      = std::sqrt(difference.rowwise().squaredNorm().dot(weights) / fine.rowwise().squaredNorm().dot(weights));
    std::cout << name << ",shell," << 8 * (1 << level) << ',' << level << ",,," << error << ",,,,,,,," << problem.box << ',' << options.coarsest << ",,,"
              << std::endl;
  }


  template <typename T>
  std::vector<T>
  read_list(const std::string &text)
  {
    std::vector<T>     result;
    std::istringstream stream(text);
    for (std::string word; std::getline(stream, word, ',');)
      {
        std::istringstream one(word);
        T                  value;
        if (!(one >> value) || !one.eof())
          throw InputError("'" + word + "' in '" + text + "' is not what the option takes.");
        result.push_back(value);
      }
    if (result.empty())
      throw InputError("The option got '" + text + "'; allowed: values separated by commas.");
    return result;
  }


  Options
  parse(const std::vector<std::string> &words)
  {
    Options options;
    auto    names = options.scenes;
    for (const std::string name : {"ellipsoid3", "oblate", "soft"})
      names.push_back(name);
    for (const std::string name : {"ellipsoid", "ellipsoid3", "oblate", "biconcave", "steady", "soft"})
      names.push_back(name + "_tension");
    for (std::size_t i = 0; i + 1 < words.size(); i += 2)
      {
        const std::string &name = words[i], &value = words[i + 1];
        if (name == "--scenes")
          options.scenes = read_list<std::string>(value);
        else if (name == "--interfaces")
          options.interfaces = read_list<std::string>(value);
        else if (name == "--cells")
          options.cells = read_list<unsigned int>(value);
        else if (name == "--box")
          options.box = read_list<double>(value)[0];
        else if (name == "--coarsest")
          options.coarsest = read_list<double>(value)[0];
        else if (name == "--band")
          options.band = read_list<double>(value)[0];
        else if (name == "--grading")
          options.grading = read_list<unsigned int>(value)[0];
        else if (name == "--finer-shell")
          options.finer_shell = read_list<unsigned int>(value)[0];
        else if (name == "--boundary" && (value == "faces" || value == "unbounded"))
          options.unbounded = value == "unbounded";
        else if (name == "--repeat")
          options.repeat = std::max(1u, read_list<unsigned int>(value)[0]);
        else
          throw InputError("Unknown option '" + name + "' or value '" + value + "'; see the first lines of interface_study.cc.");
      }
    if (words.size() % 2 == 1)
      throw InputError("Option '" + words.back() + "' has no value.");
    for (const std::string &scene : options.scenes)
      if (std::find(names.begin(), names.end(), scene) == names.end())
        throw InputError("--scenes: got '" + scene + "'; allowed: those in the first lines of interface_study.cc.");
    for (const std::string &interface : options.interfaces)
      if (interface != "plain" && interface != "enriched")
        throw InputError("--interfaces: got '" + interface + "'; allowed: plain, enriched.");
    if (options.unbounded && std::find(options.scenes.begin(), options.scenes.end(), "periodic") != options.scenes.end())
      throw InputError("--scenes: got 'periodic' with '--boundary unbounded'; allowed: the others.");
    for (const unsigned int cells : options.cells)
      if (cells < 32 || cells > 256)
        throw InputError("--cells: got " + std::to_string(cells) + "; allowed: 32 to 256.");
    return options;
  }


  void
  work(const std::vector<std::string> &words)
  {
    const Options options = parse(words);
    if (dealii::Utilities::MPI::n_mpi_processes(MPI_COMM_WORLD) > 1)
      throw InputError("interface_study measures CPU seconds of one rank; start it without mpirun.");
    std::cout << header << std::endl;
    for (const std::string &scene : options.scenes)
      {
        for (const unsigned int cells : options.cells)
          for (const std::string &interface : options.interfaces)
            measure(scene, interface, cells, options);
        if ((scene == "ellipsoid" || scene == "biconcave") && options.finer_shell == 0)
          for (const unsigned int cells : options.cells)
            if (const unsigned int level = std::lround(std::log2(cells / 8.)); level < finest_level)
              measure_shell(scene, level, options);
      }
  }
} // namespace


int
main(int argc, char *argv[])
{
  const std::vector<std::string> words(argv + 1, argv + argc);
  argc = 1; // PETSc would take our options for its own.
  const dealii::Utilities::MPI::MPI_InitFinalize mpi(argc, argv, 1);
  return exit_code_of(MPI_COMM_WORLD, [&words] { work(words); });
}
