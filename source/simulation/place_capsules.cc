// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: places of capsules from files or at random, as the lists that the rest of the program knows.

#include <deal.II/base/parameter_handler.h>

#include <tanktread/base/exceptions.h>
#include <tanktread/base/parameter_file.h>
#include <tanktread/simulation/parameters.h>
#include <tanktread/simulation/place_capsules.h>
#include <tanktread/simulation/random_places.h>
#include <tanktread/solver/unbounded_liquid.h>

#include <algorithm>
#include <string>
#include <vector>

namespace tanktread
{
  namespace
  {
    void
    set_places(dealii::ParameterHandler &prm, const std::string &section, const std::vector<Place> &places)
    {
      const auto [centres, rotations] = as_lists(places);
      set_values(prm, {{section, "Placement", "list"}, {section, "Centres", centres}, {section, "Rotations", rotations}});
    }

    /** Makes lists of places of files. */
    void
    read_places_files(dealii::ParameterHandler &prm, const Parameters &parameters, const ParameterSource &source)
    {
      for (const KindParameters &kind : parameters.kinds)
        if (kind.placement.placement == Placement::file)
          try
            {
              set_places(prm, kind.section, read_places(kind.placement.file));
            }
          catch (const InputError &error)
            {
              throw InputError(source.locate(kind.in_section(error.what())));
            }
    }

    /** "Capsule/Number" or "Capsule/Volume fraction": what says how many there are at random. */
    std::string
    number_parameter(const KindParameters &kind)
    {
      return kind.section + (kind.placement.number > 0 ? "/Number" : "/Volume fraction");
    }

    /** What `work` throws is about that parameter. */
    template <typename Function>
    void
    on_behalf_of(const std::string &parameter, const ParameterSource &source, const Function &work)
    {
      try
        {
          work();
        }
      catch (const InputError &error)
        {
          throw InputError(source.locate(parameter + ": " + error.what()));
        }
    }

    /** @param first of the first kind. */
    KindInPlace
    kind_in_place(const KindParameters &kind, const PlacementParameters &first, const Box &box, const ParameterSource &source)
    {
      const PlacementParameters &placement = kind.placement;
      KindInPlace                result{FittedShape(), 0, placement.turned};
      // Random places do not depend on the control mesh: the shape's points on a coarse one are enough.
      on_behalf_of(kind.section + (kind.shape.shape == Shape::file ? "/Mesh file" : "/Shape"), source, [&] { result.shape = make_capsule(kind.shape, 2); });
      if (!kind.has_random_places)
        {
          result.fixed = placement.places();
          return result;
        }
      on_behalf_of(number_parameter(kind), source, [&] { result.number = placement.number_in(box.volume(), kind.shape.size); });
      if (placement.seed != first.seed || placement.least_gap != first.least_gap)
        throw InputError(source.locate(kind.section + (placement.seed != first.seed ? "/Seed" : "/Least gap") +
                                       " is not that of section Capsule; allowed: that one, since all capsules are placed together."));
      return result;
    }

    /** Makes lists of random places, of all kinds that have such together. */
    void
    choose_random_places(dealii::ParameterHandler &prm, Parameters &parameters, const ParameterSource &source)
    {
      const auto is_at_random = [](const KindParameters &kind) { return kind.placement.placement == Placement::random; };
      if (std::none_of(parameters.kinds.begin(), parameters.kinds.end(), is_at_random))
        return;
      const Box                 box      = parameters.scene.box();
      const double              face_gap = parameters.scene.boundary == Boundary::unbounded ? UnboundedLiquid::least_distance : 0.;
      const PlacementParameters first    = parameters.kinds[0].placement;
      std::vector<KindInPlace>  kinds;
      std::string               wanted_by; // the parameter that asks for random places first
      for (KindParameters &kind : parameters.kinds)
        {
          kind.has_random_places = is_at_random(kind);
          if (kind.has_random_places && wanted_by.empty())
            wanted_by = number_parameter(kind);
          kinds.push_back(kind_in_place(kind, first, box, source));
        }
      on_behalf_of(wanted_by, source, [&] {
        const auto places = random_places({first.seed, first.least_gap, std::max(first.least_gap, face_gap)}, kinds, box);
        for (std::size_t k = 0; k < kinds.size(); ++k)
          if (parameters.kinds[k].has_random_places)
            set_places(prm, parameters.kinds[k].section, places[k]);
      });
    }
  } // namespace


  void
  place_capsules(dealii::ParameterHandler &prm, Parameters &parameters, const ParameterSource &source)
  {
    read_places_files(prm, parameters, source);
    choose_random_places(prm, parameters, source);
  }
} // namespace tanktread
