// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: parameters read by one rank for all of them.

#include <deal.II/base/mpi.h>
#include <deal.II/base/parameter_handler.h>

#include <tanktread/base/mpi_errors.h>
#include <tanktread/simulation/shared_parameters.h>

#include <boost/serialization/array.hpp>
#include <boost/serialization/string.hpp>
#include <boost/serialization/vector.hpp>

#include <array>
#include <memory>

namespace tanktread
{
  namespace
  {
    /** What the text of the parameters does not say, as types that can be sent. */
    struct Sent
    {
      std::string                             file, used;
      std::vector<std::array<std::string, 3>> choices, values;
      std::vector<std::vector<double>>        vertices; // of the mesh file of each kind, empty without one
      std::vector<std::vector<int>>           faces;

      template <typename Archive>
      void
      serialize(Archive &archive, const unsigned int)
      {
        archive &file &used &choices &values &vertices &faces;
      }
    };


    std::vector<std::array<std::string, 3>>
    strings(const std::vector<Choice> &choices)
    {
      std::vector<std::array<std::string, 3>> result;
      for (const Choice &choice : choices)
        result.push_back({{choice.section, choice.name, choice.value}});
      return result;
    }


    std::vector<Choice>
    choices(const std::vector<std::array<std::string, 3>> &strings)
    {
      std::vector<Choice> result;
      for (const auto &[section, name, value] : strings)
        result.push_back({section, name, value});
      return result;
    }


    Sent
    sent(const Parameters &parameters)
    {
      Sent result{parameters.file, parameters.used, strings(parameters.choices), strings(parameters.values), {}, {}};
      for (const KindParameters &kind : parameters.kinds)
        {
          result.vertices.emplace_back();
          result.faces.emplace_back();
          if (!kind.shape.mesh)
            continue;
          for (const Eigen::Vector3d &vertex : kind.shape.mesh->vertices)
            result.vertices.back().insert(result.vertices.back().end(), vertex.data(), vertex.data() + 3);
          for (const auto &face : kind.shape.mesh->faces)
            result.faces.back().insert(result.faces.back().end(), face.begin(), face.end());
        }
      return result;
    }


    Parameters
    received(const Sent &sent)
    {
      Parameters               result(sent.vertices.size());
      dealii::ParameterHandler prm;
      result.add_parameters(prm);
      result.values = choices(sent.values);
      set_values(prm, result.values); // not from the text, in which "#" begins a comment
      result.file    = sent.file;
      result.used    = sent.used;
      result.choices = choices(sent.choices);
      for (std::size_t k = 0; k < result.kinds.size(); ++k)
        if (const std::vector<double> &x = sent.vertices[k]; !x.empty())
          {
            TriangleMesh mesh;
            for (std::size_t i = 0; i < x.size(); i += 3)
              mesh.vertices.emplace_back(x[i], x[i + 1], x[i + 2]);
            for (std::size_t i = 0; i < sent.faces[k].size(); i += 3)
              mesh.faces.push_back({{sent.faces[k][i], sent.faces[k][i + 1], sent.faces[k][i + 2]}});
            result.kinds[k].shape.mesh = std::make_shared<const TriangleMesh>(std::move(mesh));
          }
      return result;
    }
  } // namespace


  Parameters
  read_shared_parameters(const std::string &file, const std::vector<std::string> &overrides, const MPI_Comm communicator)
  {
    Parameters result;
    on_first_rank(communicator, [&] { result = read_parameters(file, overrides); });
    const bool is_first = dealii::Utilities::MPI::this_mpi_process(communicator) == 0;
    const Sent all      = dealii::Utilities::MPI::broadcast(communicator, is_first ? sent(result) : Sent());
    return is_first ? result : received(all);
  }
} // namespace tanktread
