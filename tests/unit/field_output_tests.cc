// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: the fluid's fields as they stand in VTU files.

#include <deal.II/base/mpi.h>
#include <deal.II/base/utilities.h>

#include <gtest/gtest.h>
#include <tanktread/fluid/field_output.h>
#include <tanktread/fluid/undisturbed_flow.h>
#include <unistd.h>
#include <zlib.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <regex>
#include <sstream>
#include <stdexcept>

#include "nodal_velocity.h"

using namespace tanktread;

namespace
{
  using Point = dealii::Point<3>;

  /**
   * The numbers of the first data array whose tag contains `attribute`: base64 of a head (number of blocks, size of a block, of the last, of that packed) and
   * of one block packed by zlib.
   */
  std::vector<double>
  data_array(const std::string &file, const std::string &attribute)
  {
    std::smatch match;
    if (!std::regex_search(file, match, std::regex("<DataArray type=\"Float(32|64)\"[^>]*" + attribute + "[^>]*>\\s*")))
      throw std::runtime_error("no data array " + attribute);
    const std::size_t                begin = match.position() + match.length();
    const std::string                text  = file.substr(begin, file.find_first_of(" \n<", begin) - begin);
    const std::vector<unsigned char> head = dealii::Utilities::decode_base64(text.substr(0, 24)), packed = dealii::Utilities::decode_base64(text.substr(24));
    std::uint32_t                    sizes[4];
    std::memcpy(sizes, head.data(), sizeof(sizes));
    std::vector<unsigned char> bytes(sizes[1]);
    uLongf                     n_bytes = bytes.size();
    if (sizes[0] != 1 || uncompress(bytes.data(), &n_bytes, packed.data(), packed.size()) != Z_OK || n_bytes != bytes.size())
      throw std::runtime_error("not one packed block: " + attribute);
    const auto as_numbers = [&](const auto zero) {
      std::vector<std::decay_t<decltype(zero)>> numbers(bytes.size() / sizeof(zero));
      std::memcpy(numbers.data(), bytes.data(), bytes.size());
      return std::vector<double>(numbers.begin(), numbers.end());
    };
    return match[1] == "32" ? as_numbers(0.f) : as_numbers(0.);
  }


  FluidMeshParameters
  two_sizes_of_cells()
  {
    FluidMeshParameters p;
    p.coarsest_cell = 1.;
    p.finest_cell   = 0.5;
    p.band_width    = 1.;
    return p;
  }


  std::string
  written(const TaylorHoodSpace &space, const FluidBlockVector &fields, const UndisturbedFlow &undisturbed)
  {
    const std::string folder = std::filesystem::temp_directory_path() / ("tanktread_fields_" + std::to_string(getpid()));
    std::filesystem::create_directory(folder);
    write_fluid_fields(folder, "fluid", 3, space, fields, undisturbed, [](const Point &x) { return 2. * x[0]; });
    std::stringstream content;
    content << std::ifstream(folder + "/fluid_00003.0.vtu").rdbuf();
    std::filesystem::remove_all(folder);
    return content.str();
  }
} // namespace


TEST(FieldOutput, VelocityIsDisturbancePlusUndisturbedFlow)
{
  FluidMesh mesh(MPI_COMM_WORLD, 4., two_sizes_of_cells());
  mesh.adapt({Point(1.9, 0.2, 0.3)});
  const TaylorHoodSpace space(mesh);
  // A disturbance and a pressure that the elements hold; an undisturbed flow that is not periodic, so that both copies of a node at the faces have their own.
  const FluidBlockVector fields      = nodal_velocity(space, [](const Point &x) { return std::array<double, 3>{{0., 4. - x[2] * x[2], 0.}}; });
  UndisturbedFlow        undisturbed = planar_extension(0.7);
  undisturbed.constant[2]            = 0.3;
  undisturbed.quadratic[1][0][0]     = 0.4;
  undisturbed.quadratic[0][1][2] = undisturbed.quadratic[0][2][1] = -0.2;
  const std::string         file                                  = written(space, fields, undisturbed);
  const std::vector<double> x = data_array(file, "NumberOfComponents=\"3\""), u = data_array(file, "Name=\"velocity\""),
                            p = data_array(file, "Name=\"pressure\"");
  ASSERT_EQ(x.size(), 81u * space.velocity->n_cells()); // 27 a cell, each cell its own
  ASSERT_EQ(u.size(), x.size());
  ASSERT_EQ(p.size(), x.size() / 3);
  double largest_x = 0.;
  for (std::size_t i = 0; i < p.size(); ++i)
    {
      const Point          at(x[3 * i], x[3 * i + 1], x[3 * i + 2]);
      dealii::Tensor<1, 3> expected = undisturbed.velocity(at);
      expected[1] += 4. - at[2] * at[2];
      for (unsigned int c = 0; c < 3; ++c)
        ASSERT_NEAR(u[3 * i + c], expected[c], 1e-6) << at;
      ASSERT_NEAR(p[i], 2. * at[0], 1e-6) << at;
      largest_x = std::max(largest_x, at[0]);
    }
  EXPECT_EQ(largest_x, 2.);
}
