// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: limit stencils of Loop's subdivision from OpenSubdiv.

#include <tanktread/base/exceptions.h>
#include <tanktread/surface/subdivision_surface.h>

#include <opensubdiv/far/stencilTable.h>
#include <opensubdiv/far/stencilTableFactory.h>
#include <opensubdiv/far/topologyDescriptor.h>
#include <opensubdiv/far/topologyRefiner.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <numeric>
#include <stdexcept>
#include <string>

namespace tanktread
{
  namespace
  {
    namespace Far       = OpenSubdiv::Far;
    using LimitStencils = Far::LimitStencilTableReal<double>;

    std::unique_ptr<Far::TopologyRefiner>
    make_refiner(const TriangleMesh &topology)
    {
      std::vector<int> vertices_per_face(topology.faces.size(), 3), indices;
      for (const auto &face : topology.faces)
        indices.insert(indices.end(), face.begin(), face.end());
      Far::TopologyDescriptor descriptor;
      descriptor.numVertices        = int(topology.vertices.size());
      descriptor.numFaces           = int(topology.faces.size());
      descriptor.numVertsPerFace    = vertices_per_face.data();
      descriptor.vertIndicesPerFace = indices.data();

      using Factory = Far::TopologyRefinerFactory<Far::TopologyDescriptor>;
      Factory::Options options(OpenSubdiv::Sdc::SCHEME_LOOP);
      options.validateFullTopology = true;
      std::unique_ptr<Far::TopologyRefiner> refiner(Factory::Create(descriptor, options));
      if (!refiner)
        throw InputError("The triangle mesh with " + std::to_string(topology.faces.size()) + " faces is no closed manifold.");
      return refiner;
    }

    /** Refinements after which no quadrature point lies in a triangle that touches a vertex of the control mesh, at most OpenSubdiv's 10. */
    unsigned int
    isolation_level(const TriangleQuadrature &quadrature)
    {
      double nearest = 1.;
      for (Eigen::Index q = 0; q < quadrature.points.rows(); ++q)
        {
          const double s = quadrature.points(q, 0), t = quadrature.points(q, 1);
          nearest = std::min({nearest, 1. - s, 1. - t, s + t});
        }
      return nearest > std::ldexp(1., -9) ? std::max(2, int(std::floor(-std::log2(nearest))) + 1) : 10;
    }

    std::unique_ptr<const LimitStencils>
    make_limit_stencils(const Far::TopologyRefiner &refiner, const std::vector<int> &faces, const TriangleQuadrature &quadrature, const Derivatives derivatives)
    {
      using Factory               = Far::LimitStencilTableFactoryReal<double>;
      const Eigen::VectorXd     s = quadrature.points.col(0), t = quadrature.points.col(1);
      Factory::LocationArrayVec locations(faces.size());
      for (std::size_t f = 0; f < faces.size(); ++f)
        {
          locations[f].ptexIdx      = faces[f];
          locations[f].numLocations = int(s.size());
          locations[f].s            = s.data();
          locations[f].t            = t.data();
        }
      Factory::Options options;
      options.generate1stDerivatives = derivatives != Derivatives::none;
      options.generate2ndDerivatives = derivatives == Derivatives::second;
      std::unique_ptr<const LimitStencils> table(Factory::Create(refiner, locations, nullptr, nullptr, options));
      if (!table || table->GetNumStencils() != int(faces.size()) * int(s.size()))
        throw InputError("OpenSubdiv cannot evaluate the limit surface of the triangle mesh.");
      return table;
    }

    /** The weights of a table for each kind of stencils, in the order of SubdivisionSurface. */
    std::vector<const std::vector<double> *>
    weights_of(const LimitStencils &table, const Derivatives derivatives)
    {
      std::vector<const std::vector<double> *> result = {&table.GetWeights()};
      if (derivatives != Derivatives::none)
        result.insert(result.end(), {&table.GetDuWeights(), &table.GetDvWeights()});
      if (derivatives == Derivatives::second)
        result.insert(result.end(), {&table.GetDuuWeights(), &table.GetDuvWeights(), &table.GetDvvWeights()});
      return result;
    }

