// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: the fluid's fields as VTU.

#include <deal.II/dofs/dof_tools.h>
#include <deal.II/fe/fe_system.h>
#include <deal.II/numerics/data_out.h>

#include <tanktread/fluid/field_output.h>

namespace tanktread
{
  namespace
  {
    /** Total velocity as one vector-valued field, because ParaView draws glyphs and streamlines of vectors only. */
    FluidVector
    total_velocity(const TaylorHoodSpace &space, const FluidBlockVector &fields, const double shear_rate, const dealii::DoFHandler<3> &vector_dofs)
    {
      FluidVector result(vector_dofs.locally_owned_dofs(), dealii::DoFTools::extract_locally_relevant_dofs(vector_dofs), space.mesh.communicator());
      const auto &fe = vector_dofs.get_fe();
      std::vector<dealii::types::global_dof_index> scalar(27), vector(81);
      for (unsigned int c = 0; c < 3; ++c)
        {
          FluidVector component(fields.block(c));
          space.velocity.constraints().distribute(component);
          component.update_ghost_values();
          for (const auto &cell : space.velocity.dofs().active_cell_iterators())
            if (cell->is_locally_owned())
              {
                cell->get_dof_indices(scalar);
                dealii::DoFHandler<3>::active_cell_iterator(&space.mesh.triangulation(), cell->level(), cell->index(), &vector_dofs)->get_dof_indices(vector);
                for (unsigned int a = 0; a < 27; ++a)
                  {
                    const auto   i = vector[fe.component_to_system_index(c, a)];
                    const double z = cell->vertex(0)[2] + space.mesh.cell_size(cell->level()) * space.velocity.dofs().get_fe().unit_support_point(a)[2];
                    if (result.locally_owned_elements().is_element(i))
                      result(i) = component(scalar[a]) + (c == 0 ? shear_rate * z : 0.);
                  }
              }
        }
      result.update_ghost_values();
      return result;
    }


    FluidVector
    total_pressure(const TaylorHoodSpace &space, const FluidBlockVector &fields, const std::function<double(const dealii::Point<3> &)> &further_pressure)
    {
      FluidVector continuous(fields.block(pressure_block));
      space.pressure.constraints().distribute(continuous);
      FluidVector                                  result(continuous);
      std::vector<dealii::types::global_dof_index> indices(8);
      for (const auto &cell : space.pressure.dofs().active_cell_iterators())
        if (cell->is_locally_owned())
          {
            cell->get_dof_indices(indices);
            for (unsigned int v = 0; v < 8; ++v)
              if (result.locally_owned_elements().is_element(indices[v]))
                result(indices[v]) = continuous(indices[v]) + further_pressure(cell->vertex(v));
          }
      result.update_ghost_values();
      return result;
    }
  } // namespace


  std::string
  write_fluid_fields(const std::string                                     &folder,
                     const std::string                                     &name,
                     const unsigned int                                     counter,
                     const TaylorHoodSpace                                 &space,
                     const FluidBlockVector                                &fields,
                     const double                                           shear_rate,
                     const std::function<double(const dealii::Point<3> &)> &further_pressure)
  {
    const dealii::FESystem<3> fe(space.velocity.dofs().get_fe(), 3);
    dealii::DoFHandler<3>     vector_dofs(space.mesh.triangulation());
    vector_dofs.distribute_dofs(fe);
    const FluidVector     velocity = total_velocity(space, fields, shear_rate, vector_dofs);
    const FluidVector     pressure = total_pressure(space, fields, further_pressure);
    dealii::Vector<float> rank(space.mesh.triangulation().n_active_cells());
    rank = space.mesh.triangulation().locally_owned_subdomain();

    using Interpretation = dealii::DataComponentInterpretation::DataComponentInterpretation;
    dealii::DataOut<3> output;
    output.attach_triangulation(space.mesh.triangulation());
    output.add_data_vector(vector_dofs,
                           velocity,
                           std::vector<std::string>(3, "velocity"),
                           std::vector<Interpretation>(3, dealii::DataComponentInterpretation::component_is_part_of_vector));
    output.add_data_vector(space.pressure.dofs(), pressure, "pressure");
    output.add_data_vector(rank, "rank");
    output.build_patches(2);
    return output.write_vtu_with_pvtu_record(folder + "/", name, counter, space.mesh.communicator(), 5, 1);
  }
} // namespace tanktread
