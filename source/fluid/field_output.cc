// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: the fluid's fields as VTU.

#include <deal.II/base/mpi.h>
#include <deal.II/base/utilities.h>

#include <deal.II/dofs/dof_tools.h>
#include <deal.II/fe/fe_q.h>
#include <deal.II/fe/fe_system.h>
#include <deal.II/fe/fe_tools.h>
#include <deal.II/numerics/data_out.h>

#include <tanktread/base/mpi_errors.h>
#include <tanktread/base/output_file.h>
#include <tanktread/fluid/field_output.h>

#include <sstream>

namespace tanktread
{
  namespace
  {
    /** Zero field on `dofs`, ghosts included. */
    FluidVector
    field(const dealii::DoFHandler<3> &dofs, const MPI_Comm communicator)
    {
      return {dofs.locally_owned_dofs(), dealii::DoFTools::extract_locally_relevant_dofs(dofs), communicator};
    }


    dealii::AlignedVector<double>
    full_array(const NodeSpace &space, const FluidVector &vector)
    {
      dealii::AlignedVector<double> result(space.full_size());
      space.load(vector, result.data());
      space.update(result.data());
      return result;
    }


    /** Total velocity as one vector-valued field, because ParaView draws glyphs and streamlines of vectors only. */
    FluidVector
    total_velocity(const TaylorHoodSpace &space, const FluidBlockVector &fields, const UndisturbedFlow &undisturbed, const dealii::DoFHandler<3> &dofs)
    {
      const NodeSpace                             &nodes  = *space.velocity;
      const dealii::AlignedVector<double>          values = full_array(nodes, fields.block(velocity_block));
      const auto                                   order  = dealii::FETools::lexicographic_to_hierarchic_numbering<3>(2);
      const auto                                  &fe     = dofs.get_fe();
      FluidVector                                  result = field(dofs, space.mesh.communicator());
      std::vector<dealii::types::global_dof_index> indices(81);
      unsigned int                                 number = 0;
      for (const auto &cell : dofs.active_cell_iterators())
        if (cell->is_locally_owned())
          {
            const unsigned int *const cell_nodes = nodes.cell_nodes(number);
            const double              h          = nodes.cell_sizes()[number++];
            cell->get_dof_indices(indices);
            for (unsigned int a = 0; a < 27; ++a)
              {
                const dealii::Tensor<1, 3> u_inf = undisturbed.velocity(cell->vertex(0) + 0.5 * h * dealii::Point<3>(a % 3, a / 3 % 3, a / 9));
                for (unsigned int c = 0; c < 3; ++c)
                  {
                    const auto i = indices[fe.component_to_system_index(c, order[a])];
                    if (result.locally_owned_elements().is_element(i))
                      result(i) = values[nodes.stride() * cell_nodes[a] + c] + u_inf[c];
                  }
              }
          }
      result.update_ghost_values();
      return result;
    }


    FluidVector
    total_pressure(const TaylorHoodSpace                                 &space,
                   const FluidBlockVector                                &fields,
                   const std::function<double(const dealii::Point<3> &)> &further_pressure,
                   const dealii::DoFHandler<3>                           &dofs)
    {
      const NodeSpace                             &nodes  = *space.pressure;
      const dealii::AlignedVector<double>          values = full_array(nodes, fields.block(pressure_block));
      FluidVector                                  result = field(dofs, space.mesh.communicator());
      std::vector<dealii::types::global_dof_index> indices(8);
      unsigned int                                 number = 0;
      for (const auto &cell : dofs.active_cell_iterators())
        if (cell->is_locally_owned())
          {
            const unsigned int *const cell_nodes = nodes.cell_nodes(number++);
            cell->get_dof_indices(indices); // of linear functions: one a vertex, in the same order as ours
            for (unsigned int v = 0; v < 8; ++v)
              if (result.locally_owned_elements().is_element(indices[v]))
                result(indices[v]) = values[cell_nodes[v]] + further_pressure(cell->vertex(v));
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
                     const UndisturbedFlow                                 &undisturbed,
                     const std::function<double(const dealii::Point<3> &)> &further_pressure)
  {
    const dealii::FESystem<3> velocity_fe(dealii::FE_Q<3>(2), 3);
    const dealii::FE_Q<3>     pressure_fe(1);
    dealii::DoFHandler<3>     velocity_dofs(space.mesh.triangulation()), pressure_dofs(space.mesh.triangulation());
    velocity_dofs.distribute_dofs(velocity_fe);
    pressure_dofs.distribute_dofs(pressure_fe);
    const FluidVector     velocity = total_velocity(space, fields, undisturbed, velocity_dofs);
    const FluidVector     pressure = total_pressure(space, fields, further_pressure, pressure_dofs);
    dealii::Vector<float> rank(space.mesh.triangulation().n_active_cells());
    rank = space.mesh.triangulation().locally_owned_subdomain();

    using Interpretation = dealii::DataComponentInterpretation::DataComponentInterpretation;
    dealii::DataOut<3> output;
    output.attach_triangulation(space.mesh.triangulation());
    output.add_data_vector(velocity_dofs,
                           velocity,
                           std::vector<std::string>(3, "velocity"),
                           std::vector<Interpretation>(3, dealii::DataComponentInterpretation::component_is_part_of_vector));
    output.add_data_vector(pressure_dofs, pressure, "pressure");
    output.add_data_vector(rank, "rank");
    output.build_patches(2);
    dealii::DataOutBase::VtkFlags flags;
    flags.compression_level = decltype(flags.compression_level)::best_speed; // the default spends more time than the flow takes to compute
    output.set_flags(flags);
    // Not by deal.II's write_vtu_in_parallel(): MPI's files do not tell when the disk is full.
    const MPI_Comm     communicator = space.mesh.communicator();
    const std::string  stem         = name + "_" + dealii::Utilities::int_to_string(counter, 5);
    const auto         piece        = [&](const unsigned int r) { return stem + "." + std::to_string(r) + ".vtu"; };
    std::ostringstream text;
    output.write_vtu(text);
    on_all_ranks(communicator, [&] { replace_file(folder + "/" + piece(dealii::Utilities::MPI::this_mpi_process(communicator)), text.str()); });
    on_first_rank(communicator, [&] {
      std::vector<std::string> pieces;
      for (unsigned int r = 0; r < dealii::Utilities::MPI::n_mpi_processes(communicator); ++r)
        pieces.push_back(piece(r));
      std::ostringstream record;
      output.write_pvtu_record(record, pieces);
      replace_file(folder + "/" + stem + ".pvtu", record.str());
    });
    return stem + ".pvtu";
  }
} // namespace tanktread
