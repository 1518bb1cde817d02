// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: the power of a flow with kinks and jumps in the cells that shells cut, evaluated apart from the code that makes them.

#ifndef tanktread_oracle_enriched_power_h
#define tanktread_oracle_enriched_power_h

#include <oracle/given_forces.h>

#include <algorithm>
#include <map>
#include <set>
#include <vector>

namespace tanktread::oracle
{
  /** Parts of the power of a flow w = u_h + sum of psi, p_h + sum of eta. */
  struct Power
  {
    double dissipation = 0.; // a(w, w)
    double force       = 0.; // <f, w>
    double pressure    = 0.; // (eta, div w)
  };


  /**
   * Takes each cut cell as several, inside of each shell that cuts it and outside of all, with the quadratic functions that w is there and the matrices of
   * these parts; amplitudes are made of averages over all points at once.
   * The capsules must not cross the periodic faces.
   */
  class EnrichedPower
  {
  public:
    /** @param F nodal forces and @param flow what they make. */
    EnrichedPower(const GivenForces &scene, const ShellFields &F, const GivenForces::Flow &flow)
      : scene_(scene)
    {
      for (unsigned int c = 0; c < F.size(); ++c)
        {
          // The mean normal force belongs to the indicator pressure.
          const Capsule       &capsule = scene.scene.capsule();
          const ControlPoints &v = scene.v(c), m = capsule.density(v);
          shells_.push_back({SurfaceDistance(scene.fluid.mesh(), quadratic_patches(scene.coupling_surface, scene.shells[c]->x())),
                             scene.coupling_surface.S() * capsule.density(F[c] - v * (m.cwiseProduct(F[c]).sum() / m.cwiseProduct(v).sum())),
                             {},
                             {}});
          average_forces(c);
        }
      plain_part(F, flow);
      add_cells();
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
    /** Cells that more than one shell cuts. */
    unsigned int
    n_shared_cells() const
    {
      return dealii::Utilities::MPI::sum(n_shared_cells_, MPI_COMM_WORLD);
    }

  private:
    using Nodes    = Eigen::Matrix<double, 27, 3>;
    using Vertices = Eigen::Matrix<double, 8, 1>;

    struct OfShell
    {
      SurfaceDistance                                                          distance;
      ControlPoints                                                            density; // force per area at the points
      std::map<Lattice, Eigen::RowVector4d>                                    forces;  // f_t and f_n at the vertices
      std::map<Lattice, std::vector<std::pair<std::size_t, dealii::Point<3>>>> points;  // of each cell, with their positions in it
    };

    /** A shell in a cell that it cuts. */
    struct Cut
    {
      std::array<double, 27> phi;
      Nodes                  f_t;
      Vertices               f_n;

      bool
      has_inside(const int a) const
      {
        return phi[a] < 0.;
      }
      bool
      has_vertex_inside(const int j) const
      {
        return has_inside(2 * (j % 2) + 6 * (j / 2 % 2) + 18 * (j / 4));
      }
    };

    /** What w and eta are in a part of a cell. */
    struct Part
    {
      Nodes    w;
      Vertices eta;
    };

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
    average_forces(const unsigned int c)
    {
      OfShell                  &shell = shells_[c];
      const FluidMesh          &mesh  = scene_.fluid.mesh();
      const ControlPoints      &X = scene_.X(c), n = normals(scene_.coupling_surface, scene_.shells[c]->x());
      std::map<Lattice, double> areas;
      for (Eigen::Index q = 0; q < X.rows(); ++q)
        {
          const auto   place = mesh.place({X(q, 0), X(q, 1), X(q, 2)}, mesh.finest_level());
          const double f_n   = shell.density.row(q).dot(n.row(q));
          shell.points[lattice(place.key.position)].push_back({q, place.unit});
          for (int v = 0; v < 8; ++v)
            {
              const double  weight = hat(place.unit, v) * scene_.weights(c)[q];
              const Lattice here   = vertex(lattice(place.key.position), v);
              areas[here] += weight;
              auto &sum = shell.forces.try_emplace(here, Eigen::RowVector4d::Zero()).first->second;
              sum.head<3>() += weight * (shell.density.row(q) - f_n * n.row(q));
              sum[3] += weight * f_n;
            }
        }
      const double h = mesh.cell_size(mesh.finest_level());
      for (auto &[position, sum] : shell.forces)
        sum /= std::max(areas[position], 0.05 * h * h);
    }

    static Eigen::RowVector4d
    force_at(const OfShell &shell, const Lattice &position)
    {
      const auto found = shell.forces.find(position);
      return found == shell.forces.end() ? Eigen::RowVector4d::Zero() : found->second;
    }

    /** u_h alone: its dissipation and the power of all forces, those of the indicator pressures among them; and u_h at the nodes. */
    void
    plain_part(const ShellFields &F, const GivenForces::Flow &flow)
    {
      const TaylorHoodSpace &space = scene_.fluid.space();
      FluidBlockVector       u, product, load;
      for (FluidBlockVector *const vector : {&u, &product, &load})
        space.reinit(*vector);
      u.block(velocity_block) = flow.fields.block(velocity_block);
      scene_.fluid.stokes().vmult(product, u);
      ShellFields all = F;
      for (unsigned int c = 0; c < F.size(); ++c)
        all[c] += flow.pressure_jumps[c] * scene_.v(c);
      scene_.coupling.spread_plainly(scene_.coupling.density(all), load);
      plain_.dissipation = u.block(velocity_block) * product.block(velocity_block);
      plain_.force       = u.block(velocity_block) * load.block(velocity_block);
      u_.resize(space.velocity->full_size());
      space.velocity->load(u.block(velocity_block), u_.data());
      space.velocity->update(u_.data());
    }

    void
    add_cells()
    {
      const FluidMesh  &mesh = scene_.fluid.mesh();
      std::set<Lattice> candidates;
      for (const OfShell &shell : shells_)
        for (const Lattice &cell : shell.distance.cells_nearby())
          candidates.insert(cell);
      unsigned int index = 0;
      for (const auto &cell : mesh.triangulation().active_cell_iterators())
        if (cell->is_locally_owned())
          {
            if (const Lattice position = lattice(mesh.key(cell).position); cell->level() == int(mesh.finest_level()) && candidates.count(position))
              add_cell(position, index);
            ++index;
          }
    }

    /** Appended if the shell cuts the cell. */
    static void
    add_cut(const OfShell &shell, const Lattice &position, std::vector<Cut> &cuts)
    {
      Cut cut;
      int n_inside = 0;
      for (int a = 0; a < 27; ++a)
        {
          cut.phi[a] = shell.distance.at({2 * position[0] + a % 3, 2 * position[1] + a / 3 % 3, 2 * position[2] + a / 9});
          n_inside += cut.has_inside(a);
          cut.f_t.row(a).setZero();
          for (int v = 0; v < 8; ++v)
            cut.f_t.row(a) += hat({0.5 * (a % 3), 0.5 * (a / 3 % 3), 0.5 * (a / 9)}, v) * force_at(shell, vertex(position, v)).head<3>();
        }
      for (int j = 0; j < 8; ++j)
        cut.f_n[j] = force_at(shell, vertex(position, j))[3];
      if (n_inside > 0 && n_inside < 27)
        cuts.push_back(cut);
    }

    /** psi = q N inside for a node outside, -q N outside for a node inside; eta alike. @param inside of these shells; null: outside of all. */
    static Part
    part(const Nodes &u, const std::vector<Cut> &cuts, const Cut *const inside)
    {
      Part result{u, Vertices::Zero()};
      for (const Cut &cut : cuts)
        {
          for (int a = 0; a < 27; ++a)
            if (cut.has_inside(a) != (&cut == inside))
              result.w.row(a) += std::abs(cut.phi[a]) * cut.f_t.row(a);
          for (int j = 0; j < 8; ++j)
            if (cut.has_vertex_inside(j) != (&cut == inside))
              result.eta[j] += (&cut == inside ? -1. : 1.) * cut.f_n[j];
        }
      return result;
    }

    /** What psi and eta add in a cell, if it is cut. */
    void
    add_cell(const Lattice &position, const unsigned int cell)
    {
      std::vector<Cut> cuts;
      for (const OfShell &shell : shells_)
        add_cut(shell, position, cuts);
      if (cuts.empty())
        return;
      n_shared_cells_ += cuts.size() > 1;
      Nodes u;
      for (int a = 0; a < 27; ++a)
        {
          const double *const values = &u_[4 * scene_.fluid.space().velocity->cell_nodes(cell)[a]];
          u.row(a) << values[0], values[1], values[2];
        }
      const Part outside = part(u, cuts, nullptr);
      for (unsigned int c = 0; c < shells_.size(); ++c)
        if (const auto found = shells_[c].points.find(position); found != shells_[c].points.end())
          for (const auto &[q, x] : found->second)
            for (int a = 0; a < 27; ++a)
              power_.force += scene_.weights(c)[q] * quadratic(x, a) * shells_[c].density.row(q).dot(outside.w.row(a) - u.row(a));
      // All as if it were outside, without the dissipation of u_h by the same matrices: they are in single precision, and a common value of the nodes adds
      // their rounding to all.
      add_part(whole_cell_matrices(), outside, 1.);
      add_part(whole_cell_matrices(), {u, Vertices::Zero()}, -1.);
      for (const Cut &cut : cuts)
        {
          std::array<double, 27> scaled = cut.phi;
          for (double &value : scaled)
            value /= scene_.h;
          const PartialCellMatrices in = inside_matrices(scaled);
          add_part(in, part(u, cuts, &cut), 1.);
          add_part(in, outside, -1.);
        }
    }

    void
    add_part(const PartialCellMatrices &matrices, const Part &part, const double factor)
    {
      const double h = scene_.h;
      for (int a = 0; a < 27; ++a)
        for (int b = 0; b < 27; ++b)
          power_.dissipation += factor * h * matrices.laplace[a][b] * part.w.row(a).dot(part.w.row(b));
      for (int j = 0; j < 8; ++j)
        for (int c = 0; c < 3; ++c)
          for (int a = 0; a < 27; ++a)
            power_.pressure += factor * h * h * part.eta[j] * matrices.divergence[j][27 * c + a] * part.w(a, c);
    }

    const GivenForces            &scene_;
    std::vector<OfShell>          shells_;
    dealii::AlignedVector<double> u_;
    Power                         plain_, power_;
    unsigned int                  n_shared_cells_ = 0;
  };
} // namespace tanktread::oracle

#endif
