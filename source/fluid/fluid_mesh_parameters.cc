// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: section "Fluid mesh" of the parameter file.

#include <deal.II/base/parameter_handler.h>

#include <tanktread/base/enum_parameter.h>
#include <tanktread/base/exceptions.h>
#include <tanktread/fluid/fluid_mesh_parameters.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>
#include <string>

namespace tanktread
{
  void
  FluidMeshParameters::add_parameters(dealii::ParameterHandler &prm)
  {
    using dealii::Patterns::Double;
    using dealii::Patterns::Integer;
    prm.enter_subsection("Fluid mesh");
    prm.add_parameter("Finest cell",
                      finest_cell,
                      "Side of the cells at the shell, in a; the mesh takes the next smaller side its octree has.",
                      Double(1e-4, 10.));
    prm.add_parameter(
      "Coarsest cell",
      coarsest_cell,
      "Side of the cells away from the shell, in a; adjusted so that they divide the box into numbers of cells that can be halved down to a few.",
      Double(1e-4, 100.));
    prm.add_parameter("Band width", band_width, "Distance from the shell within which cells are finest ones, in finest cells.", Double(1., 20.));
    prm.add_parameter(
      "Grading",
      grading,
      "Distance from the shell within which cells of any larger size are not larger, in cells of that size; 0: they grow as fast as 2:1 balance lets them.",
      Integer(0, 16));
    add_enum_parameter(prm,
                       "Pressure space",
                       pressure_space,
                       {{"Q1", PressureSpace::q1}},
                       "Q1: continuous trilinear functions and the indicator of the capsule's interior.");
    prm.add_parameter("Finest cell in gaps",
                      finest_in_gaps,
                      "How small the cells at all shells may become, in a, while a film between two shells or a shell and a wall is thinner than two of them: "
                      "halved until two fit, never below this side; 0: Finest cell, whatever the films.",
                      Double(0., 10.));
    prm.leave_subsection();
  }


  namespace
  {
    constexpr double most_off   = 0.5;  // octaves between the size of cells asked for and the one chosen
    constexpr int    most_cells = 4096; // on the first rung

    std::string
    text(const std::array<double, 3> &side)
    {
      std::ostringstream result;
      result << side[0] << " x " << side[1] << " x " << side[2];
      return result.str();
    }


    /** How many cubes of side h there are along each axis if they fill the box, else one zero. */
    std::array<int, 3>
    numbers_of_cells(const Box &box, const double h)
    {
      std::array<int, 3> result;
      for (unsigned int d = 0; d < 3; ++d)
        {
          const double n = std::round(box.side[d] / h);
          result[d]      = std::abs(n * h / box.side[d] - 1.) < 1e-9 && n >= (box.is_periodic(d) ? 2 : 1) ? static_cast<int>(n) : 0;
        }
      return result;
    }


    BoxDivision
    halved(std::array<int, 3> n, const Box &box)
    {
      BoxDivision result{n, 0};
      const auto  can_be_halved = [&] {
        bool even = true;
        for (unsigned int d = 0; d < 3; ++d)
          even = even && result.n_rung_0[d] % 2 == 0 && !(box.is_periodic(d) && result.n_rung_0[d] == 2);
        return even && *std::max_element(result.n_rung_0.begin(), result.n_rung_0.end()) > 4;
      };
      for (; can_be_halved(); ++result.coarsest_level)
        for (int &i : result.n_rung_0)
          i /= 2;
      return result;
    }


    /** Calls f(h, cells along the axes) for all cubes that fill the box and are at most `octaves` larger or smaller than asked for. */
    template <typename Function>
    void
    for_cubes_near(const Box &box, const double asked, const double octaves, const Function &f)
    {
      const double shortest = *std::min_element(box.side.begin(), box.side.end()), factor = std::exp2(octaves + 1e-9);
      for (int n = std::max(1., std::ceil(shortest / (asked * factor))); n <= shortest / asked * factor; ++n)
        {
          const std::array<int, 3> cells = numbers_of_cells(box, shortest / n);
          if (cells[0] > 0 && cells[1] > 0 && cells[2] > 0)
            f(shortest / n, cells);
        }
    }


