// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: Q2 velocity and Q1 pressure on one octree.

#include <deal.II/base/mpi.h>
#include <deal.II/dofs/dof_tools.h>

#include <tanktread/base/exceptions.h>
#include <tanktread/fluid/compat.h>
#include <tanktread/fluid/number_of_cells.h>
#include <tanktread/fluid/taylor_hood_space.h>

#include <algorithm>

namespace tanktread
{
  namespace
  {
    /** The relevant degrees of freedom and whatever their constraints refer to. */
    dealii::IndexSet
    with_masters(dealii::IndexSet relevant, const dealii::AffineConstraints<double> &constraints)
    {
      std::vector<dealii::types::global_dof_index> masters;
      for (const auto i : relevant)
        if (const auto *entries = constraints.get_constraint_entries(i))
          for (const auto &entry : *entries)
            masters.push_back(entry.first);
      std::sort(masters.begin(), masters.end());
      relevant.add_indices(masters.begin(), std::unique(masters.begin(), masters.end()));
      relevant.compress();
      return relevant;
    }
  } // namespace


  ScalarSpace::ScalarSpace(const FluidMesh &mesh, const unsigned int degree, const bool zero_on_prescribed_faces)
    : fe_(degree)
    , dof_handler_(mesh.triangulation())
  {
    // Added up here: deal.II's own sum has as few bits as what it is to be compared with.
    check_number_of_cells(dealii::Utilities::MPI::sum(std::uint64_t(mesh.triangulation().n_locally_owned_active_cells()), mesh.communicator()));
    dof_handler_.distribute_dofs(fe_);
    const dealii::IndexSet owned    = dof_handler_.locally_owned_dofs();
    const dealii::IndexSet relevant = dealii::DoFTools::extract_locally_relevant_dofs(dof_handler_);

    // Hanging nodes first: the other order ends in cycles (deal.II 9.4.1 then throws in debug mode and hangs in release mode).
    compat::reinit(constraints_, owned, relevant);
    dealii::DoFTools::make_hanging_node_constraints(dof_handler_, constraints_);
    for (unsigned int d = 0; d < 3; ++d)
      if (mesh.box().is_periodic(d))
        dealii::DoFTools::make_periodicity_constraints(dof_handler_, 2 * d, 2 * d + 1, d, constraints_);
    for (unsigned int d = 0; d < 3; ++d)
      if (zero_on_prescribed_faces && !mesh.box().is_periodic(d))
        for (const unsigned int face : {2 * d, 2 * d + 1})
          dealii::DoFTools::make_zero_boundary_constraints(dof_handler_, face, constraints_);
    constraints_.close();

    const MPI_Comm   communicator = mesh.communicator();
    dealii::IndexSet active       = dealii::DoFTools::extract_locally_active_dofs(dof_handler_);
    if (!constraints_.is_consistent_in_parallel(dealii::Utilities::MPI::all_gather(communicator, owned), active, communicator))
      throw NumericalError("The ranks disagree about hanging-node or periodicity constraints of the fluid mesh; run on another number of ranks.");

    partitioner_ = std::make_shared<dealii::Utilities::MPI::Partitioner>(owned, with_masters(relevant, constraints_), communicator);
  }


  TaylorHoodSpace::TaylorHoodSpace(const FluidMesh &mesh, std::shared_ptr<const NodeSpace> velocity_nodes)
    : mesh(mesh)
    , velocity(velocity_nodes ? std::move(velocity_nodes) : std::make_shared<const NodeSpace>(ScalarSpace(mesh, 2, true), 3))
    , pressure(std::make_shared<const NodeSpace>(ScalarSpace(mesh, 1, false), 1))
  {}


  TaylorHoodSpace
  TaylorHoodSpace::with_faces(const TaylorHoodSpace &other)
  {
    return {other.mesh, std::make_shared<const NodeSpace>(ScalarSpace(other.mesh, 2, false), 3), other.pressure};
  }


  void
  TaylorHoodSpace::reinit(FluidBlockVector &vector, const unsigned int n_blocks) const
  {
    vector.reinit(n_blocks);
    vector.block(velocity_block).reinit(velocity->partitioner());
    if (n_blocks > pressure_block)
      vector.block(pressure_block).reinit(pressure->partitioner());
    vector.collect_sizes();
  }
} // namespace tanktread
