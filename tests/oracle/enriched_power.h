// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: the power of a flow with kink and jump in the cells that the shell cuts, evaluated apart from the code that makes them.

#ifndef tanktread_oracle_enriched_power_h
#define tanktread_oracle_enriched_power_h

#include <oracle/given_forces.h>

#include <map>
#include <set>
#include <vector>

namespace tanktread::oracle
{
  /** Parts of the power of a flow w = u_h + psi, p_h + eta. */
  struct Power
  {
    double dissipation = 0.; // a(w, w)
    double force       = 0.; // <f, w>
    double pressure    = 0.; // (eta, div w)
  };


  /**
   * Takes each cut cell as two, inside and outside of the shell, with the quadratic functions that w is there and the matrices of both parts; amplitudes are made of averages over all points at once.
   * The capsule must not cross the periodic faces.
   */
  class EnrichedPower
  {
  public:
    /** @param F nodal forces and @param flow what they make. */
    EnrichedPower(const GivenForces &scene, const ControlPoints &F, const GivenForces::Flow &flow)
      : scene_(scene)
      , distance_(scene.fluid.mesh(), quadratic_patches(scene.coupling_surface, scene.state.x))
    {
      const ControlPoints m = scene.coupling.density(scene.v); // the mean normal force belongs to the indicator pressure
      density_              = scene.coupling_surface.S() * scene.coupling.density(F - scene.v * (m.cwiseProduct(F).sum() / m.cwiseProduct(scene.v).sum()));
      average_forces();
      plain_part(F, flow);
      const FluidMesh        &mesh = scene.fluid.mesh();
      const auto              near = distance_.cells_nearby();
      const std::set<Lattice> candidates(near.begin(), near.end());
      unsigned int            index = 0;
      for (const auto &cell : mesh.triangulation().active_cell_iterators())
        if (cell->is_locally_owned())
          {
            if (const Lattice position = lattice(mesh.key(cell).position); cell->level() == int(mesh.finest_level()) && candidates.count(position))
              add_cell(position, index);
            ++index;
          }
      for (double *const part : {&power_.dissipation, &power_.force, &power_.pressure})
        *part = dealii::Utilities::MPI::sum(*part, MPI_COMM_WORLD);
      power_.dissipation += plain_.dissipation;
      power_.force += plain_.force;
    }

    const Power &
    power() const
    {
      return power_;
    }

  private:
    using Nodes    = Eigen::Matrix<double, 27, 3>;
    using Vertices = Eigen::Matrix<double, 8, 1>;

    static Lattice
    vertex(const Lattice &cell, const int v)
    {
      return {cell[0] + v % 2, cell[1] + v / 2 % 2, cell[2] + v / 4};
    }

    static double
    hat(const dealii::Point<3> &x, const int v)
    {
      return (v % 2 ? x[0] : 1. - x[0]) * (v / 2 % 2 ? x[1] : 1. - x[1]) * (v / 4 ? x[2] : 1. - x[2]);
    }

    static double
    quadratic(const dealii::Point<3> &x, const int a)
    {
      double    result   = 1.;
      const int place[3] = {a % 3, a / 3 % 3, a / 9};
      for (int d = 0; d < 3; ++d)
        result *= place[d] == 0 ? (1. - x[d]) * (1. - 2. * x[d]) : place[d] == 1 ? 4. * x[d] * (1. - x[d]) : x[d] * (2. * x[d] - 1.);
      return result;
    }

    /** f_t and f_n at the vertices around the points. */
    void
    average_forces()
    {
      const FluidMesh          &mesh   = scene_.fluid.mesh();
      const auto                points = scene_.coupling.points(scene_.state.x);
      const ControlPoints       n      = normals(scene_.coupling_surface, scene_.state.x);
      std::map<Lattice, double> areas;
      for (std::size_t q = 0; q < points.size(); ++q)
        {
          const auto   place = mesh.place(points[q], mesh.finest_level());
          const double f_n   = density_.row(q).dot(n.row(q));
          points_[lattice(place.key.position)].push_back({q, place.unit});
          for (int v = 0; v < 8; ++v)
            {
              const double  weight = hat(place.unit, v) * scene_.weights[q];
              const Lattice here   = vertex(lattice(place.key.position), v);
              areas[here] += weight;
              auto &sum = forces_.try_emplace(here, Eigen::RowVector4d::Zero()).first->second;
              sum.head<3>() += weight * (density_.row(q) - f_n * n.row(q));
              sum[3] += weight * f_n;
            }
        }
      for (auto &[position, sum] : forces_)
        sum /= areas[position];
    }

    Eigen::RowVector4d
    force_at(const Lattice &position) const
    {
      const auto found = forces_.find(position);
      return found == forces_.end() ? Eigen::RowVector4d::Zero() : found->second;
    }

