// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: the kink of the velocity and the jump of the pressure at the shell, in the cells that it cuts.

#include <deal.II/base/mpi.h>

#include <tanktread/base/target_clones.h>
#include <tanktread/coupling/jump_enrichment.h>
#include <tanktread/fluid/stokes_operator.h>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace tanktread
{
  namespace
  {
    /** Trilinear functions of the eight vertices. */
    std::array<double, 8>
    hats(const dealii::Point<3> &x)
    {
      std::array<double, 8> result;
      for (unsigned int v = 0; v < 8; ++v)
        result[v] = (v % 2 ? x[0] : 1. - x[0]) * (v / 2 % 2 ? x[1] : 1. - x[1]) * (v / 4 ? x[2] : 1. - x[2]);
      return result;
    }


    /** Triquadratic functions of the 27 nodes. */
    std::array<double, 27>
    quadratic_functions(const dealii::Point<3> &x)
    {
      std::array<double, 27> result;
      double                 n[3][3];
      for (unsigned int d = 0; d < 3; ++d)
        {
          n[d][0] = (1. - x[d]) * (1. - 2. * x[d]);
          n[d][1] = 4. * x[d] * (1. - x[d]);
          n[d][2] = x[d] * (2. * x[d] - 1.);
        }
      for (unsigned int a = 0; a < 27; ++a)
        result[a] = n[0][a % 3] * n[1][a / 3 % 3] * n[2][a / 9];
      return result;
    }


    /** Their gradients. */
    std::array<Vector4, 27>
    quadratic_gradients(const dealii::Point<3> &x)
    {
      std::array<Vector4, 27> result;
      double                  n[3][3], dn[3][3];
      for (unsigned int d = 0; d < 3; ++d)
        {
          n[d][0]  = (1. - x[d]) * (1. - 2. * x[d]);
          n[d][1]  = 4. * x[d] * (1. - x[d]);
          n[d][2]  = x[d] * (2. * x[d] - 1.);
          dn[d][0] = 4. * x[d] - 3.;
          dn[d][1] = 4. - 8. * x[d];
          dn[d][2] = 4. * x[d] - 1.;
        }
      for (unsigned int a = 0; a < 27; ++a)
        {
          const unsigned int i = a % 3, j = a / 3 % 3, k = a / 9;
          result[a] = {dn[0][i] * n[1][j] * n[2][k], n[0][i] * dn[1][j] * n[2][k], n[0][i] * n[1][j] * dn[2][k]};
        }
      return result;
    }


    /** The trilinear functions at the 27 nodes. */
    const std::array<std::array<double, 8>, 27> &
    hats_at_nodes()
    {
      static const auto result = [] {
        std::array<std::array<double, 8>, 27> values;
        for (unsigned int a = 0; a < 27; ++a)
          values[a] = hats(dealii::Point<3>(0.5 * (a % 3), 0.5 * (a / 3 % 3), 0.5 * (a / 9)));
        return values;
      }();
      return result;
    }


    /** Velocity at a node of a cell from a vector with its ghosts. */
    Vector4
    velocity_at(const NodeSpace &space, const unsigned int node, const double *const u)
    {
      if (space.is_free(node))
        return Vector4(u + 3 * node);
      Vector4 result;
      for (const auto &[master, weight] : space.masters(node))
        result += double(weight) * Vector4(u + 3 * master);
      return result;
    }


    void
    add_at(const NodeSpace &space, const unsigned int node, const Vector4 &value, double *const load)
    {
      if (space.is_free(node))
        (Vector4(load + 3 * node) + value).store(load + 3 * node);
      else
        for (const auto &[master, weight] : space.masters(node))
          (Vector4(load + 3 * master) + double(weight) * value).store(load + 3 * master);
    }


    /** Node of the vertex j. */
    constexpr unsigned int
    node_of_vertex(const unsigned int j)
    {
      return 2 * (j % 2) + 6 * (j / 2 % 2) + 18 * (j / 4);
    }


    inline Vector4
    vector(const std::array<float, 4> &v)
    {
      return {v[0], v[1], v[2]};
    }


    /** f with zero in the fourth place. */
    inline Vector4
    tangential(const Vector4 &f)
    {
      return {f[0], f[1], f[2]};
    }


    /** Loads of the nodes, -a(psi, N_b) + (eta, div N_b), from forces at the vertices; h is the cell's size. */
    TANKTREAD_CLONES void
    node_loads(const std::array<std::array<float, 8>, 27>                &laplace,
               const std::array<std::array<std::array<float, 4>, 8>, 27> &pressure,
               const double                                               h,
               const std::array<Vector4, 8>                              &f,
               std::array<Vector4, 27>                                   &loads)
    {
      Vector4 f_t[8];
      double  eta[8];
      for (unsigned int v = 0; v < 8; ++v)
        {
          f_t[v] = -h * tangential(f[v]);
          eta[v] = -h * h * f[v][3];
        }
      for (unsigned int b = 0; b < 27; ++b)
        {
          Vector4 sum;
          for (unsigned int v = 0; v < 8; ++v)
            {
              sum += double(laplace[b][v]) * f_t[v];
              sum += eta[v] * vector(pressure[b][v]);
            }
          loads[b] = sum;
        }
    }


    /** The transpose: adds to what is dual to forces at the vertices. */
    TANKTREAD_CLONES void
    add_node_response(const std::array<std::array<float, 8>, 27>                &laplace,
                      const std::array<std::array<std::array<float, 4>, 8>, 27> &pressure,
                      const double                                               h,
                      const std::array<Vector4, 27>                             &u,
                      std::array<Vector4, 8>                                    &r)
    {
      Vector4 sums[8], products[8];
      for (unsigned int b = 0; b < 27; ++b)
        for (unsigned int v = 0; v < 8; ++v)
          {
            sums[v] += double(laplace[b][v]) * u[b];
            products[v] += vector(pressure[b][v]).times(u[b]);
          }
      for (unsigned int v = 0; v < 8; ++v)
        r[v] += -h * sums[v] + Vector4(0., 0., 0., -h * h * (products[v][0] + products[v][1] + products[v][2]));
    }
  } // namespace


  JumpEnrichment::JumpEnrichment(const TaylorHoodSpace &space, const ViscosityContrast &contrast)
    : space_(space)
    , contrast_(contrast)
    , locator_(space.mesh)
    , extension_(ScalarSpace(space.mesh, 1, false), 4)
    , extension_values_(extension_.full_size())
    , pressure_values_(space.pressure->full_size())
  {
    const NodeSpace              &p = *space.pressure;
    dealii::AlignedVector<double> ones(p.full_size());
    std::fill(ones.begin(), ones.end(), 1.);
    p.update(ones.data());
    std::fill(pressure_values_.begin(), pressure_values_.end(), 0.);
    add_pressure_mass(cubes(space), ones.data(), pressure_values_.data());
    p.collect(pressure_values_.data());
    pressure_integrals_.assign(pressure_values_.begin(), pressure_values_.begin() + p.n_owned());
    if (contrast_.ratio != 1.)
      {
        viscous_values_.resize(extension_.full_size());
        std::fill(viscous_values_.begin(), viscous_values_.end(), 0.);
      }
  }


  void
  JumpEnrichment::move(std::vector<QuadraticPatch> patches, const Eigen::VectorXd &area_weights, const PointInterpolation &points)
  {
    points_ = &points;
    const SurfaceDistance distance(space_.mesh, std::move(patches));
    group_points();
    const auto &local = points.local_points();
    hats_.resize(local.size());
    normals_.resize(local.size());
    psi_.assign(local.size(), {});
    slopes_.clear();
    areas_.clear();
    if (contrast_.ratio != 1.)
      {
        slopes_.resize(local.size());
        for (const unsigned int r : point_order_)
          areas_.push_back(area_weights[local[r]]);
      }
    for (unsigned int i = 0; i < point_order_.size(); ++i)
      {
        const unsigned int    r      = point_order_[i];
        const QuadraticPatch &patch  = distance.patches()[local[r]];
        const Eigen::Vector3d normal = patch.a_1.cross(patch.a_2).normalized();
        hats_[i]                     = hats(points.unit_positions()[r]);
        normals_[i]                  = Vector4(normal.data());
      }
    find_cut_cells(distance);
    set_weights(area_weights);
  }


  void
  JumpEnrichment::group_points()
  {
    const auto &cells = points_->cells();
    point_order_.resize(cells.size());
    std::iota(point_order_.begin(), point_order_.end(), 0);
    std::stable_sort(point_order_.begin(), point_order_.end(), [&](const unsigned int r, const unsigned int s) { return cells[r] < cells[s]; });
    groups_.clear();
    group_of_cell_.assign(space_.velocity->n_cells(), no_points);
    for (unsigned int i = 0; i < point_order_.size(); ++i)
      {
        const unsigned int cell = cells[point_order_[i]];
        if (groups_.empty() || groups_.back().cell != cell)
          {
            group_of_cell_[cell] = groups_.size();
            groups_.push_back({cell, i, i});
          }
        ++groups_.back().end;
      }
  }


  void
  JumpEnrichment::find_cut_cells(const SurfaceDistance &distance)
  {
    const FluidMesh    &mesh = space_.mesh;
    const double        h    = mesh.cell_size(mesh.finest_level());
    std::vector<double> phi(space_.velocity->n_local(), std::nan(""));
    cut_cells_.clear();
    transposed_.clear();
    nearby_cells_.clear();
    for (const Lattice &position : distance.cells_nearby())
      {
        dealii::Point<3> centre;
        for (unsigned int d = 0; d < 3; ++d)
          centre[d] = mesh.box().lower(d) + h * (position[d] + 0.5);
        if (!mesh.box().contains(centre))
          continue;
        const int cell = locator_.locate(centre).cell;
        if (cell < 0 || space_.velocity->cell_sizes()[cell] > 1.5 * h)
          continue;
        const unsigned int *const nodes    = space_.velocity->cell_nodes(cell);
        unsigned int              n_inside = 0;
        NodeDistances             distances;
        for (int a = 0; a < 27; ++a)
          {
            double &value = phi[nodes[a]];
            if (std::isnan(value) || nodes[a] + 1 == space_.velocity->n_local()) // the last place is that of all wall nodes
              value = distance.at({2 * position[0] + a % 3, 2 * position[1] + a / 3 % 3, 2 * position[2] + a / 9});
            distances.phi[a]    = value;
            distances.inside[a] = value < 0.;
            n_inside += distances.inside[a];
          }
        nearby_cells_.push_back(cell);
        if (n_inside > 0 && n_inside < 27)
          add_cut_cell(cell, distances);
      }
    set_sides(phi);
  }


  void
  JumpEnrichment::set_sides(const std::vector<double> &phi)
  {
    const NodeSpace &space = *space_.pressure;
    std::fill(pressure_values_.begin(), pressure_values_.end(), 0.);
    for (const unsigned int cell : nearby_cells_)
      for (unsigned int j = 0; j < 8; ++j)
        pressure_values_[space.cell_nodes(cell)[j]] = phi[space_.velocity->cell_nodes(cell)[node_of_vertex(j)]] < 0. ? -1. : 1.;
    space.collect(pressure_values_.data()); // several ranks may know
    sides_.resize(space.n_owned());
    for (unsigned int i = 0; i < space.n_owned(); ++i)
      sides_[i] = (pressure_values_[i] > 0.) - (pressure_values_[i] < 0.);
  }


  void
  JumpEnrichment::carry_pressure(const ExtendedForces &forces, VertexSides &sides, FluidBlockVector &fields) const
  {
    const NodeSpace    &space = *space_.pressure;
    std::vector<double> known(space.n_owned()), f_n(space.n_owned());
    for (const bool counting : {true, false})
      {
        std::fill(pressure_values_.begin(), pressure_values_.end(), 0.);
        for (const unsigned int cell : nearby_cells_)
          for (unsigned int j = 0; j < 8; ++j)
            pressure_values_[space.cell_nodes(cell)[j]] = counting ? 1. : forces.at_vertices[4 * extension_.cell_nodes(cell)[j] + 3];
        space.collect(pressure_values_.data());
        std::copy_n(pressure_values_.begin(), space.n_owned(), counting ? known.begin() : f_n.begin());
      }
    std::fill(pressure_values_.begin(), pressure_values_.end(), 0.);
    if (!sides.empty())
      for (unsigned int i = 0; i < space.n_owned(); ++i)
        if (sides[i] * sides_[i] < 0)
          pressure_values_[i] = sides_[i] * f_n[i] / known[i];
    space.store(pressure_values_.data(), fields.block(pressure_block), true);
    sides = sides_;
  }


  void
  JumpEnrichment::add_cut_cell(const unsigned int cell, const NodeDistances &nodes)
  {
    const PartialCellMatrices &whole = whole_cell_matrices();
    std::array<double, 27>     scaled;
    for (unsigned int a = 0; a < 27; ++a)
      scaled[a] = nodes.phi[a] / space_.velocity->cell_sizes()[cell];
    const double              lambda = contrast_.ratio;
    GradientProducts          products;
    const PartialCellMatrices in = inside_matrices(scaled, lambda == 1. ? nullptr : &products);

    // From forces at the vertices to amplitudes at the nodes.
    std::array<std::array<double, 8>, 27> q;
    for (unsigned int a = 0; a < 27; ++a)
      for (unsigned int v = 0; v < 8; ++v)
        q[a][v] = 2. / (1. + lambda) * nodes.phi[a] * hats_at_nodes()[a][v];

    CutCell cut = {};
    cut.cell    = cell;
    cut.group   = group_of_cell_[cell];
    // chi - i_a is chi for a node outside and minus the indicator of the outside for one inside.
    std::array<std::array<double, 8>, 27> same_side = {};
    for (unsigned int b = 0; b < 27; ++b)
      {
        std::array<double, 8> row = {}, row_same = {};
        for (unsigned int a = 0; a < 27; ++a)
          {
            const double entry = nodes.inside[a] ? double(in.laplace[b][a]) - whole.laplace[b][a] : lambda * in.laplace[b][a];
            for (unsigned int v = 0; v < 8; ++v)
              row[v] += entry * q[a][v];
            if (nodes.inside[a] == nodes.inside[b])
              for (unsigned int v = 0; v < 8; ++v)
                row_same[v] += (nodes.inside[a] ? -entry : entry) * q[a][v];
          }
        for (unsigned int v = 0; v < 8; ++v)
          cut.laplace[b][v] = row[v];
        same_side[b] = row_same;
      }
    for (unsigned int v = 0; v < 8; ++v)
      for (unsigned int w = 0; w < 8; ++w)
        {
          double sum = 0.;
          for (unsigned int b = 0; b < 27; ++b)
            sum += q[b][v] * same_side[b][w];
          cut.self[v][w] = sum;
        }
    for (unsigned int v = 0; v < 8; ++v)
      for (unsigned int w = 0; w < v; ++w)
        cut.self[v][w] = cut.self[w][v];

    for (unsigned int j = 0; j < 8; ++j)
      {
        const bool vertex_inside = nodes.inside[node_of_vertex(j)];
        for (unsigned int c = 0; c < 3; ++c)
          {
            std::array<double, 8> row = {}, row_same = {};
            for (unsigned int a = 0; a < 27; ++a)
              {
                const double inside = in.divergence[j][27 * c + a], all = whole.divergence[j][27 * c + a];
                const double entry    = nodes.inside[a] ? inside - all : inside;
                cut.pressure[a][j][c] = vertex_inside ? inside - all : inside;
                for (unsigned int v = 0; v < 8; ++v)
                  row[v] += entry * q[a][v];
                if (nodes.inside[a] == vertex_inside)
                  for (unsigned int v = 0; v < 8; ++v)
                    row_same[v] += (vertex_inside ? -entry : entry) * q[a][v];
              }
            for (unsigned int v = 0; v < 8; ++v)
              {
                cut.divergence[j][v][c] = row[v];
                cut.self_mixed[v][j][c] = row_same[v];
              }
          }
      }
    if (cut.group != no_points)
      for (unsigned int i = groups_[cut.group].begin; i < groups_[cut.group].end; ++i)
        {
          // On the shell psi is minus the sum over the nodes inside of q_a N_a.
          const auto N = quadratic_functions(points_->unit_positions()[point_order_[i]]);
          for (unsigned int a = 0; a < 27; ++a)
            if (nodes.inside[a])
              for (unsigned int v = 0; v < 8; ++v)
                psi_[i][v] -= N[a] * q[a][v];
        }
    if (lambda != 1.)
      add_viscous_part(cut, nodes, in, products, q);
    cut_cells_.push_back(cut);
  }


  void
  JumpEnrichment::add_viscous_part(CutCell                                     &cut,
                                   const NodeDistances                         &nodes,
                                   const PartialCellMatrices                   &in,
                                   const GradientProducts                      &products,
                                   const std::array<std::array<double, 8>, 27> &q)
  {
    transposed_.emplace_back(products, nodes.inside, q, contrast_.ratio);
    // Twice the strain rate of the undisturbed flow against that of psi, whose inner part has the amplitudes of the nodes outside.
    const Eigen::Matrix3d S = (contrast_.ratio - 1.) * (contrast_.flow_gradient + contrast_.flow_gradient.transpose());
    for (unsigned int v = 0; v < 8; ++v)
      {
        Eigen::Vector3d slope = Eigen::Vector3d::Zero();
        for (unsigned int a = 0; a < 27; ++a)
          if (!nodes.inside[a])
            for (unsigned int d = 0; d < 3; ++d)
              for (unsigned int j = 0; j < 8; ++j)
                slope[d] += q[a][v] * in.divergence[j][27 * d + a];
        const Eigen::Vector3d stress = S * slope;
        for (unsigned int c = 0; c < 3; ++c)
          cut.stress[v][c] = stress[c];
      }
    if (cut.group == no_points)
      return;
    const double h = space_.velocity->cell_sizes()[cut.cell];
    for (unsigned int i = groups_[cut.group].begin; i < groups_[cut.group].end; ++i)
      {
        const auto gradients = quadratic_gradients(points_->unit_positions()[point_order_[i]]);
        for (unsigned int v = 0; v < 8; ++v)
          {
            Vector4 sum;
            for (unsigned int a = 0; a < 27; ++a)
              sum += ((nodes.inside[a] ? -0.5 : 0.5) * q[a][v] / h) * gradients[a];
            slopes_[i][v] = sum;
          }
      }
  }


  void
  JumpEnrichment::set_weights(const Eigen::VectorXd &area_weights)
  {
    std::fill(extension_values_.begin(), extension_values_.end(), 0.);
    const auto &local = points_->local_points();
    for (const PointGroup &group : groups_)
      {
        const unsigned int *const vertices = extension_.cell_nodes(group.cell);
        for (unsigned int i = group.begin; i < group.end; ++i)
          for (unsigned int v = 0; v < 8; ++v)
            extension_values_[4 * vertices[v]] += hats_[i][v] * area_weights[local[point_order_[i]]];
      }
    extension_.collect(extension_values_.data());
    inverse_weights_.resize(extension_.n_owned());
    // Vertices of cut cells that see no point belong to corners that are barely cut: nothing is extended to them.
    for (unsigned int i = 0; i < extension_.n_owned(); ++i)
      inverse_weights_[i] = extension_values_[4 * i] > 1e-14 ? 1. / extension_values_[4 * i] : 0.;
  }


  JumpEnrichment::VertexForces
  JumpEnrichment::vertex_values(const dealii::AlignedVector<double> &values, const unsigned int cell) const
  {
    const unsigned int *const vertices = extension_.cell_nodes(cell);
    VertexForces              result;
    for (unsigned int v = 0; v < 8; ++v)
      {
        const double *const value = &values[4 * vertices[v]];
        result[v]                 = {value[0], value[1], value[2], value[3]};
      }
    return result;
  }


  void
  JumpEnrichment::add_vertex_values(const unsigned int cell, const VertexForces &values) const
  {
    const unsigned int *const vertices = extension_.cell_nodes(cell);
    for (unsigned int v = 0; v < 8; ++v)
      {
        double *const value = &extension_values_[4 * vertices[v]];
        for (unsigned int c = 0; c < 4; ++c)
          value[c] += values[v][c];
      }
  }


  void
  JumpEnrichment::average() const
  {
    extension_.collect(extension_values_.data());
    for (std::size_t i = 0; i < extension_.n_owned(); ++i)
      for (unsigned int c = 0; c < 4; ++c)
        extension_values_[4 * i + c] *= inverse_weights_[i];
    extension_.update(extension_values_.data());
  }


  void
  JumpEnrichment::extend(ExtendedForces &forces) const
  {
    std::fill(extension_values_.begin(), extension_values_.end(), 0.);
    for (const PointGroup &group : groups_)
      {
        VertexForces sums;
        for (unsigned int i = group.begin; i < group.end; ++i)
          {
            const Vector4 f(&forces.at_points[3 * point_order_[i]]), n = normals_[i];
            const double  f_n  = f[0] * n[0] + f[1] * n[1] + f[2] * n[2];
            const Vector4 both = f + -f_n * n + Vector4(0., 0., 0., f_n);
            for (unsigned int v = 0; v < 8; ++v)
              sums[v] += hats_[i][v] * both;
          }
        add_vertex_values(group.cell, sums);
      }
    average();
    forces.at_vertices = extension_values_;
    forces.whole       = false;
  }


  void
  JumpEnrichment::complete(ExtendedForces &forces) const
  {
    if (contrast_.ratio == 1.)
      return;
    for (std::size_t i = 0; i < viscous_values_.size(); ++i)
      forces.at_vertices[i] += viscous_values_[i];
    forces.whole = true;
  }


  void
  JumpEnrichment::update_viscous_forces(const double *const gradients, const ExtendedForces &forces)
  {
    ExtendedForces g;
    g.at_points.resize(3 * point_order_.size());
    for (const PointGroup &group : groups_)
      {
        const VertexForces f = vertex_values(forces.at_vertices, group.cell);
        for (unsigned int i = group.begin; i < group.end; ++i)
          {
            const unsigned int r = point_order_[i];
            Eigen::Matrix3d    G = Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(gradients + 9 * r);
            for (unsigned int v = 0; v < 8; ++v)
              for (unsigned int c = 0; c < 3; ++c)
                for (unsigned int d = 0; d < 3; ++d)
                  G(c, d) += f[v][c] * slopes_[i][v][d];
            const Eigen::Vector3d n(normals_[i][0], normals_[i][1], normals_[i][2]);
            const Eigen::Vector3d traction = (1. - contrast_.ratio) * areas_[i] * (G * n + G.transpose() * n);
            std::copy_n(traction.data(), 3, &g.at_points[3 * r]);
          }
      }
    extend(g);
    viscous_values_ = g.at_vertices;
  }


  double
  JumpEnrichment::undisturbed_work(const ExtendedForces &forces) const
  {
    double result = 0.;
    for (const CutCell &cut : cut_cells_)
      {
        const VertexForces f = vertex_values(forces.at_vertices, cut.cell);
        const double       h = space_.velocity->cell_sizes()[cut.cell];
        for (unsigned int v = 0; v < 8; ++v)
          {
            const Vector4 product = vector(cut.stress[v]).times(f[v]);
            result += h * h * (product[0] + product[1] + product[2]);
          }
      }
    return dealii::Utilities::MPI::sum(result, space_.mesh.communicator());
  }


  void
  JumpEnrichment::add_load(const ExtendedForces &forces, const double factor, FluidBlockVector &load) const
  {
    const NodeSpace        &u_space = *space_.velocity, &p_space = *space_.pressure;
    double *const           load_u = load.block(velocity_block).begin();
    std::array<Vector4, 27> loads;
    std::fill(pressure_values_.begin(), pressure_values_.end(), 0.);
    for (const CutCell &cut : cut_cells_)
      {
        const double              h       = u_space.cell_sizes()[cut.cell];
        const VertexForces        f       = vertex_values(forces.at_vertices, cut.cell);
        const unsigned int *const nodes   = u_space.cell_nodes(cut.cell);
        const unsigned int *const p_nodes = p_space.cell_nodes(cut.cell);
        node_loads(cut.laplace, cut.pressure, h, f, loads);
        if (!transposed_.empty())
          transposed_[&cut - cut_cells_.data()].add_loads(h, f, loads);
        for (unsigned int b = 0; b < 27; ++b)
          add_at(u_space, nodes[b], factor * loads[b], load_u);
        for (unsigned int j = 0; j < 8; ++j)
          {
            Vector4 sum;
            for (unsigned int v = 0; v < 8; ++v)
              sum += vector(cut.divergence[j][v]).times(f[v]);
            pressure_values_[p_nodes[j]] += factor * h * h * (sum[0] + sum[1] + sum[2]);
          }
      }
    load.block(velocity_block).compress(dealii::VectorOperation::add);
    p_space.collect(pressure_values_.data());
    const double excess =
      dealii::Utilities::MPI::sum(std::accumulate(pressure_values_.begin(), pressure_values_.begin() + p_space.n_owned(), 0.), space_.mesh.communicator());
    for (unsigned int i = 0; i < p_space.n_owned(); ++i)
      pressure_values_[i] -= excess / space_.mesh.box().volume() * pressure_integrals_[i];
    p_space.store(pressure_values_.data(), load.block(pressure_block), true);
  }


  void
  JumpEnrichment::add_self_response(const CutCell &cut, const VertexForces &f, const ExtendedForces &forces, VertexForces &r, std::vector<double> &values) const
  {
    const double h = space_.velocity->cell_sizes()[cut.cell];
    if (cut.group != no_points)
      for (unsigned int i = groups_[cut.group].begin; i < groups_[cut.group].end; ++i)
        {
          const unsigned int point = point_order_[i];
          const Vector4      force(&forces.at_points[3 * point]);
          Vector4            value(&values[3 * point]);
          for (unsigned int v = 0; v < 8; ++v)
            {
              value += psi_[i][v] * f[v];
              r[v] += psi_[i][v] * force;
            }
          value.store(&values[3 * point]);
        }
    for (unsigned int v = 0; v < 8; ++v)
      {
        Vector4 sum;
        for (unsigned int w = 0; w < 8; ++w)
          sum += -h * cut.self[v][w] * tangential(f[w]) + -h * h * f[w][3] * vector(cut.self_mixed[v][w]);
        r[v] += sum;
        for (unsigned int j = 0; j < 8; ++j)
          {
            const Vector4 product = vector(cut.self_mixed[v][j]).times(f[v]);
            r[j] += Vector4(0., 0., 0., -h * h * (product[0] + product[1] + product[2]));
          }
      }
    if (!transposed_.empty())
      transposed_[&cut - cut_cells_.data()].add_self_response(h, f, r);
    if (forces.whole)
      for (unsigned int v = 0; v < 8; ++v)
        r[v] += -h * h * vector(cut.stress[v]);
  }


  void
  JumpEnrichment::add_field_response(const CutCell &cut, const double *const u, const double *const p, VertexForces &r) const
  {
    const double              h       = space_.velocity->cell_sizes()[cut.cell];
    const unsigned int *const nodes   = space_.velocity->cell_nodes(cut.cell);
    const unsigned int *const p_nodes = space_.pressure->cell_nodes(cut.cell);
    std::array<Vector4, 27>   local;
    for (unsigned int b = 0; b < 27; ++b)
      local[b] = velocity_at(*space_.velocity, nodes[b], u);
    add_node_response(cut.laplace, cut.pressure, h, local, r);
    if (!transposed_.empty())
      transposed_[&cut - cut_cells_.data()].add_response(h, local, r);
    for (unsigned int j = 0; j < 8; ++j)
      for (unsigned int v = 0; v < 8; ++v)
        r[v] += (h * h * p[p_nodes[j]]) * vector(cut.divergence[j][v]);
  }


  void
  JumpEnrichment::load_pressure(const FluidBlockVector &fields) const
  {
    const NodeSpace &space = *space_.pressure;
    space.load(fields.block(pressure_block), pressure_values_.data());
    double mean = std::inner_product(pressure_integrals_.begin(), pressure_integrals_.end(), pressure_values_.begin(), 0.);
    mean        = dealii::Utilities::MPI::sum(mean, space_.mesh.communicator()) / space_.mesh.box().volume();
    for (unsigned int i = 0; i < space.n_owned(); ++i)
      pressure_values_[i] -= mean;
    space.update(pressure_values_.data());
  }


  void
  JumpEnrichment::add_velocities(const FluidBlockVector &fields, const ExtendedForces *const forces, std::vector<double> &values) const
  {
    load_pressure(fields);
    const FluidVector &u = fields.block(velocity_block);
    u.update_ghost_values();
    std::fill(extension_values_.begin(), extension_values_.end(), 0.);
    for (const CutCell &cut : cut_cells_)
      {
        VertexForces r;
        add_field_response(cut, u.begin(), pressure_values_.data(), r);
        if (forces != nullptr)
          add_self_response(cut, vertex_values(forces->at_vertices, cut.cell), *forces, r, values);
        add_vertex_values(cut.cell, r);
      }
    u.zero_out_ghost_values();
    average();
    for (const PointGroup &group : groups_)
      {
        const VertexForces r = vertex_values(extension_values_, group.cell);
        for (unsigned int i = group.begin; i < group.end; ++i)
          {
            Vector4 both;
            for (unsigned int v = 0; v < 8; ++v)
              both += hats_[i][v] * r[v];
            const Vector4 n      = normals_[i];
            const double  factor = both[3] - (both[0] * n[0] + both[1] * n[1] + both[2] * n[2]);
            double *const value  = &values[3 * point_order_[i]];
            (Vector4(value) + both + factor * n).store(value);
          }
      }
  }
} // namespace tanktread
