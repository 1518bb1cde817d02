// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: errors of the flow between two shells that share cells, against the gap in cells.
//
//   film_study [--gaps 0.03125,0.078125,0.15625,0.3125,0.625] [--ratios 1,5] [--cells 24,48] [--reference 96] [--sweeps 3]
//
// Two spheres of 162 control points with that gap (in a) in a box of 7.5a, which has so many finest cells a side. Forces: `waves`, other smooth ones on each
// shell, and `squeeze`, of one direction on each, which push them together. A row compares with the reference's cells: all velocities (L2), those on the part of
// the shells within a/2 of the middle of the film, and the mean speed at which these two parts come together. Sweeps: of the viscous part of the jumps, with two
// viscosities.

#include <deal.II/base/mpi.h>

#include <oracle/given_forces.h>
#include <tanktread/base/exceptions.h>
#include <tanktread/base/mpi_errors.h>

#include <cmath>
#include <iostream>
#include <map>
#include <sstream>
#include <string>
#include <vector>

using namespace tanktread;

namespace
{
  constexpr double side = 7.5;

  struct Options
  {
    std::vector<double> gaps = {0.03125, 0.078125, 0.15625, 0.3125, 0.625}, ratios = {1., 5.}, cells = {24., 48.};
    double              reference = 96., sweeps = 3.;
  };

  const Eigen::RowVector3d first_centre(-1.013, 0.031, -0.122), direction = Eigen::RowVector3d(1., 0.17, 0.29).normalized();


  ShellFields
  forces(const oracle::GivenForces &scene, const std::string &name)
  {
    ShellFields result;
    for (unsigned int c = 0; c < 2; ++c)
      result.push_back(scene.nodal_forces(name == "waves" ? oracle::waves(scene.X(c), 1.5 + 0.3 * c)
                                                          : ControlPoints((c == 0 ? 1. : -1.) * direction.replicate(scene.X(c).rows(), 1)),
                                          c));
    return result;
  }


  /** Velocities of the control points by the name of the forces. */
  struct Flows
  {
    std::map<std::string, ShellFields> velocity;
    unsigned int                       n_shared_cells;
  };


  Flows
  flows(const double gap, const double ratio, const double cells, const Options &options)
  {
    oracle::GivenForces scene(make_capsule({}, 2),
                              Interface::enriched,
                              side,
                              {side / cells, 2.5, 1.5},
                              {first_centre, first_centre + (2. + gap) * direction},
                              {ratio, {}});
    Flows               result;
    result.n_shared_cells = dealii::Utilities::MPI::sum(scene.coupling.jumps().pairs().n_cells(), MPI_COMM_WORLD);
    for (const std::string name : {"waves", "squeeze"})
      result.velocity[name] = scene.flow(forces(scene, name), 1e-7, ratio == 1. ? 0 : options.sweeps).velocity;
    return result;
  }


  /** What is compared, on points that do not depend on the fluid's cells. */
  struct Norms
  {
    double all = 0., film = 0., approach = 0.; // squares of L2 norms, mean speed
  };


  Norms
  norms(const ShellFields &velocity, const double gap)
  {
    const FittedShape        sphere = make_capsule({}, 2);
    const SubdivisionSurface surface(sphere.topology, triangle_quadrature(12), Derivatives::first);
    const Eigen::VectorXd    weights = area_weights(surface, sphere.control_points);
    Norms                    result;
    for (unsigned int c = 0; c < 2; ++c)
      {
        // The film's middle as seen from the centre of this sphere.
        const Eigen::RowVector3d middle = (c == 0 ? 1. : -1.) * (1. + 0.5 * gap) * direction;
        const ControlPoints      X = surface.S() * sphere.control_points, U = surface.S() * velocity[c];
        double                   area = 0., along = 0.;
        for (Eigen::Index q = 0; q < X.rows(); ++q)
          {
            result.all += weights[q] * U.row(q).squaredNorm();
            if ((X.row(q) - middle).norm() > 0.5 + 0.5 * gap)
              continue;
            result.film += weights[q] * U.row(q).squaredNorm();
            area += weights[q];
            along += weights[q] * U.row(q).dot(direction);
          }
        result.approach += (c == 0 ? 1. : -1.) * along / area;
      }
    return result;
  }


  void
  measure(const double gap, const double ratio, const Options &options)
  {
    const Flows wanted = flows(gap, ratio, options.reference, options);
    for (const double cells : options.cells)
      {
        const Flows found = flows(gap, ratio, cells, options);
        for (const auto &[name, velocity] : found.velocity)
          {
            const ShellFields &reference  = wanted.velocity.at(name);
            ShellFields        difference = velocity;
            for (unsigned int c = 0; c < 2; ++c)
              difference[c] -= reference[c];
            const Norms of_error = norms(difference, gap), of_reference = norms(reference, gap);
            std::cout << name << ',' << ratio << ',' << gap << ',' << side / cells << ',' << gap * cells / side << ',' << gap * options.reference / side << ','
                      << found.n_shared_cells << ',' << std::sqrt(of_error.all / of_reference.all) << ',' << std::sqrt(of_error.film / of_reference.film) << ','
                      << of_error.approach / of_reference.approach << std::endl;
          }
      }
  }


  std::vector<double>
  read_list(const std::string &text)
  {
    std::vector<double> result;
    std::istringstream  stream(text);
    for (std::string word; std::getline(stream, word, ',');)
      {
        std::istringstream one(word);
        double             value;
        if (!(one >> value) || !one.eof() || !(value > 0.))
          throw InputError("'" + word + "' in '" + text + "'; allowed: numbers above 0.");
        result.push_back(value);
      }
    if (result.empty())
      throw InputError("An option got nothing; allowed: numbers separated by commas.");
    return result;
  }


  Options
  parse(const std::vector<std::string> &words)
  {
    Options options;
    for (std::size_t i = 0; i < words.size(); i += 2)
      {
        if (i + 1 == words.size())
          throw InputError("Option '" + words[i] + "' has no value.");
        const std::vector<double> values = read_list(words[i + 1]);
        if (words[i] == "--gaps")
          options.gaps = values;
        else if (words[i] == "--ratios")
          options.ratios = values;
        else if (words[i] == "--cells")
          options.cells = values;
        else if (words[i] == "--reference")
          options.reference = values[0];
        else if (words[i] == "--sweeps")
          options.sweeps = values[0];
        else
          throw InputError("Unknown option '" + words[i] + "'; see the first lines of film_study.cc.");
      }
    return options;
  }


  void
  work(const std::vector<std::string> &words)
  {
    const Options options = parse(words);
    std::cout << "forces,ratio,gap,h,gap_in_cells,gap_in_reference_cells,shared_cells,error,film_error,approach_error" << std::endl;
    for (const double ratio : options.ratios)
      for (const double gap : options.gaps)
        measure(gap, ratio, options);
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