    [[noreturn]] void
    throw_indivisible(const Box &box, const double asked)
    {
      std::ostringstream message;
      message << "Scene/Box side is " << text(box.side) << "; allowed: multiples of one size of cells near Fluid mesh/Coarsest cell, " << asked
              << " (at least two cells along periodic axes), such as ";
      std::array<double, 3> near;
      for (unsigned int d = 0; d < 3; ++d)
        near[d] = asked * std::max(std::round(box.side[d] / asked), box.is_periodic(d) ? 2. : 1.);
      message << text(near);
      double nearest = 0.;
      for_cubes_near(box, asked, 6., [&](const double h, const auto &) {
        if (nearest == 0. || std::abs(std::log2(h / asked)) < std::abs(std::log2(nearest / asked)))
          nearest = h;
      });
      if (nearest > 0.)
        message << "; cells of " << nearest << " would divide this box";
      throw InputError(message.str() + '.');
    }
  } // namespace


  BoxDivision
  divide(const Box &box, const double coarsest_cell)
  {
    if (box.is_periodic(0) && box.is_periodic(1) && box.is_periodic(2))
      throw InputError("The box is periodic along all three axes; allowed: prescribed velocities on at least one pair of faces, which hold the liquid.");
    BoxDivision best;
    double      least = std::numeric_limits<double>::infinity();
    for_cubes_near(box, coarsest_cell, most_off, [&](const double h, const std::array<int, 3> &n) {
      const BoxDivision division = halved(n, box);
      const double      n_cells  = double(division.n_rung_0[0]) * division.n_rung_0[1] * division.n_rung_0[2];
      const double      cost     = std::abs(std::log2(h / coarsest_cell)) + n_cells / 1024.;
      if (n_cells <= most_cells && cost < least)
        {
          least = cost;
          best  = division;
        }
    });
    if (std::isinf(least))
      throw_indivisible(box, coarsest_cell);
    return best;
  }


  void
  FluidMeshParameters::check(const Box &box) const
  {
    const double       least = std::cbrt(box.volume()) / 64., longest = *std::max_element(box.side.begin(), box.side.end());
    double             most = std::numeric_limits<double>::infinity();
    std::ostringstream message;
    for (unsigned int d = 0; d < 3; ++d)
      most = std::min(most, box.is_periodic(d) ? 0.5 * box.side[d] : box.side[d]);
    if (coarsest_cell > most)
      message << "Fluid mesh/Coarsest cell is " << coarsest_cell << "; allowed: at most " << most
              << ", the shortest side of the box or half of the shortest periodic one (Scene/Box side).";
    else if (coarsest_cell < least)
      message << "Fluid mesh/Coarsest cell is " << coarsest_cell << "; allowed: at least " << least
              << ", 64^3 cells in the box (only the neighbourhood of the shell needs small cells).";
    else if (finest_cell > coarsest_cell)
      message << "Fluid mesh/Finest cell is " << finest_cell << "; allowed: at most Fluid mesh/Coarsest cell, " << coarsest_cell << '.';
    else if (longest / finest_cell > 1 << 18)
      message << "Fluid mesh/Finest cell is " << finest_cell << "; allowed: at least " << longest / (1 << 18) << " in this box.";
    else if (finest_in_gaps > finest_cell)
      message << "Fluid mesh/Finest cell in gaps is " << finest_in_gaps << "; allowed: at most Fluid mesh/Finest cell, " << finest_cell << ", or 0.";
    else if (finest_in_gaps > 0. && longest / finest_in_gaps > 1 << 18)
      message << "Fluid mesh/Finest cell in gaps is " << finest_in_gaps << "; allowed: at least " << longest / (1 << 18) << " in this box, or 0.";
    if (!message.str().empty())
      throw InputError(message.str());
    divide(box, coarsest_cell);
  }
} // namespace tanktread
