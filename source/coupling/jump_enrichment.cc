// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: the kink of the velocity and the jump of the pressure at shells that are far from each other, in the cells that they cut.

#include <deal.II/base/mpi.h>

#include <tanktread/base/exceptions.h>
#include <tanktread/coupling/jump_enrichment.h>

#include <algorithm>
#include <stdexcept>
#include <utility>

namespace tanktread
{
  namespace
  {
    /** Velocity at a node of a cell from a vector with its ghosts. */
    Vector4
    velocity_at(const NodeSpace &space, const unsigned int node, const double *const u)
    {
      if (space.is_free(node))
        return Vector4(u + 3 * std::size_t(node));
      Vector4 result;
      for (const auto &[master, weight] : space.masters(node))
        result += double(weight) * Vector4(u + 3 * std::size_t(master));
      return result;
    }


    void
    add_at(const NodeSpace &space, const unsigned int node, const Vector4 &value, double *const load)
    {
      const auto add = [&](const std::size_t free_node, const Vector4 &part) { (Vector4(load + 3 * free_node) + part).store(load + 3 * free_node); };
      if (space.is_free(node))
        add(node, value);
      else
        for (const auto &[master, weight] : space.masters(node))
          add(master, double(weight) * value);
    }


    /** Node a of a cell of the lattice of finest cells. */
    Lattice
    node_of_cell(const Lattice &cell, const int a)
    {
      return {2 * cell[0] + a % 3, 2 * cell[1] + a / 3 % 3, 2 * cell[2] + a / 9};
    }


    bool
    is_cut(const SurfaceDistance &distance, const Lattice &cell)
    {
      unsigned int n_inside = 0;
      for (int a = 0; a < 27; ++a)
        n_inside += distance.at(node_of_cell(cell, a)) < 0.;
      return n_inside > 0 && n_inside < 27;
    }
  } // namespace


  JumpEnrichment::JumpEnrichment(const TaylorHoodSpace             &space,
                                 std::shared_ptr<const NodeSpace>   vertices,
                                 std::shared_ptr<const CellLocator> locator,
                                 const ViscosityContrast           &contrast)
    : space_(space)
    , contrast_(contrast)
    , locator_(std::move(locator))
    , averages_(std::move(vertices), space.mesh.cell_size(space.mesh.finest_level()))
  {
    if (contrast_.ratio != 1.)
      {
        viscous_forces_.resize(averages_.vertices().full_size());
        std::fill(viscous_forces_.begin(), viscous_forces_.end(), 0.);
      }
  }


  void
  JumpEnrichment::move(std::vector<LocatedShell> shells, const PointInterpolation &points)
  {
    averages_.move(std::move(shells), points);
    psi_.assign(averages_.n_points(), {});
    cut_cells_.clear();
    transposed_.clear();
    nearby_cells_.clear();
    n_coarse_cut_cells_ = 0;
    NearNodes known;
    Conflicts conflicts;
    for (const LocatedShell &shell : averages_.shells())
      find_cut_cells(SurfaceDistance(space_.mesh, shell.shell->patches()), shell.number, known, conflicts);
    near_vertices_ = find_near_vertices(averages_.vertices(), nearby_cells_);
    conflicts.shells += averages_.n_meetings();
    for (const NearVertex &vertex : near_vertices_)
      conflicts.shells += vertex.sees_two;
    refuse(conflicts);
    mean_gradients_.clear();
    if (contrast_.ratio != 1.)
      set_mean_gradients(points);
  }