    /** The control points that each face depends on: the vertices of all faces that touch it, ascending. */
    std::vector<std::vector<int>>
    find_supports(const TriangleMesh &topology)
    {
      std::vector<std::vector<int>> neighbours(topology.vertices.size()), supports;
      for (const auto &face : topology.faces)
        for (const int v : face)
          neighbours[v].insert(neighbours[v].end(), face.begin(), face.end());
      for (const auto &face : topology.faces)
        {
          std::vector<int> support;
          for (const int v : face)
            support.insert(support.end(), neighbours[v].begin(), neighbours[v].end());
          std::sort(support.begin(), support.end());
          support.erase(std::unique(support.begin(), support.end()), support.end());
          supports.push_back(std::move(support));
        }
      return supports;
    }

    /** Dense stencils of the points of some faces, one kind after the other for each point, over supports of which `n` numbers have room. */
    std::vector<double>
    dense_rows(const LimitStencils &table, const std::vector<const std::vector<int> *> &supports, const Derivatives derivatives, const unsigned int n)
    {
      const auto          kinds             = weights_of(table, derivatives);
      const auto         &sizes             = table.GetSizes();
      const auto         &index             = table.GetControlIndices();
      const std::size_t   n_points_per_face = sizes.size() / supports.size();
      std::vector<double> result(sizes.size() * kinds.size() * n, 0.);
      std::size_t         entry = 0;
      for (std::size_t q = 0; q < sizes.size(); ++q)
        for (int i = 0; i < sizes[q]; ++i, ++entry)
          {
            const auto &support = *supports[q / n_points_per_face];
            const auto  place   = std::lower_bound(support.begin(), support.end(), index[entry]);
            if (place == support.end() || *place != index[entry])
              throw std::logic_error("A point of the limit surface depends on control point " + std::to_string(index[entry]) + ", which is not near its face.");
            for (std::size_t kind = 0; kind < kinds.size(); ++kind)
              result[(q * kinds.size() + kind) * n + (place - support.begin())] = (*kinds[kind])[entry];
          }
      return result;
    }

    std::vector<int>
    find_irregular_faces(const TriangleMesh &topology)
    {
      std::vector<int> valence(topology.vertices.size(), 0), irregular;
      for (const auto &face : topology.faces)
        for (const int v : face)
          ++valence[v];
      for (std::size_t f = 0; f < topology.faces.size(); ++f)
        for (const int v : topology.faces[f])
          if (valence[v] != 6 && (irregular.empty() || irregular.back() != int(f)))
            irregular.push_back(int(f));
      return irregular;
    }

    /**
     * OpenSubdiv 3.5 returns second derivatives of the wrong sign where a refined triangle is turned against its face (it applies the sign of the first
     * derivatives a third time). That happens next to extraordinary vertices only. Differences of the first derivatives, which are right, tell where.
     */
    void
    correct_second_derivatives(const std::vector<int>                      &faces,
                               const Far::TopologyRefiner                  &refiner,
                               const TriangleQuadrature                    &quadrature,
                               const std::vector<const std::vector<int> *> &supports,
                               const unsigned int                           n,
                               std::vector<double>                         &stencils)
    {
      const double       step    = 1e-4;
      TriangleQuadrature shifted = quadrature;
      shifted.points.col(0).array() += step;
      const auto         beside   = dense_rows(*make_limit_stencils(refiner, faces, shifted, Derivatives::first), supports, Derivatives::first, n);
      const Eigen::Index n_points = quadrature.weights.size();
      using Row                   = Eigen::Map<Eigen::RowVectorXd>;
      for (Eigen::Index i = 0; i < n_points * Eigen::Index(faces.size()); ++i)
        {
          const int                face = faces[i / n_points];
          double *const            here = stencils.data() + 6 * n * (face * n_points + i % n_points);
          const Row                first(here + n, n), second(here + 3 * n, n);
          const Eigen::RowVectorXd difference = (Eigen::Map<const Eigen::RowVectorXd>(beside.data() + 3 * n * i + n, n) - first) / step;
          const bool is_right = (difference - second).norm() < 0.1 * second.norm(), is_reversed = (difference + second).norm() < 0.1 * second.norm();
          if (is_right == is_reversed)
            throw std::logic_error("Second derivatives of the subdivision surface do not fit the first ones in face " + std::to_string(face) + ".");
          if (is_reversed)
            Row(here + 3 * n, 3 * n) *= -1.;
        }
    }
  } // namespace


