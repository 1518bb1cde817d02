// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: from the parameters of a run to its scene.

#include <tanktread/base/exceptions.h>
#include <tanktread/shell/gaps.h>
#include <tanktread/simulation/scene_description.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <memory>
#include <sstream>
#include <utility>

namespace tanktread
{
  namespace
  {
    /** The description with a control mesh of at most `max_level`. */
    SceneDescription
    description(const Parameters &parameters, const unsigned int max_level)
    {
      SceneDescription result;
      result.box                     = parameters.scene.box();
      result.liquids.flow            = parameters.scene.undisturbed_flow();
      result.liquids.viscosity_ratio = parameters.scene.viscosity_ratio;
      result.liquids.reynolds_number = parameters.scene.reynolds_number;
      result.liquids.unbounded       = parameters.scene.boundary == Boundary::unbounded;
      result.fluid_mesh              = parameters.fluid_mesh;
      result.solver                  = parameters.solver;
      result.kinds.clear();
      result.places.clear();
      for (const KindParameters &of_kind : parameters.kinds)
        {
          CapsuleKind kind;
          try
            {
              kind.shape       = make_capsule(of_kind.shape, std::min(parameters.shell_mesh.level, max_level));
              kind.stress_free = make_stress_free_shape(of_kind.shape, kind.shape);
            }
          catch (const InputError &error)
            {
              throw InputError((of_kind.shape.shape == Shape::file ? of_kind.section + "/Mesh file: " : "") + of_kind.in_section(error.what()));
            }
          kind.shell            = of_kind.shell;
          kind.moduli           = parameters.moduli(of_kind);
          kind.shell_quadrature = parameters.shell_mesh.quadrature;
          for (Place &place : of_kind.placement.places())
            {
              result.places.push_back(std::move(place));
              result.kind_of.push_back(result.kinds.size());
            }
          result.kinds.push_back(std::move(kind));
        }
      return result;
    }


    void
    check_extent(const SceneDescription &scene, const std::vector<KindParameters> &kinds, const double h)
    {
      static const char *const    axes   = "xyz";
      Eigen::RowVector3d          extent = Eigen::RowVector3d::Zero();
      std::array<unsigned int, 3> widest{{0, 0, 0}}; // kinds
      for (unsigned int c = 0; c < scene.places.size(); ++c)
        {
          const ControlPoints      x   = placed(scene.kind(c).shape.control_points, scene.places[c]);
          const Eigen::RowVector3d own = x.colwise().maxCoeff() - x.colwise().minCoeff();
          for (unsigned int d = 0; d < 3; ++d)
            if (own[d] > extent[d])
              {
                extent[d] = own[d];
                widest[d] = scene.kind_of[c];
              }
        }
      for (unsigned int d = 0; d < 3; ++d)
        {
          // The enriched interface cannot tell a shell from its image where cells of the fluid are near to both.
          const double needed = extent[d] + (scene.box.is_periodic(d) && scene.solver.interface == Interface::enriched ? 4. * h : 0.);
          if (needed < scene.box.side[d])
            continue;
          std::ostringstream    message;
          const KindParameters &kind = kinds[widest[d]];
          if (kind.shape.shape == Shape::file)
            message << kind.section << "/Mesh file: the capsule extends over " << extent[d] << " a along " << axes[d] << ". ";
          message << "Scene/Box side is " << scene.box.side[d] << " along " << axes[d] << "; allowed: more than " << needed << ", the capsule's extent"
                  << (needed > extent[d] ? " and four finest cells to its periodic image" : "") << '.';
          throw InputError(message.str());
        }
    }


    /** @param sections of the kinds. */
    void
    check_places(const SceneDescription &scene, const std::vector<std::string> &sections, const double h)
    {
      const CapsuleQuadrature                     rule{triangle_quadrature(3), triangle_quadrature(12), Derivatives::second};
      std::vector<std::unique_ptr<const Capsule>> kinds;
      ShellConfigurations                         shells;
      std::array<double, 3>                       periods, half_sides;
      for (const CapsuleKind &kind : scene.kinds)
        try
          {
            kinds.push_back(std::make_unique<Capsule>(kind.shape, rule, kind.shell, kind.moduli, kind.stress_free));
          }
        catch (const InputError &error)
          {
            throw InputError(in_section(sections[kinds.size()], error.what()));
          }
      for (unsigned int c = 0; c < scene.places.size(); ++c)
        {
          const Capsule &capsule = *kinds[scene.kind_of[c]];
          shells.push_back(std::make_shared<ShellConfiguration>(capsule, placed(capsule.initial(), scene.places[c])));
        }
      for (unsigned int d = 0; d < 3; ++d)
        {
          periods[d]    = scene.box.is_periodic(d) ? scene.box.side[d] : std::numeric_limits<double>::infinity();
          half_sides[d] = scene.box.is_periodic(d) ? std::numeric_limits<double>::infinity() : 0.5 * scene.box.side[d];
        }
      std::ostringstream message;
      for (unsigned int c = 0; c < shells.size(); ++c)
        {
          const double distance = smallest_distance_from_faces({shells[c]}, half_sides);
          if (distance <= 0.)
            message << sections[scene.kind_of[c]] << "/Centres: a capsule reaches " << -distance
                    << " a beyond a face of the box with prescribed velocity; allowed: inside.";
          else if (scene.liquids.unbounded && distance < UnboundedLiquid::least_distance)
            message << sections[scene.kind_of[c]] << "/Centres: a capsule is " << distance
                    << " a from a face of the box; allowed with Scene/Boundary = unbounded: " << UnboundedLiquid::least_distance
                    << " a or more (Scene/Box side).";
          if (!message.str().empty())
            throw InputError(message.str());
        }
      if (const ShellGap smallest = smallest_gap(shells, periods, 4. * h); smallest.gap <= 0.)
        {
          message << sections[scene.kind_of[std::max(smallest.first, smallest.second)]] << "/Centres: capsules " << smallest.first + 1 << " and "
                  << smallest.second + 1 << " overlap by " << std::abs(smallest.gap) << " a; allowed: capsules that do not touch, periodic images included.";
          throw InputError(message.str());
        }
    }
  } // namespace


  SceneDescription
  scene_description(const Parameters &parameters)
  {
    return description(parameters, std::numeric_limits<unsigned int>::max());
  }


  void
  check_scene(const Parameters &parameters)
  {
    // A coarse control mesh has the shape to a hundredth of a per cent.
    const SceneDescription scene = description(parameters, 3);
    check_extent(scene, parameters.kinds, parameters.fluid_mesh.finest_cell);
    std::vector<std::string> sections;
    for (const KindParameters &kind : parameters.kinds)
      sections.push_back(kind.section);
    check_places(scene, sections, parameters.fluid_mesh.finest_cell);
  }
} // namespace tanktread