  void
  JumpEnrichment::find_cut_cells(const SurfaceDistance &distance, const unsigned int shell, NearNodes &known, Conflicts &conflicts)
  {
    const FluidMesh &mesh = space_.mesh;
    const double     h    = mesh.cell_size(mesh.finest_level());
    for (const Lattice &position : distance.cells_nearby())
      {
        dealii::Point<3> centre;
        for (unsigned int d = 0; d < 3; ++d)
          centre[d] = mesh.box().lower(d) + h * (position[d] + 0.5);
        if (!mesh.box().contains(centre))
          continue;
        const int cell = locator_->locate(centre).cell;
        if (cell < 0)
          continue;
        if (space_.velocity->cell_sizes()[cell] > 1.5 * h)
          {
            n_coarse_cut_cells_ += is_cut(distance, position);
            continue;
          }
        const NodeDistances nodes = node_distances(distance, shell, position, cell, known, conflicts);
        nearby_cells_.push_back({static_cast<unsigned int>(cell), shell, {}});
        for (unsigned int j = 0; j < 8; ++j)
          nearby_cells_.back().inside[j] = nodes.inside[node_of_vertex(j)];
        const auto n_inside = std::count(nodes.inside.begin(), nodes.inside.end(), true);
        if (n_inside > 0 && n_inside < 27)
          add_cut_cell(cell, centre, nodes);
      }
  }


  NodeDistances
  JumpEnrichment::node_distances(const SurfaceDistance &distance,
                                 const unsigned int     shell,
                                 const Lattice         &position,
                                 const unsigned int     cell,
                                 NearNodes             &known,
                                 Conflicts             &conflicts) const
  {
    const NodeSpace          &u     = *space_.velocity;
    const unsigned int *const nodes = u.cell_nodes(cell);
    NodeDistances             result;
    for (int a = 0; a < 27; ++a)
      {
        const Lattice node         = node_of_cell(position, a);
        const auto [found, is_new] = known.try_emplace(nodes[a]);
        NearNode &near             = found->second;
        if (is_new || nodes[a] + 1 == u.n_local()) // the last place is that of all nodes on faces with prescribed velocity
          near = {distance.at(node), node, shell};
        else if (near.shell != shell)
          ++conflicts.shells;
        else if (near.image != node)
          ++conflicts.images;
        result.phi[a]    = near.phi;
        result.inside[a] = near.phi < 0.;
      }
    return result;
  }


  void
  JumpEnrichment::refuse(const Conflicts &conflicts) const
  {
    std::vector<unsigned int> numbers = {conflicts.images, conflicts.shells};
    dealii::Utilities::MPI::max(numbers, space_.mesh.communicator(), numbers);
    if (numbers[1] > 0)
      throw std::logic_error("JumpEnrichment: shells that are told to be far from each other have a vertex of the mesh in common.");
    if (numbers[0] > 0)
      throw NumericalError(
        "A capsule has come so near to a periodic image of itself that cells of the fluid see both, which the enriched interface cannot tell apart. "
        "Take a larger Scene/Box side, a smaller Fluid mesh/Finest cell or Solver/Interface = plain.");
  }


  void
  JumpEnrichment::add_cut_cell(const unsigned int cell, const dealii::Point<3> &centre, const NodeDistances &nodes)
  {
    const double           h = space_.velocity->cell_sizes()[cell], lambda = contrast_.ratio;
    std::array<double, 27> scaled;
    for (unsigned int a = 0; a < 27; ++a)
      scaled[a] = nodes.phi[a] / h;
    GradientProducts          products;
    const PartialCellMatrices in = inside_matrices(scaled, lambda == 1. ? nullptr : &products);
    const NodeAmplitudes      q  = node_amplitudes(nodes, lambda);
    cut_cells_.push_back({cell, averages_.group_of_cell(cell), nodes, CutCellForms(nodes, in, q, lambda), {}});
    if (lambda != 1.)
      {
        cut_cells_.back().stress = undisturbed_stress(nodes, in, q, contrast_.flow.gradient(centre), lambda);
        transposed_.emplace_back(products, nodes.inside, q, lambda);
      }
    set_point_values(cut_cells_.back(), q);
  }


  void
  JumpEnrichment::set_point_values(const CutCell &cut, const NodeAmplitudes &q)
  {
    if (cut.group == VertexAverages::no_points)
      return;
    const VertexAverages::Group &group = averages_.groups()[cut.group];
    for (unsigned int i = group.begin; i < group.end; ++i)
      psi_[i] = psi_outside(cut.nodes, q, averages_.unit_position(i));
  }


  double
  JumpEnrichment::undisturbed_work(const VertexArray &forces) const
  {
    double result = 0.;
    for (const CutCell &cut : cut_cells_)
      {
        const VertexForces f = averages_.at_cell(forces, cut.cell);
        const double       h = space_.velocity->cell_sizes()[cut.cell];
        for (unsigned int v = 0; v < 8; ++v)
          result += h * h * sum3(vector4(cut.stress[v]).times(f[v]));
      }
    return result;
  }


