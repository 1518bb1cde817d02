// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: sections "Capsule", "Capsule 2", ...: the kinds of capsules of a scene.

#include <deal.II/base/parameter_handler.h>

#include <tanktread/base/exceptions.h>
#include <tanktread/base/parameter_file.h>
#include <tanktread/base/parameter_table.h>
#include <tanktread/simulation/kind_parameters.h>

#include <algorithm>
#include <limits>
#include <map>
#include <set>
#include <sstream>

namespace tanktread
{
  namespace
  {
    const std::string first_section = "Capsule";

    std::string
    section_of_kind(const unsigned int number)
    {
      return number == 0 ? first_section : first_section + " " + std::to_string(number + 1);
    }

    bool
    is_number(const std::string &word)
    {
      return !word.empty() && word.size() <= 6 && word.find_first_not_of("0123456789") == std::string::npos;
    }

    /** What says where capsules are: each kind has its own. */
    bool
    is_about_places(const std::string &name)
    {
      static const std::set<std::string> names = {"Centres", "Rotations", "Places file", "Number", "Volume fraction"};
      return names.count(name) > 0;
    }
  } // namespace


  KindParameters::KindParameters(const unsigned int number)
    : section(section_of_kind(number))
  {
    if (number > 0)
      placement.centres.clear();
  }


  bool
  KindParameters::is_first() const
  {
    return section == first_section;
  }


  void
  KindParameters::add_parameters(dealii::ParameterHandler &prm)
  {
    prm.enter_subsection(section);
    shape.add_parameters(prm);
    placement.add_parameters(prm);
    shell.add_parameters(prm);
    prm.leave_subsection();
    if (!is_first())
      add_further_parameters(prm);
  }


  void
  KindParameters::add_further_parameters(dealii::ParameterHandler &prm)
  {
    using dealii::Patterns::Double;
    prm.enter_subsection(section);
    prm.add_parameter("Size", shape.size, "Radius of the sphere with the volume of a capsule of this kind, in a, that of the first kind.", Double(0.01, 100.));
    prm.add_parameter("Young modulus factor",
                      young_modulus_factor,
                      "E h of this kind over that which 'Shear number G' says.",
                      Double(std::numeric_limits<double>::min()));
    prm.add_parameter("Bending modulus factor", bending_modulus_factor, "kappa_B of this kind over that which 'Reduced bending modulus' says.", Double(0.));
    prm.leave_subsection();
  }


  std::string
  in_section(const std::string &section, std::string message)
  {
    const std::string old = first_section + "/", in_its_place = section + "/";
    for (std::size_t at = message.find(old); section != first_section && at != std::string::npos; at = message.find(old, at + in_its_place.size()))
      message.replace(at, old.size(), in_its_place);
    return message;
  }


  void
  KindParameters::check() const
  {
    try
      {
        shape.check();
        placement.check();
        shell.check();
      }
    catch (const InputError &error)
      {
        throw InputError(in_section(error.what()));
      }
  }


  unsigned int
  number_of_kinds(const std::string &text, const std::string &file_name, const std::vector<std::string> &overrides)
  {
    std::map<unsigned int, std::string> places;
    std::istringstream                  lines(text);
    unsigned int                        n = 0;
    for (std::string line; std::getline(lines, line);)
      {
        ++n;
        std::istringstream words(line.substr(0, line.find('#')));
        std::string        subsection, section, number, further;
        if (words >> subsection >> section >> number && subsection == "subsection" && section == first_section && is_number(number) && !(words >> further))
          places.emplace(std::stoul(number), file_name + ":" + std::to_string(n));
      }
    for (const std::string &setting : overrides)
      {
        std::istringstream words(setting.substr(0, setting.find('/')));
        std::string        section, number, further;
        if (words >> section >> number && section == first_section && is_number(number) && !(words >> further))
          places.emplace(std::stoul(number), "--set \"" + setting + "\"");
      }
    unsigned int expected = 2;
    for (const auto &[number, place] : places)
      if (number != expected++)
        throw InputError(place + ": section \"Capsule " + std::to_string(number) +
                         "\" is about a further kind of capsule; allowed: \"Capsule\" for the first kind, \"Capsule 2\" for the second, and so on" +
                         (number > 1 ? ", without a gap: \"Capsule " + std::to_string(expected - 1) + "\" is missing" : ""));
    return expected - 1;
  }


  void
  inherit_from_first_kind(dealii::ParameterHandler &prm, const unsigned int n_kinds, ParameterSource &source)
  {
    for (const ParameterInfo &parameter : parameter_table(prm))
      {
        const std::string path = first_section + "/" + parameter.name;
        if (parameter.section != first_section || is_about_places(parameter.name) || !source.is_set(path))
          continue;
        for (unsigned int k = 1; k < n_kinds; ++k)
          {
            const std::string section = section_of_kind(k);
            if (source.is_set(section + "/" + parameter.name))
              continue;
            prm.enter_subsection(section);
            prm.set(parameter.name, parameter.value);
            prm.leave_subsection();
            source.note(section + "/" + parameter.name, source.where(path));
          }
      }
  }
} // namespace tanktread
