// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: the Stokes equations assembled by deal.II.

#include <deal.II/base/quadrature_lib.h>
#include <deal.II/fe/fe_tools.h>
#include <deal.II/fe/fe_values.h>
#include <deal.II/grid/grid_generator.h>
#include <deal.II/grid/tria.h>
#include <deal.II/lac/trilinos_sparsity_pattern.h>

#include <tanktread/fluid/assembled_stokes.h>

#include <limits>
#include <stdexcept>

namespace tanktread
{
  using Index   = dealii::types::global_dof_index;
  using Indices = std::vector<Index>;

  constexpr unsigned int pressure_component = 3; // of ComponentVector

  ReferenceMatrices::ReferenceMatrices()
    : laplace(27, 27)
    , pressure_mass(8, 8)
  {
    const dealii::FE_Q<3>    q2(2), q1(1);
    dealii::Triangulation<3> cube;
    dealii::GridGenerator::hyper_cube(cube);
    const dealii::QGauss<3> quadrature(3);
    dealii::FEValues<3>     u(q2, quadrature, dealii::update_gradients | dealii::update_JxW_values);
    dealii::FEValues<3>     p(q1, quadrature, dealii::update_values);
    u.reinit(cube.begin_active());
    p.reinit(cube.begin_active());

    for (auto &matrix : divergence)
      matrix.reinit(8, 27);
    for (const auto q : u.quadrature_point_indices())
      {
        for (const auto a : u.dof_indices())
          for (const auto b : u.dof_indices())
            laplace(a, b) += u.shape_grad(a, q) * u.shape_grad(b, q) * u.JxW(q);
        for (const auto j : p.dof_indices())
          {
            for (unsigned int c = 0; c < 3; ++c)
              for (const auto a : u.dof_indices())
                divergence[c](j, a) += p.shape_value(j, q) * u.shape_grad(a, q)[c] * u.JxW(q);
            for (const auto i : p.dof_indices())
              pressure_mass(i, j) += p.shape_value(i, q) * p.shape_value(j, q) * u.JxW(q);
          }
      }
  }


  std::vector<unsigned int>
  dofs_of_nodes(const ScalarSpace &space, const NodeSpace &nodes)
  {
    constexpr unsigned int    unknown = std::numeric_limits<unsigned int>::max();
    const auto               &fe      = space.dofs().get_fe();
    const auto                order   = dealii::FETools::lexicographic_to_hierarchic_numbering<3>(fe.degree);
    const auto               &owned   = space.partitioner()->locally_owned_range();
    std::vector<Index>        cell_dofs(fe.n_dofs_per_cell());
    std::vector<unsigned int> result(nodes.n_owned(), unknown);
    unsigned int              cell_number = 0;
    for (const auto &cell : space.dofs().active_cell_iterators())
      if (cell->is_locally_owned())
        {
          cell->get_dof_indices(cell_dofs);
          const unsigned int *const cell_nodes = nodes.cell_nodes(cell_number++);
          for (unsigned int a = 0; a < cell_dofs.size(); ++a)
            {
              const Index dof = cell_dofs[order[a]];
              if (space.constraints().is_constrained(dof) || !owned.is_element(dof))
                continue;
              const unsigned int place = owned.index_within_set(dof);
              if (cell_nodes[a] >= nodes.n_owned() || (result[cell_nodes[a]] != unknown && result[cell_nodes[a]] != place))
                throw std::logic_error("A free degree of freedom and its node do not belong together.");
              result[cell_nodes[a]] = place;
            }
        }
    std::vector<char> used(owned.n_elements(), false);
    for (const unsigned int place : result)
      {
        if (place == unknown || used[place])
          throw std::logic_error("An owned node has no degree of freedom of its own.");
        used[place] = true;
      }
    return result;
  }


  namespace
  {
    /** Calls f(h, velocity indices, pressure indices) for every cell this rank owns. */
    template <typename Function>
    void
    for_owned_cells(const AssembledStokes &stokes, const Function &f)
    {
      Indices u(27), p(8);
      for (const auto &cell : stokes.velocity().dofs().active_cell_iterators())
        if (cell->is_locally_owned())
          {
            cell->get_dof_indices(u);
            const auto p_cell =
              dealii::DoFHandler<3>::active_cell_iterator(&stokes.mesh().triangulation(), cell->level(), cell->index(), &stokes.pressure().dofs());
            p_cell->get_dof_indices(p);
            f(stokes.mesh().cell_size(cell->level()), u, p);
          }
    }


    dealii::FullMatrix<double>
    scaled(const dealii::FullMatrix<double> &matrix, const double factor)
    {
      dealii::FullMatrix<double> result(matrix);
      result *= factor;
      return result;
    }
  } // namespace


