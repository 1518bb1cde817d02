// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: the liquid beyond the box.

#include <deal.II/base/mpi.h>

#include <tanktread/solver/unbounded_liquid.h>
#include <tanktread/surface/rigid_motion.h>

#include <algorithm>
#include <stdexcept>

namespace tanktread
{
  namespace
  {
    Columns
    columns(const ControlPoints &field)
    {
      Columns result;
      for (unsigned int c = 0; c < 3; ++c)
        {
          result[c].resize(field.rows());
          Eigen::VectorXd::Map(result[c].data(), field.rows()) = field.col(c);
        }
      return result;
    }


    Eigen::Matrix3d
    symmetric_without_trace(const Eigen::Matrix3d &tensor)
    {
      return 0.5 * (tensor + tensor.transpose()) - tensor.trace() / 3. * Eigen::Matrix3d::Identity();
    }
  } // namespace


  UnboundedLiquid::UnboundedLiquid(const TaylorHoodSpace &space, const ShellLayout &layout, const double viscosity_ratio)
    : space_(space)
    , layout_(layout)
    , viscosity_ratio_(viscosity_ratio)
    , faces_(space)
    , uniform_(space)
  {
    space.reinit(loads_);
  }


  void
  UnboundedLiquid::set_viscosity(const Viscosity &viscosity)
  {
    faces_.set_viscosity(viscosity);
    const NodeSpace              &nodes   = *space_.velocity;
    const std::vector<double>     corners = lower_corners(space_);
    dealii::AlignedVector<double> marks(nodes.full_size());
    const auto                    mark = [&](const unsigned int cell) {
      for (unsigned int a = 0; a < 27; ++a)
        {
          const unsigned int node = nodes.cell_nodes(cell)[a];
          if (nodes.is_free(node))
            marks[4 * std::size_t(node)] = 1.;
          else
            for (const NodeSpace::Master &master : nodes.masters(node))
              marks[4 * std::size_t(master.node)] = 1.;
        }
    };
    for (unsigned int cell = 0; cell < nodes.n_cells(); ++cell)
      if (const double *const mu = &viscosity.at_points()[27 * std::size_t(cell)]; std::any_of(mu, mu + 27, [](const double value) { return value != 1.; }))
        mark(cell);
    for (const unsigned int cell : viscosity.cut().cells)
      mark(cell);
    nodes.collect(marks.data());
    near_.clear();
    near_places_ = {};
    for (unsigned int cell = 0; cell < nodes.n_cells(); ++cell)
      for (unsigned int a = 0; a < 27; ++a)
        if (const unsigned int node = nodes.cell_nodes(cell)[a]; node < nodes.n_owned() && marks[4 * std::size_t(node)] > 0.)
          {
            marks[4 * std::size_t(node)] = 0.; // once each
            near_.push_back(node);
            const unsigned int place[3] = {a % 3, a / 3 % 3, a / 9};
            for (unsigned int c = 0; c < 3; ++c)
              near_places_[c].push_back(corners[3 * std::size_t(cell) + c] + 0.5 * nodes.cell_sizes()[cell] * place[c]);
          }
  }


  Eigen::Matrix3d
  UnboundedLiquid::discrete_stresslet(const FluidBlockVector &fields, const Eigen::RowVector3d &centre)
  {
    uniform_.vmult(loads_, fields);
    Eigen::Matrix3d moment = Eigen::Matrix3d::Zero();
    for (std::size_t i = 0; i < near_.size(); ++i)
      for (unsigned int c = 0; c < 3; ++c)
        for (unsigned int d = 0; d < 3; ++d)
          moment(c, d) += (near_places_[c][i] - centre[c]) * loads_.block(velocity_block).local_element(3 * near_[i] + d);
    dealii::Utilities::MPI::sum(dealii::ArrayView<const double>(moment.data(), 9), space_.mesh.communicator(), dealii::ArrayView<double>(moment.data(), 9));
    return symmetric_without_trace(-moment);
  }


  void
  UnboundedLiquid::add_other_viscosity(const State &state, const ShellConfiguration &shell, const ControlPoints &velocity, Columns &on_faces)
  {
    const CapsuleState      &capsule = state.capsules[0];
    const ControlPoints     &v       = shell.volume_gradient();
    const ControlPoints      U       = without_rigid_motion(capsule.x, velocity);
    const Eigen::RowVector3d centre  = capsule.x.colwise().mean();
    const Columns           &places  = faces_.places();
    add_double_layer(columns(capsule.x), columns(U), columns(v), 1. - viscosity_ratio_, places, on_faces);

    const Eigen::Matrix3d of_points =
      symmetric_without_trace(-(capsule.x.rowwise() - centre).transpose() * capsule.force - 2. * (1. - viscosity_ratio_) * U.transpose() * v);
    const Eigen::Matrix3d missing = discrete_stresslet(state.fluid, centre) - of_points;
    // As a double layer of its columns on the faces of a point: -3/(8 pi) y (y . S y)/|y|^5.
    const ControlPoints columns_of_S = missing, unit_vectors = Eigen::Matrix3d::Identity();
    add_double_layer(columns(centre.replicate(3, 1)), columns(columns_of_S), columns(unit_vectors), -0.5, places, on_faces);
  }


  void
  UnboundedLiquid::add_all_stokeslets(const State &state, const ShellConfigurations &shells, Columns &on_faces) const
  {
    for (unsigned int team = 0; team < layout_.n_teams(); ++team)
      {
        std::vector<double> sources; // x and force of each control point, the three components of a shell one after the other
        if (layout_.team_of_rank(layout_.rank()) == team)
          for (std::size_t i = 0; i < shells.size(); ++i)
            for (const ControlPoints &field :
                 {state.capsules[i].x, ControlPoints(state.capsules[i].force + state.capsules[i].pressure_jump * shells[i]->volume_gradient())})
              for (const std::vector<double> &column : columns(field))
                sources.insert(sources.end(), column.begin(), column.end());
        std::vector<unsigned int> of_team;
        std::size_t               n = 0;
        for (unsigned int c = 0; c < layout_.n_capsules(); ++c)
          if (layout_.team_of(c) == team)
            {
              of_team.push_back(c);
              n += 6 * std::size_t(layout_.capsules()[c].n_control_points());
            }
        sources.resize(n);
        if (layout_.n_teams() > 1)
          MPI_Bcast(sources.data(), int(n), MPI_DOUBLE, int(layout_.leader(team)), layout_.communicator());
        const double *next = sources.data();
        for (const unsigned int c : of_team)
          {
            Columns both[2];
            for (Columns &field : both)
              for (std::vector<double> &column : field)
                {
                  column.assign(next, next + layout_.capsules()[c].n_control_points());
                  next += column.size();
                }
            add_stokeslets(both[0], both[1], faces_.places(), on_faces);
          }
      }
  }


  void
  UnboundedLiquid::set(const State &state, const ShellConfigurations &shells, const ShellFields &velocities)
  {
    if (viscosity_ratio_ != 1. && layout_.n_capsules() > 1)
      throw std::logic_error("UnboundedLiquid: another viscosity inside is for one capsule.");
    Columns velocity;
    velocity.fill(std::vector<double>(faces_.places()[0].size(), 0.));
    add_all_stokeslets(state, shells, velocity);
    if (viscosity_ratio_ != 1.)
      add_other_viscosity(state, *shells[0], velocities[0], velocity);
    faces_.set(velocity);
  }
} // namespace tanktread