    /** u_h alone: its dissipation and the power of all forces, those of the indicator pressure among them; and u_h at the nodes. */
    void
    plain_part(const ControlPoints &F, const GivenForces::Flow &flow)
    {
      const TaylorHoodSpace &space = scene_.fluid.space();
      FluidBlockVector       u, product, load;
      for (FluidBlockVector *const vector : {&u, &product, &load})
        space.reinit(*vector);
      u.block(velocity_block) = flow.fields.block(velocity_block);
      scene_.fluid.stokes().vmult(product, u);
      scene_.coupling.spread_plainly(F + shell_unknowns(flow.fields, MPI_COMM_WORLD).pressure_jump * scene_.v, load);
      plain_.dissipation = u.block(velocity_block) * product.block(velocity_block);
      plain_.force       = u.block(velocity_block) * load.block(velocity_block);
      u_.resize(space.velocity->full_size());
      space.velocity->load(u.block(velocity_block), u_.data());
      space.velocity->update(u_.data());
    }

    /** What psi and eta add in a cell, if it is cut. */
    void
    add_cell(const Lattice &position, const unsigned int cell)
    {
      std::array<double, 27> phi;
      int                    n_inside = 0;
      for (int a = 0; a < 27; ++a)
        {
          phi[a] = distance_.at({2 * position[0] + a % 3, 2 * position[1] + a / 3 % 3, 2 * position[2] + a / 9});
          n_inside += phi[a] < 0.;
        }
      if (n_inside == 0 || n_inside == 27)
        return;

      // psi = q N inside for a node outside, -q N outside for a node inside; eta alike.
      Nodes    u, inner, outer;
      Vertices eta_inner = Vertices::Zero(), eta_outer = Vertices::Zero();
      for (int a = 0; a < 27; ++a)
        {
          Eigen::RowVector4d f = Eigen::RowVector4d::Zero();
          for (int v = 0; v < 8; ++v)
            f += hat({0.5 * (a % 3), 0.5 * (a / 3 % 3), 0.5 * (a / 9)}, v) * force_at(vertex(position, v));
          const double *const values = &u_[4 * scene_.fluid.space().velocity->cell_nodes(cell)[a]];
          u.row(a) << values[0], values[1], values[2];
          inner.row(a) = u.row(a);
          outer.row(a) = u.row(a);
          (phi[a] < 0. ? outer : inner).row(a) += std::abs(phi[a]) * f.head<3>();
        }
      for (int j = 0; j < 8; ++j)
        {
          const bool   inside                 = phi[2 * (j % 2) + 6 * (j / 2 % 2) + 18 * (j / 4)] < 0.;
          const double f_n                    = force_at(vertex(position, j))[3];
          (inside ? eta_outer : eta_inner)[j] = inside ? f_n : -f_n;
        }
      if (const auto found = points_.find(position); found != points_.end())
        for (const auto &[q, x] : found->second)
          for (int a = 0; a < 27; ++a)
            power_.force += scene_.weights[q] * quadratic(x, a) * density_.row(q).dot(outer.row(a) - u.row(a));
      for (double &value : phi)
        value /= scene_.h;
      add_parts(inside_matrices(phi), u, inner, outer, eta_inner, eta_outer);
    }

    /** Both parts of a cell, without the dissipation of u_h by the same matrices: they are in single precision, and a common value of the nodes adds their rounding to all three. */
    void
    add_parts(const PartialCellMatrices &in, const Nodes &u, const Nodes &inner, const Nodes &outer, const Vertices &eta_inner, const Vertices &eta_outer)
    {
      const PartialCellMatrices &whole = whole_cell_matrices();
      const double               h     = scene_.h;
      for (int a = 0; a < 27; ++a)
        for (int b = 0; b < 27; ++b)
          {
            const double inside = in.laplace[a][b], all = whole.laplace[a][b];
            power_.dissipation +=
              h * (inside * inner.row(a).dot(inner.row(b)) + (all - inside) * outer.row(a).dot(outer.row(b)) - all * u.row(a).dot(u.row(b)));
          }
      for (int j = 0; j < 8; ++j)
        for (int c = 0; c < 3; ++c)
          for (int a = 0; a < 27; ++a)
            {
              const double inside = in.divergence[j][27 * c + a], all = whole.divergence[j][27 * c + a];
              power_.pressure += h * h * (eta_inner[j] * inside * inner(a, c) + eta_outer[j] * (all - inside) * outer(a, c));
            }
    }

    const GivenForces                                                       &scene_;
    const SurfaceDistance                                                    distance_;
    ControlPoints                                                            density_; // force per area at the points
    std::map<Lattice, Eigen::RowVector4d>                                    forces_;  // f_t and f_n at the vertices
    std::map<Lattice, std::vector<std::pair<std::size_t, dealii::Point<3>>>> points_;  // of each cell, with their positions in it
    dealii::AlignedVector<double>                                            u_;
    Power                                                                    plain_, power_;
  };
} // namespace tanktread::oracle

#endif
