// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: how many capsules there are, and where.

#include <tanktread/base/enum_parameter.h>
#include <tanktread/base/exceptions.h>
#include <tanktread/simulation/placement_parameters.h>

#include <deal.II/base/parameter_handler.h>

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <sstream>

namespace tanktread
{
  namespace
  {
    /** @param rotation along the axis, as long as the angle in units of pi. */
    Eigen::Matrix3d
    rotation_matrix(const Eigen::Vector3d &rotation)
    {
      const double length = rotation.norm();
      if (length == 0.)
        return Eigen::Matrix3d::Identity();
      return Eigen::AngleAxisd(M_PI * length, rotation / length).toRotationMatrix();
    }

    Eigen::Vector3d
    rotation_vector(const Eigen::Matrix3d &turn)
    {
      const Eigen::AngleAxisd rotation(turn);
      return rotation.angle() / M_PI * rotation.axis();
    }

    std::string
    as_list(const Eigen::RowVector3d &x)
    {
      std::ostringstream text;
      text.precision(16);
      text << x[0] << ", " << x[1] << ", " << x[2];
      return text.str();
    }
  } // namespace


  void
  PlacementParameters::add_parameters(dealii::ParameterHandler &prm)
  {
    using dealii::Patterns::Double;
    using dealii::Patterns::FileName;
    using dealii::Patterns::Integer;
    using dealii::Patterns::List;
    add_enum_parameter(
      prm,
      "Placement",
      placement,
      {{"list", Placement::list}, {"file", Placement::file}, {"random", Placement::random}},
      "Where capsules of this kind start. list: Centres and Rotations. file: Places file. random: as many as Number or Volume fraction say, without overlap; the same with the "
      "same Seed of section Capsule. used_parameters.prm has the places that came of it as a list.");
    prm.add_parameter("Centres",
                      centres,
                      "Centres of the capsules, in a: x, y, z of the first; x, y, z of the second; and so on. Along periodic axes they may lie anywhere.",
                      List(List(Double(), 3, 3, ","), 0, 1000000, ";"));
    prm.add_parameter(
      "Rotations",
      rotations,
      "How each of the capsules is turned about its centre beyond Inclination: vectors along the axis, as long as the angle in units of pi. Empty: not at all.",
      List(List(Double(), 3, 3, ","), 0, 1000000, ";"));
    prm.add_parameter("Places file", file, "File with a line x y z for each capsule, or x y z and the three numbers of its rotation.", FileName());
    prm.add_parameter("Number", number, "Capsules placed at random; 0: as many as Volume fraction says.", Integer(0, most_at_random));
    prm.add_parameter("Volume fraction", volume_fraction, "Volume of the capsules placed at random over that of the box; 0: as Number says.", Double(0., 1.));
    prm.add_parameter("Seed", seed, "What the random places begin with: another number, other places.", Integer(0));
    prm.add_parameter("Random orientations", turned, "Whether capsules placed at random are turned at random too.");
    prm.add_parameter("Least gap", least_gap, "Between capsules placed at random, and to walls, in a.", Double(0., 10.));
  }


  void
  PlacementParameters::check() const
  {
    if (placement == Placement::list && centres.empty())
      throw InputError("Capsule/Centres: got none; allowed: that of one capsule of this kind at least.");
    if (placement == Placement::list && !rotations.empty() && rotations.size() != centres.size())
      throw InputError("Capsule/Rotations: got " + std::to_string(rotations.size()) + " of them; allowed: none, or one for each of the " +
                       std::to_string(centres.size()) + " Capsule/Centres.");
    if (placement == Placement::file && file.empty())
      throw InputError("Capsule/Places file: the placement 'file' needs the name of a file.");
    if (placement == Placement::random && (number > 0) == (volume_fraction > 0.))
      throw InputError("Capsule/Number: got " + std::to_string(number) + " with Capsule/Volume fraction = " + std::to_string(volume_fraction) +
                       "; allowed with the placement 'random': one of the two above 0, the other one 0.");
  }


  std::vector<Place>
  PlacementParameters::places() const
  {
    std::vector<Place> result;
    for (std::size_t c = 0; c < centres.size(); ++c)
      {
        result.emplace_back(Eigen::RowVector3d(centres[c][0], centres[c][1], centres[c][2]));
        if (!rotations.empty())
          result.back().turn = rotation_matrix({rotations[c][0], rotations[c][1], rotations[c][2]});
      }
    return result;
  }


  unsigned int
  PlacementParameters::number_in(const double volume, const double size) const
  {
    const double wanted = number > 0 ? number : std::round(volume_fraction * volume / (4. / 3. * M_PI * size * size * size));
    if (wanted > most_at_random)
      throw InputError(std::to_string(std::llround(wanted)) + " capsules at random places; allowed: " + std::to_string(most_at_random) + " at most.");
    return std::max(1u, static_cast<unsigned int>(wanted));
  }


  std::pair<std::string, std::string>
  as_lists(const std::vector<Place> &places)
  {
    const bool  turned = std::any_of(places.begin(), places.end(), [](const Place &place) { return !place.turn.isIdentity(0.); });
    std::string centres, rotations;
    for (const Place &place : places)
      {
        centres += (centres.empty() ? "" : "; ") + as_list(place.centre);
        if (turned)
          rotations += (rotations.empty() ? "" : "; ") + as_list(rotation_vector(place.turn).transpose());
      }
    return {centres, rotations};
  }


  std::vector<Place>
  read_places(const std::string &file)
  {
    std::ifstream in(file);
    if (!in)
      throw InputError("Capsule/Places file: '" + file + "' cannot be read.");
    std::vector<Place> result;
    std::string        line;
    for (unsigned int n = 1; std::getline(in, line); ++n)
      {
        line.erase(std::min(line.find('#'), line.size()));
        std::replace(line.begin(), line.end(), ',', ' ');
        std::istringstream  words(line);
        std::vector<double> numbers;
        for (double number; words >> number;)
          numbers.push_back(number);
        if (!words.eof() || (!numbers.empty() && numbers.size() != 3 && numbers.size() != 6))
          throw InputError("Capsule/Places file: line " + std::to_string(n) + " of '" + file + "' is '" + line +
                           "'; allowed: x y z, or x y z and three numbers of a rotation.");
        if (numbers.empty())
          continue;
        result.emplace_back(Eigen::RowVector3d(numbers[0], numbers[1], numbers[2]));
        if (numbers.size() == 6)
          result.back().turn = rotation_matrix({numbers[3], numbers[4], numbers[5]});
      }
    if (result.empty())
      throw InputError("Capsule/Places file: '" + file + "' has no line with a place.");
    return result;
  }
} // namespace tanktread