  SubdivisionSurface::SubdivisionSurface(const TriangleMesh &topology, const TriangleQuadrature &quadrature, const Derivatives derivatives)
    : n_control_points_(topology.vertices.size())
    , n_faces_(topology.faces.size())
    , n_points_per_face_(quadrature.weights.size())
    , derivatives_(derivatives)
    , weights_(quadrature.weights.replicate(topology.faces.size(), 1))
    , support_size_(0)
    , pattern_(0, 0, {})
  {
    const auto refiner = make_refiner(topology);
    refiner->RefineAdaptive(Far::TopologyRefiner::AdaptiveOptions(isolation_level(quadrature)));
    const auto face_supports = find_supports(topology);
    for (const auto &support : face_supports)
      support_size_ = std::max(support_size_, unsigned((support.size() + 3) / 4 * 4));
    for (const auto &support : face_supports)
      {
        supports_.insert(supports_.end(), support.begin(), support.end());
        supports_.insert(supports_.end(), support_size_ - support.size(), support.front());
      }
    pattern_ = AssemblyPattern(n_control_points_, support_size_, supports_);

    const auto supports_of = [&](const std::vector<int> &faces) {
      std::vector<const std::vector<int> *> result;
      for (const int f : faces)
        result.push_back(&face_supports[f]);
      return result;
    };
    std::vector<int> faces(n_faces_);
    std::iota(faces.begin(), faces.end(), 0);
    stencils_ = dense_rows(*make_limit_stencils(*refiner, faces, quadrature, derivatives), supports_of(faces), derivatives, support_size_);
    if (const std::vector<int> irregular = find_irregular_faces(topology); derivatives == Derivatives::second && !irregular.empty())
      correct_second_derivatives(irregular, *refiner, quadrature, supports_of(irregular), support_size_, stencils_);
  }


  LimitMap
  SubdivisionSurface::map(const unsigned int kind) const
  {
    if (kind >= n_stencils())
      throw std::logic_error("SubdivisionSurface was built without the derivatives that are asked for.");
    return LimitMap({stencils_.data() + std::size_t(kind) * support_size_,
                     supports_.data(),
                     n_stencils() * support_size_,
                     support_size_,
                     n_faces_,
                     n_points_per_face_,
                     n_control_points_});
  }


  SparseMatrix
  vertex_limit_stencils(const TriangleMesh &topology)
  {
    const int        n = int(topology.vertices.size());
    std::vector<int> valence(n, 0);
    for (const auto &face : topology.faces)
      for (const int v : face)
        ++valence[v];

    std::vector<Eigen::Triplet<double>> entries;
    std::vector<double>                 chi(n);
    for (int v = 0; v < n; ++v)
      {
        chi[v] = 1. / (valence[v] + 3. / (8. * loop_weight(valence[v])));
        entries.emplace_back(v, v, 1. - valence[v] * chi[v]);
      }
    // On a closed surface every edge at v occurs once as (v, next) among the faces at v.
    for (const auto &face : topology.faces)
      for (unsigned int i = 0; i < 3; ++i)
        entries.emplace_back(face[i], face[(i + 1) % 3], chi[face[i]]);
    SparseMatrix stencils(n, n);
    stencils.setFromTriplets(entries.begin(), entries.end());
    return stencils;
  }
} // namespace tanktread