  AssembledStokes::AssembledStokes(const TaylorHoodSpace &space)
    : mesh_(space.mesh)
    , velocity_(mesh_, 2, true)
    , pressure_(mesh_, 1, false)
    , velocity_dofs_(dofs_of_nodes(velocity_, *space.velocity))
    , pressure_dofs_(dofs_of_nodes(pressure_, *space.pressure))
    , velocity_scratch_(velocity_.partitioner())
    , pressure_scratch_(pressure_.partitioner())
  {
    make_sparsity();
    assemble();
  }


  void
  AssembledStokes::make_sparsity()
  {
    const MPI_Comm comm    = mesh_.communicator();
    const auto    &u       = velocity_.constraints();
    const auto    &p       = pressure_.constraints();
    const auto    &u_owned = velocity_.partitioner()->locally_owned_range();
    const auto    &p_owned = pressure_.partitioner()->locally_owned_range();
    const auto     rows    = [](const ScalarSpace &s) {
      dealii::IndexSet result = s.partitioner()->locally_owned_range();
      result.add_indices(s.partitioner()->ghost_indices());
      return result;
    };
    dealii::TrilinosWrappers::SparsityPattern uu(u_owned, u_owned, rows(velocity_), comm);
    dealii::TrilinosWrappers::SparsityPattern pu(p_owned, u_owned, rows(pressure_), comm);
    dealii::TrilinosWrappers::SparsityPattern pp(p_owned, p_owned, rows(pressure_), comm);
    for_owned_cells(*this, [&](double, const Indices &u_dofs, const Indices &p_dofs) {
      u.add_entries_local_to_global(u_dofs, uu, false);
      p.add_entries_local_to_global(p_dofs, u, u_dofs, pu, false);
      p.add_entries_local_to_global(p_dofs, pp, false);
    });
    uu.compress();
    pu.compress();
    pp.compress();
    laplace_.reinit(uu);
    pressure_mass_.reinit(pp);
    for (auto &matrix : divergence_)
      matrix.reinit(pu);
  }


  void
  AssembledStokes::assemble()
  {
    const auto &u = velocity_.constraints();
    const auto &p = pressure_.constraints();
    for_owned_cells(*this, [&](const double h, const Indices &u_dofs, const Indices &p_dofs) {
      u.distribute_local_to_global(scaled(reference_.laplace, h), u_dofs, laplace_);
      p.distribute_local_to_global(scaled(reference_.pressure_mass, h * h * h), p_dofs, pressure_mass_);
      for (unsigned int c = 0; c < 3; ++c)
        p.distribute_local_to_global(scaled(reference_.divergence[c], h * h), p_dofs, u, u_dofs, divergence_[c]);
    });
    laplace_.compress(dealii::VectorOperation::add);
    pressure_mass_.compress(dealii::VectorOperation::add);
    for (auto &matrix : divergence_)
      matrix.compress(dealii::VectorOperation::add);
  }


  void
  AssembledStokes::vmult(ComponentVector &dst, const ComponentVector &src) const
  {
    dst.block(pressure_component) = 0.;
    for (unsigned int c = 0; c < 3; ++c)
      {
        laplace_.vmult(dst.block(c), src.block(c));
        divergence_[c].Tvmult(velocity_scratch_, src.block(pressure_component));
        dst.block(c) -= velocity_scratch_;
        divergence_[c].vmult(pressure_scratch_, src.block(c));
        dst.block(pressure_component) -= pressure_scratch_;
      }
  }


  void
  AssembledStokes::add_pressure_gradient(ComponentVector &dst, const FluidVector &pressure) const
  {
    for (unsigned int c = 0; c < 3; ++c)
      {
        divergence_[c].Tvmult(velocity_scratch_, pressure);
        dst.block(c) += velocity_scratch_;
      }
  }


  void
  AssembledStokes::reinit(ComponentVector &vector) const
  {
    vector.reinit(4);
    for (unsigned int b = 0; b < 4; ++b)
      vector.block(b).reinit((b < pressure_component ? velocity_ : pressure_).partitioner());
    vector.collect_sizes();
  }


  void
  AssembledStokes::to_components(const FluidBlockVector &from, ComponentVector &to) const
  {
    to = 0.;
    for (unsigned int i = 0; i < velocity_dofs_.size(); ++i)
      for (unsigned int c = 0; c < 3; ++c)
        to.block(c).local_element(velocity_dofs_[i]) = from.block(velocity_block).local_element(3 * i + c);
    for (unsigned int i = 0; i < pressure_dofs_.size(); ++i)
      to.block(pressure_component).local_element(pressure_dofs_[i]) = from.block(pressure_block).local_element(i);
  }


  void
  AssembledStokes::to_nodes(const ComponentVector &from, FluidBlockVector &to) const
  {
    for (unsigned int i = 0; i < velocity_dofs_.size(); ++i)
      for (unsigned int c = 0; c < 3; ++c)
        to.block(velocity_block).local_element(3 * i + c) = from.block(c).local_element(velocity_dofs_[i]);
    for (unsigned int i = 0; i < pressure_dofs_.size(); ++i)
      to.block(pressure_block).local_element(i) = from.block(pressure_component).local_element(pressure_dofs_[i]);
  }
} // namespace tanktread
