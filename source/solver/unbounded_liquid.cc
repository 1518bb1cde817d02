// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: the liquid beyond the box.

#include <deal.II/base/mpi.h>

#include <tanktread/solver/unbounded_liquid.h>
#include <tanktread/surface/rigid_motion.h>

#include <algorithm>
#include <limits>

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


    /** Sum of x cross f for the sum of x f^T. */
    Eigen::RowVector3d
    torque_of(const Eigen::Matrix3d &moment)
    {
      return {moment(1, 2) - moment(2, 1), moment(2, 0) - moment(0, 2), moment(0, 1) - moment(1, 0)};
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


  std::vector<std::vector<ControlPoints>>
  UnboundedLiquid::fields_of_team(const unsigned int team, const State &state, const ShellConfigurations &shells, const ShellFields &velocities) const
  {
    const bool                              has_contrast = viscosity_ratio_ != 1.;
    std::vector<std::vector<ControlPoints>> result;
    if (layout_.team_of_rank(layout_.rank()) == team)
      for (std::size_t i = 0; i < shells.size(); ++i)
        {
          const CapsuleState  &capsule = state.capsules[i];
          const ControlPoints &v       = shells[i]->volume_gradient();
          result.push_back({capsule.x, capsule.force + capsule.pressure_jump * v});
          if (has_contrast)
            result.back().insert(result.back().end(), {without_rigid_motion(capsule.x, velocities[i]), v});
        }
    else
      for (unsigned int c = 0; c < layout_.n_capsules(); ++c)
        if (layout_.team_of(c) == team)
          result.emplace_back(has_contrast ? 4 : 2, ControlPoints(layout_.capsules()[c].n_control_points(), 3));
    for (std::vector<ControlPoints> &of_capsule : result)
      for (ControlPoints &field : of_capsule)
        if (layout_.n_teams() > 1)
          MPI_Bcast(field.data(), int(field.size()), MPI_DOUBLE, int(layout_.leader(team)), layout_.communicator());
    return result;
  }


  Eigen::RowVector3d
  UnboundedLiquid::place_of_near(const std::size_t i) const
  {
    return {near_places_[0][i], near_places_[1][i], near_places_[2][i]};
  }


  void
  UnboundedLiquid::find_candidates(const ShellConfigurations &shells)
  {
    shells_of_near_.assign(near_.size(), 0);
    between_shells_.clear();
    if (layout_.n_capsules() == 1)
      return;
    const double        margin = 2. * space_.mesh.cell_size(space_.mesh.finest_level());
    std::vector<double> own; // centre and radius of the sphere about it
    for (const auto &shell : shells)
      {
        const Eigen::RowVector3d centre = shell->x().colwise().mean();
        own.insert(own.end(), {centre[0], centre[1], centre[2], (shell->x().rowwise() - centre).rowwise().norm().maxCoeff()});
      }
    const std::vector<double> all = layout_.gathered(own, 4);
    for (std::size_t i = 0; i < near_.size(); ++i)
      {
        unsigned int n_candidates = 0;
        for (unsigned int c = 0; c < layout_.n_capsules(); ++c)
          if ((place_of_near(i) - Eigen::Map<const Eigen::RowVector3d>(&all[4 * c])).norm() < all[4 * c + 3] + margin)
            {
              shells_of_near_[i] = c;
              ++n_candidates;
            }
        if (n_candidates > 1)
          between_shells_.push_back({i, std::numeric_limits<double>::infinity()});
      }
  }


  std::vector<UnboundedLiquid::Multipoles>
  UnboundedLiquid::add_all_points(const State &state, const ShellConfigurations &shells, const ShellFields &velocities, Columns &on_faces)
  {
    std::vector<Multipoles> result(layout_.n_capsules());
    if (viscosity_ratio_ != 1.)
      find_candidates(shells);
    for (unsigned int team = 0; team < layout_.n_teams(); ++team)
      {
        const std::vector<std::vector<ControlPoints>> fields = fields_of_team(team, state, shells, velocities);
        auto                                          next   = fields.begin();
        for (unsigned int c = 0; c < layout_.n_capsules(); ++c)
          {
            if (layout_.team_of(c) != team)
              continue;
            const std::vector<ControlPoints> &of_capsule = *next++;
            const ControlPoints              &x = of_capsule[0], &force = of_capsule[1];
            add_stokeslets(columns(x), columns(force), faces_.places(), on_faces);
            if (viscosity_ratio_ == 1.)
              continue;
            const ControlPoints &U = of_capsule[2], &v = of_capsule[3];
            add_double_layer(columns(x), columns(U), columns(v), 1. - viscosity_ratio_, faces_.places(), on_faces);
            for (Between &node : between_shells_)
              if (const double square = (x.rowwise() - place_of_near(node.near)).rowwise().squaredNorm().minCoeff(); square < node.square)
                {
                  node.square                = square;
                  shells_of_near_[node.near] = c;
                }
            result[c].centre             = x.colwise().mean();
            result[c].force              = force.colwise().sum();
            const Eigen::Matrix3d moment = (x.rowwise() - result[c].centre).transpose() * force;
            result[c].torque             = torque_of(moment);
            result[c].stresslet          = symmetric_without_trace(-moment - 2. * (1. - viscosity_ratio_) * U.transpose() * v);
          }
      }
    return result;
  }


  void
  UnboundedLiquid::add_missing(const FluidBlockVector &fields, const std::vector<Multipoles> &of_points, Columns &on_faces)
  {
    uniform_.vmult(loads_, fields);
    std::vector<double> sums(12 * of_points.size(), 0.); // of the nodes nearest to each capsule: moments and forces
    for (std::size_t i = 0; i < near_.size(); ++i)
      {
        const Eigen::RowVector3d y       = place_of_near(i);
        const std::size_t        nearest = shells_of_near_[i];
        for (unsigned int d = 0; d < 3; ++d)
          {
            const double load = loads_.block(velocity_block).local_element(3 * near_[i] + d);
            for (unsigned int c = 0; c < 3; ++c)
              sums[12 * nearest + 3 * c + d] += (y[c] - of_points[nearest].centre[c]) * load;
            sums[12 * nearest + 9 + d] += load;
          }
      }
    dealii::Utilities::MPI::sum(sums, space_.mesh.communicator(), sums);
    for (std::size_t c = 0; c < of_points.size(); ++c)
      {
        const Eigen::Matrix3d moment = Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(&sums[12 * c]);
        const Columns         centre = columns(of_points[c].centre);
        // A stresslet S as a double layer of its columns at one point: -3/(8 pi) y (y . S y)/|y|^5.
        const ControlPoints missing = symmetric_without_trace(-moment) - of_points[c].stresslet, unit_vectors = Eigen::Matrix3d::Identity();
        add_double_layer(columns(of_points[c].centre.replicate(3, 1)), columns(missing), columns(unit_vectors), -0.5, faces_.places(), on_faces);
        if (of_points.size() == 1)
          continue; // nothing is taken for another one's
        const Eigen::RowVector3d missing_force  = Eigen::Map<const Eigen::RowVector3d>(&sums[12 * c + 9]) - of_points[c].force,
                                 missing_torque = torque_of(moment) - of_points[c].torque;
        add_stokeslets(centre, columns(missing_force), faces_.places(), on_faces);
        add_rotlets(centre, columns(missing_torque), faces_.places(), on_faces);
      }
  }


  void
  UnboundedLiquid::set(const State &state, const ShellConfigurations &shells, const ShellFields &velocities)
  {
    Columns velocity;
    velocity.fill(std::vector<double>(faces_.places()[0].size(), 0.));
    const std::vector<Multipoles> of_points = add_all_points(state, shells, velocities, velocity);
    if (viscosity_ratio_ != 1.)
      add_missing(state.fluid, of_points, velocity);
    faces_.set(velocity);
  }
} // namespace tanktread