  void
  JumpEnrichment::add_load(const VertexArray &forces, const double factor, double *const load_u, double *const load_p) const
  {
    const NodeSpace        &u_space = *space_.velocity, &p_space = *space_.pressure;
    std::array<Vector4, 27> loads;
    for (const CutCell &cut : cut_cells_)
      {
        const double              h       = u_space.cell_sizes()[cut.cell];
        const VertexForces        f       = averages_.at_cell(forces, cut.cell);
        const unsigned int *const nodes   = u_space.cell_nodes(cut.cell);
        const unsigned int *const p_nodes = p_space.cell_nodes(cut.cell);
        cut.forms.node_loads(h, f, loads);
        if (!transposed_.empty())
          transposed_[&cut - cut_cells_.data()].add_loads(h, f, loads);
        for (unsigned int b = 0; b < 27; ++b)
          add_at(u_space, nodes[b], factor * loads[b], load_u);
        const std::array<double, 8> pressure_loads = cut.forms.pressure_loads(h, f);
        for (unsigned int j = 0; j < 8; ++j)
          load_p[p_nodes[j]] += factor * pressure_loads[j];
      }
  }


  void
  JumpEnrichment::add_field_response(const double *const u, const double *const p, VertexArray &dual) const
  {
    const NodeSpace        &u_space = *space_.velocity, &p_space = *space_.pressure;
    std::array<Vector4, 27> velocities;
    std::array<double, 8>   pressures;
    for (const CutCell &cut : cut_cells_)
      {
        const double              h       = u_space.cell_sizes()[cut.cell];
        const unsigned int *const nodes   = u_space.cell_nodes(cut.cell);
        const unsigned int *const p_nodes = p_space.cell_nodes(cut.cell);
        for (unsigned int b = 0; b < 27; ++b)
          velocities[b] = velocity_at(u_space, nodes[b], u);
        for (unsigned int j = 0; j < 8; ++j)
          pressures[j] = p[p_nodes[j]];
        VertexForces r;
        cut.forms.add_response(h, velocities, pressures, r);
        if (!transposed_.empty())
          transposed_[&cut - cut_cells_.data()].add_response(h, velocities, r);
        averages_.add_to_cell(cut.cell, r, dual);
      }
  }


  void
  JumpEnrichment::add_self_response(const std::vector<double> &at_points,
                                    const VertexArray         &forces,
                                    const bool                 whole,
                                    VertexArray               &dual,
                                    std::vector<double>       &values) const
  {
    for (const CutCell &cut : cut_cells_)
      {
        const double       h = space_.velocity->cell_sizes()[cut.cell];
        const VertexForces f = averages_.at_cell(forces, cut.cell);
        VertexForces       r;
        if (cut.group != VertexAverages::no_points)
          for (unsigned int i = averages_.groups()[cut.group].begin; i < averages_.groups()[cut.group].end; ++i)
            {
              const std::size_t point = averages_.point(i);
              const Vector4     force(&at_points[3 * point]);
              Vector4           value(&values[3 * point]);
              for (unsigned int v = 0; v < 8; ++v)
                {
                  value += psi_[i][v] * f[v];
                  r[v] += psi_[i][v] * force;
                }
              value.store(&values[3 * point]);
            }
        cut.forms.add_self_response(h, f, r);
        if (!transposed_.empty())
          transposed_[&cut - cut_cells_.data()].add_self_response(h, f, r);
        if (whole)
          for (unsigned int v = 0; v < 8; ++v)
            r[v] += -h * h * vector4(cut.stress[v]);
        averages_.add_to_cell(cut.cell, r, dual);
      }
  }


  void
  JumpEnrichment::carry_pressure(const VertexArray &forces, const VertexSides &before, FluidBlockVector &fields) const
  {
    tanktread::carry_pressure(*space_.pressure, nearby_cells_, averages_.vertices(), forces, near_vertices_, before, fields);
  }
} // namespace tanktread
