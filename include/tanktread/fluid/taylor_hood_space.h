// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: Q2 velocity and Q1 pressure on one octree.

#ifndef tanktread_fluid_taylor_hood_space_h
#define tanktread_fluid_taylor_hood_space_h

#include <deal.II/base/partitioner.h>
#include <deal.II/dofs/dof_handler.h>
#include <deal.II/fe/fe_q.h>
#include <deal.II/lac/affine_constraints.h>

#include <tanktread/fluid/fluid_mesh.h>
#include <tanktread/fluid/node_space.h>
#include <tanktread/fluid/types.h>

#include <memory>
#include <utility>

namespace tanktread
{
  /**
   * One continuous scalar finite-element field of degree 1 or 2 on the mesh, with its constraints closed: hanging nodes, periodicity, zero on the faces with
   * prescribed velocity.
   */
  class ScalarSpace
  {
  public:
    /** Collective. Throws InputError for too many cells, NumericalError if ranks disagree about a constraint (deal.II's defect, silently wrong otherwise). */
    ScalarSpace(const FluidMesh &mesh, unsigned int degree, bool zero_on_prescribed_faces);

    const dealii::DoFHandler<3> &
    dofs() const
    {
      return dof_handler_;
    }
    const dealii::AffineConstraints<double> &
    constraints() const
    {
      return constraints_;
    }

    /** Owned and ghost degrees of freedom; ghosts include all masters of the constraints of the locally relevant ones. */
    const std::shared_ptr<const dealii::Utilities::MPI::Partitioner> &
    partitioner() const
    {
      return partitioner_;
    }

  private:
    dealii::FE_Q<3>                                            fe_;
    dealii::DoFHandler<3>                                      dof_handler_;
    dealii::AffineConstraints<double>                          constraints_;
    std::shared_ptr<const dealii::Utilities::MPI::Partitioner> partitioner_;
  };

  /**
   * The pair of spaces. All three velocity components have the same nodes: one scalar Q2 space numbers them.
   *
   * Velocities are disturbances: they vanish on the faces with prescribed velocity, whatever the undisturbed flow is.
   */
  struct TaylorHoodSpace
  {
    /** Collective. @param velocity_nodes those of this mesh, if known already. */
    explicit TaylorHoodSpace(const FluidMesh &mesh, std::shared_ptr<const NodeSpace> velocity_nodes = nullptr);

    /** The pressures of `other` with velocities at all nodes of the mesh, those on the faces with prescribed velocity included. Collective. */
    static TaylorHoodSpace
    with_faces(const TaylorHoodSpace &other);

    /** Makes `vector` a zero vector of `n_blocks` blocks, velocity and (if there are more than one) the pressure; blocks from 2 on stay empty. */
    void
    reinit(FluidBlockVector &vector, unsigned int n_blocks = 2) const;

    const FluidMesh                       &mesh;
    const std::shared_ptr<const NodeSpace> velocity, pressure;

  private:
    TaylorHoodSpace(const FluidMesh &mesh, std::shared_ptr<const NodeSpace> velocity, std::shared_ptr<const NodeSpace> pressure)
      : mesh(mesh)
      , velocity(std::move(velocity))
      , pressure(std::move(pressure))
    {}
  };
} // namespace tanktread

#endif
