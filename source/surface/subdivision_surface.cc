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

    /** One matrix with the rows of the table for each kind of weights. */
    std::vector<SparseMatrix>
    sparse_rows(const LimitStencils &table, const std::vector<const std::vector<double> *> &kinds, const unsigned int n_columns)
    {
      const auto      &sizes = table.GetSizes();
      const auto      &index = table.GetControlIndices();
      std::vector<int> starts(sizes.size() + 1, 0), permutation(index.size()), columns(index.size());
      std::partial_sum(sizes.begin(), sizes.end(), starts.begin() + 1);
      std::iota(permutation.begin(), permutation.end(), 0);
      for (std::size_t row = 0; row < sizes.size(); ++row)
        std::sort(permutation.begin() + starts[row], permutation.begin() + starts[row + 1], [&index](const int i, const int j) { return index[i] < index[j]; });
      std::transform(permutation.begin(), permutation.end(), columns.begin(), [&index](const int i) { return index[i]; });

      std::vector<SparseMatrix> matrices;
      std::vector<double>       values(index.size());
      for (const auto *kind : kinds)
        {
          std::transform(permutation.begin(), permutation.end(), values.begin(), [&kind](const int i) { return (*kind)[i]; });
          matrices.emplace_back(Eigen::Map<const SparseMatrix>(sizes.size(), n_columns, values.size(), starts.data(), columns.data(), values.data()));
        }
      return matrices;
    }

    /** The control points that occur in the rows of each face, ascending. */
    std::vector<std::vector<int>>
    find_supports(const SparseMatrix &S, const unsigned int n_faces, const unsigned int n_points_per_face)
    {
      std::vector<std::vector<int>> supports(n_faces);
      for (unsigned int f = 0; f < n_faces; ++f)
        {
          for (unsigned int q = f * n_points_per_face; q < (f + 1) * n_points_per_face; ++q)
            for (SparseMatrix::InnerIterator entry(S, q); entry; ++entry)
              supports[f].push_back(int(entry.col()));
          std::sort(supports[f].begin(), supports[f].end());
          supports[f].erase(std::unique(supports[f].begin(), supports[f].end()), supports[f].end());
        }
      return supports;
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
    correct_second_derivatives(const TriangleMesh         &topology,
                               const Far::TopologyRefiner &refiner,
                               const TriangleQuadrature   &quadrature,
                               std::vector<SparseMatrix>  &matrices)
    {
      const std::vector<int> faces = find_irregular_faces(topology);
      if (faces.empty())
        return;
      const double       step    = 1e-4;
      TriangleQuadrature shifted = quadrature;
      shifted.points.col(0).array() += step;
      const auto         table      = make_limit_stencils(refiner, faces, shifted, Derivatives::first);
      const SparseMatrix S_1_beside = sparse_rows(*table, {&table->GetDuWeights()}, topology.vertices.size()).front();
      const int          n_points   = int(quadrature.weights.size());
      for (std::size_t f = 0; f < faces.size(); ++f)
        for (int p = 0; p < n_points; ++p)
          {
            const int    q          = faces[f] * n_points + p;
            const double size       = matrices[3].row(q).norm();
            const auto   difference = SparseMatrix((S_1_beside.row(int(f) * n_points + p) - matrices[1].row(q)) / step);
            const bool   is_right = (difference - matrices[3].row(q)).norm() < 0.1 * size, is_reversed = (difference + matrices[3].row(q)).norm() < 0.1 * size;
            if (is_right == is_reversed)
              throw std::logic_error("Second derivatives of the subdivision surface do not fit the first ones in face " + std::to_string(faces[f]) + ".");
            for (unsigned int kind = 3; is_reversed && kind < 6; ++kind)
              matrices[kind].row(q) *= -1.;
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
    std::vector<int> faces(n_faces_);
    std::iota(faces.begin(), faces.end(), 0);
    const auto table = make_limit_stencils(*refiner, faces, quadrature, derivatives);

    std::vector<const std::vector<double> *> values = {&table->GetWeights()};
    if (derivatives != Derivatives::none)
      values.insert(values.end(), {&table->GetDuWeights(), &table->GetDvWeights()});
    if (derivatives == Derivatives::second)
      values.insert(values.end(), {&table->GetDuuWeights(), &table->GetDuvWeights(), &table->GetDvvWeights()});
    matrices_ = sparse_rows(*table, values, n_control_points_);
    if (derivatives == Derivatives::second)
      correct_second_derivatives(topology, *refiner, quadrature, matrices_);

    const auto face_supports = find_supports(matrices_[0], n_faces_, n_points_per_face_);
    for (const auto &support : face_supports)
      support_size_ = std::max(support_size_, unsigned((support.size() + 3) / 4 * 4));
    for (const auto &support : face_supports)
      {
        supports_.insert(supports_.end(), support.begin(), support.end());
        supports_.insert(supports_.end(), support_size_ - support.size(), support.front());
      }
    pattern_ = AssemblyPattern(n_control_points_, support_size_, supports_);

    stencils_.assign(std::size_t(n_points()) * n_stencils() * support_size_, 0.);
    for (unsigned int q = 0; q < n_points(); ++q)
      for (unsigned int kind = 0; kind < n_stencils(); ++kind)
        for (SparseMatrix::InnerIterator entry(matrices_[kind], q); entry; ++entry)
          {
            const auto &support = face_supports[q / n_points_per_face_];
            const auto  place   = std::lower_bound(support.begin(), support.end(), int(entry.col())) - support.begin();
            stencils_[(std::size_t(q) * n_stencils() + kind) * support_size_ + place] = entry.value();
          }
  }


  const SparseMatrix &
  SubdivisionSurface::matrix(const unsigned int kind) const
  {
    if (kind >= matrices_.size())
      throw std::logic_error("SubdivisionSurface was built without the derivatives that are asked for.");
    return matrices_[kind];
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
