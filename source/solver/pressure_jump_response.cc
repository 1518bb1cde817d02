// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: what unit pressure jumps at the shells do to the liquid, for the preconditioner.

#include <tanktread/coupling/pressure_without_mean.h>
#include <tanktread/fluid/linear_solver.h>
#include <tanktread/fluid/nearest_point.h>
#include <tanktread/solver/pressure_jump_response.h>

#include <cmath>

namespace tanktread
{
  namespace
  {
    constexpr unsigned int max_iterations = 20;
  } // namespace


  PressureJumpResponse::PressureJumpResponse(const FluidOperator &fluid,
                                             const StokesInverse &preconditioner,
                                             const Coupling      &coupling,
                                             const double         viscosity,
                                             KrylovBasis         &basis,
                                             const double         tolerance)
    : layout_(coupling.layout())
    , s_(coupling.shells().size(), 0.)
  {
    const TaylorHoodSpace &space = preconditioner.space();
    FluidBlockVector       load, response, product;
    ShellFields            normal_fields;
    for (FluidBlockVector *vector : {&load, &response, &product})
      space.reinit(*vector);
    for (const auto &shell : coupling.shells())
      normal_fields.push_back(shell->normal_field());
    assign_nodes(space, coupling);
    coupling.spread_plainly(normal_fields, load);
    solve_fgmres(fluid, preconditioner, response, load, tolerance, max_iterations, basis);

    // s = u . (R v + B^T p), the energy of what a pressure jump drives, is positive even for a pressure that is not accurate.
    fluid.vmult(product, response);
    const ShellFields         moments    = coupling.velocity_moments(response);
    const std::vector<double> divergence = products(response.block(pressure_block), product.block(pressure_block));
    e_                                   = response.block(pressure_block);
    e_ *= -1.;
    if (layout_.n_capsules() > 1)
      set_mean(space, layout_.capsules().volume() / space.mesh.box().volume());
    for (std::size_t c = 0; c < s_.size(); ++c)
      {
        s_[c]               = normal_fields[c].cwiseProduct(moments[c]).sum() - divergence[c];
        const double volume = coupling.shells()[c]->capsule().volume() / viscosity;
        if (!(s_[c] > 1e-4 * volume && s_[c] < volume))
          s_[c] = volume;
      }
  }


  void
  PressureJumpResponse::set_mean(const TaylorHoodSpace &space, const double mean)
  {
    FluidBlockVector              fields;
    dealii::AlignedVector<double> without_mean;
    space.reinit(fields);
    fields.block(pressure_block) = e_;
    PressureWithoutMean(space).load(fields, without_mean);
    for (std::size_t i = 0; i < e_.locally_owned_size(); ++i)
      e_.local_element(i) = without_mean[i] + mean;
  }


  void
  PressureJumpResponse::assign_nodes(const TaylorHoodSpace &space, const Coupling &coupling)
  {
    if (layout_.n_capsules() == 1)
      return;
    const NodeSpace              &p       = *space.pressure;
    const std::vector<double>     corners = lower_corners(space);
    std::vector<dealii::Point<3>> centres;
    std::vector<double>           own_means;
    for (const auto &shell : coupling.shells())
      for (unsigned int d = 0; d < 3; ++d)
        own_means.push_back(shell->x().col(d).mean());
    const std::vector<double> means = layout_.gathered(own_means, 3);
    for (std::size_t c = 0; c < means.size(); c += 3)
      centres.emplace_back(means[c], means[c + 1], means[c + 2]);
    const NearestPoint nearest(centres, space.mesh.box());
    capsule_of_node_.assign(p.n_owned(), 0);
    for (unsigned int cell = 0; cell < p.n_cells(); ++cell)
      for (unsigned int j = 0; j < 8; ++j)
        if (const unsigned int node = p.cell_nodes(cell)[j]; p.is_free(node) && node < p.n_owned())
          {
            dealii::Point<3> x(corners[3 * std::size_t(cell)], corners[3 * std::size_t(cell) + 1], corners[3 * std::size_t(cell) + 2]);
            for (unsigned int d = 0; d < 3; ++d)
              x[d] += p.cell_sizes()[cell] * ((j >> d) & 1);
            capsule_of_node_[node] = nearest(x);
          }
  }


  std::vector<double>
  PressureJumpResponse::products(const FluidVector &p, const FluidVector &q) const
  {
    std::vector<double> of_all(layout_.n_capsules(), 0.), result;
    const double *const p_i = p.begin(), *const q_i = q.begin();
    for (std::size_t i = 0; i < p.locally_owned_size(); ++i)
      of_all[capsule_of_node_.empty() ? 0 : capsule_of_node_[i]] += p_i[i] * q_i[i];
    MPI_Allreduce(MPI_IN_PLACE, of_all.data(), int(of_all.size()), MPI_DOUBLE, MPI_SUM, layout_.communicator());
    for (const unsigned int c : layout_.own())
      result.push_back(of_all[c]);
    return result;
  }


  std::vector<double>
  PressureJumpResponse::pressure_jumps(const FluidVector &r_p, std::vector<double> r_pi) const
  {
    const std::vector<double> known = products(e_, r_p);
    for (std::size_t c = 0; c < s_.size(); ++c)
      r_pi[c] = -(r_pi[c] - known[c]) / s_[c];
    return r_pi;
  }
} // namespace tanktread
