// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: the discrete Stokes equations of one viscosity.

#include <deal.II/base/quadrature_lib.h>
#include <deal.II/fe/fe_values.h>
#include <deal.II/grid/grid_generator.h>
#include <deal.II/grid/tria.h>
#include <deal.II/lac/trilinos_sparsity_pattern.h>

#include <tanktread/fluid/stokes_operator.h>

namespace tanktread
{
  using Indices = std::vector<dealii::types::global_dof_index>;

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


  namespace
  {
    /** Calls f(h, velocity indices, pressure indices) for every cell this rank owns. */
    template <typename Function>
    void
    for_owned_cells(const TaylorHoodSpace &space, const Function &f)
    {
      Indices u(27), p(8);
      for (const auto &cell : space.velocity.dofs().active_cell_iterators())
        if (cell->is_locally_owned())
          {
            cell->get_dof_indices(u);
            const auto p_cell = dealii::DoFHandler<3>::active_cell_iterator(&space.mesh.triangulation(), cell->level(), cell->index(), &space.pressure.dofs());
            p_cell->get_dof_indices(p);
            f(space.mesh.cell_size(cell->level()), u, p);
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


  StokesOperator::StokesOperator(const TaylorHoodSpace &space)
    : space_(space)
    , velocity_scratch_(space.velocity.partitioner())
    , pressure_scratch_(space.pressure.partitioner())
  {
    make_sparsity();
    assemble();
  }


  void
  StokesOperator::make_sparsity()
  {
    const MPI_Comm comm    = space_.mesh.communicator();
    const auto    &u       = space_.velocity.constraints();
    const auto    &p       = space_.pressure.constraints();
    const auto    &u_owned = space_.velocity.partitioner()->locally_owned_range();
    const auto    &p_owned = space_.pressure.partitioner()->locally_owned_range();
    const auto     rows    = [](const ScalarSpace &s) {
      dealii::IndexSet result = s.partitioner()->locally_owned_range();
      result.add_indices(s.partitioner()->ghost_indices());
      return result;
    };
    dealii::TrilinosWrappers::SparsityPattern uu(u_owned, u_owned, rows(space_.velocity), comm);
    dealii::TrilinosWrappers::SparsityPattern pu(p_owned, u_owned, rows(space_.pressure), comm);
    dealii::TrilinosWrappers::SparsityPattern pp(p_owned, p_owned, rows(space_.pressure), comm);
    for_owned_cells(space_, [&](double, const Indices &u_dofs, const Indices &p_dofs) {
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
  StokesOperator::assemble()
  {
    const auto &u = space_.velocity.constraints();
    const auto &p = space_.pressure.constraints();
    for_owned_cells(space_, [&](const double h, const Indices &u_dofs, const Indices &p_dofs) {
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
  StokesOperator::vmult(FluidBlockVector &dst, const FluidBlockVector &src) const
  {
    dst.block(pressure_block) = 0.;
    for (unsigned int c = 0; c < 3; ++c)
      {
        laplace_.vmult(dst.block(c), src.block(c));
        divergence_[c].Tvmult(velocity_scratch_, src.block(pressure_block));
        dst.block(c) -= velocity_scratch_;
        divergence_[c].vmult(pressure_scratch_, src.block(c));
        dst.block(pressure_block) -= pressure_scratch_;
      }
  }


  void
  StokesOperator::add_pressure_gradient(FluidBlockVector &dst, const FluidVector &pressure) const
  {
    for (unsigned int c = 0; c < 3; ++c)
      {
        divergence_[c].Tvmult(velocity_scratch_, pressure);
        dst.block(c) += velocity_scratch_;
      }
  }


  void
  StokesOperator::subtract_applied(const FluidBlockVector &field, FluidBlockVector &rhs) const
  {
    dealii::Vector<double> u_local(27), u_load(27), p_load(8), p_local(8), product(8);
    for_owned_cells(space_, [&](const double h, const Indices &u_dofs, const Indices &p_dofs) {
      p_load = 0.;
      for (unsigned int j = 0; j < 8; ++j)
        p_local[j] = field.block(pressure_block)(p_dofs[j]);
      for (unsigned int c = 0; c < 3; ++c)
        {
          for (unsigned int a = 0; a < 27; ++a)
            u_local[a] = field.block(c)(u_dofs[a]);
          reference_.laplace.vmult(u_load, u_local);
          u_load *= -h;
          reference_.divergence[c].vmult(product, u_local);
          p_load.add(h * h, product);
          dealii::Vector<double> gradient(27);
          reference_.divergence[c].Tvmult(gradient, p_local);
          u_load.add(h * h, gradient);
          space_.velocity.constraints().distribute_local_to_global(u_load, u_dofs, rhs.block(c));
        }
      space_.pressure.constraints().distribute_local_to_global(p_load, p_dofs, rhs.block(pressure_block));
    });
    for (unsigned int b = 0; b <= pressure_block; ++b)
      rhs.block(b).compress(dealii::VectorOperation::add);
  }
} // namespace tanktread
