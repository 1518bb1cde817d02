// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: numbering of the free nodes of a continuous field, and what the other nodes follow from.

#include <deal.II/base/mpi.h>

#include <tanktread/base/counts.h>
#include <tanktread/base/exceptions.h>
#include <tanktread/fluid/node_numbering.h>
#include <tanktread/fluid/node_space.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>

namespace tanktread
{
  using Index = dealii::types::global_dof_index;

  namespace
  {
    dealii::IndexSet
    with_components(const dealii::IndexSet &nodes, const unsigned int n_components)
    {
      dealii::IndexSet result(nodes.size() * n_components);
      for (auto interval = nodes.begin_intervals(); interval != nodes.end_intervals(); ++interval)
        result.add_range(*interval->begin() * n_components, (interval->last() + 1) * n_components);
      result.compress();
      return result;
    }
  } // namespace


  NodeSpace::NodeSpace(const ScalarSpace &space, const unsigned int n_components)
    : n_components_(n_components)
    , nodes_per_cell_(space.dofs().get_fe().n_dofs_per_cell())
  {
    if (n_components != 1 && n_components != 3 && n_components != 4)
      throw std::logic_error("NodeSpace: " + std::to_string(n_components) + " numbers a node; allowed: 1, 3 or 4.");
    // All nodes, those with masters too, so that no place in a full array of any rank overflows either.
    constexpr Index most_nodes = std::numeric_limits<Index>::max() / 4 - 1;
    if (space.dofs().n_dofs() > most_nodes)
      throw InputError("The fluid mesh has " + std::to_string(space.dofs().n_dofs()) + " nodes; allowed: at most " + std::to_string(most_nodes) +
                       ", which deal.II's integers can count four times (Fluid mesh/Finest cell).");
    const std::vector<Index> cell_dofs = lexicographic_dofs(space.dofs());
    NodeNumbering            numbering(space, cell_dofs);
    for (const auto &cell : space.dofs().active_cell_iterators())
      if (cell->is_locally_owned())
        cell_size_.push_back(cell->extent_in_direction(0));
    cell_nodes_.reserve(cell_dofs.size());
    for (const Index dof : cell_dofs)
      cell_nodes_.push_back(numbering.place(dof));

    n_owned_           = numbering.n_owned;
    first_constrained_ = n_owned_ + numbering.ghosts.size();
    row_start_         = std::move(numbering.row_start);
    masters_           = std::move(numbering.masters);
    row_start_.push_back(index_count(masters_.size(), "masters of hanging nodes")); // the zero node
    n_local_ = first_constrained_ + row_start_.size() - 1;
    std::replace(cell_nodes_.begin(), cell_nodes_.end(), NodeNumbering::unknown, n_local_ - 1);

    dealii::IndexSet owned(numbering.n_global), ghosts(numbering.n_global);
    owned.add_range(numbering.first_owned, numbering.first_owned + n_owned_);
    ghosts.add_indices(numbering.ghosts.begin(), numbering.ghosts.end());
    const MPI_Comm communicator = space.partitioner()->get_mpi_communicator();
    const auto     partitioner  = [&](const unsigned int n) {
      return std::make_shared<dealii::Utilities::MPI::Partitioner>(with_components(owned, n), with_components(ghosts, n), communicator);
    };
    partitioner_      = partitioner(n_components);
    full_partitioner_ = partitioner(stride());
    float_buffer_.resize(full_partitioner_->n_import_indices());
    double_buffer_.resize(full_partitioner_->n_import_indices());
  }


  template <>
  dealii::ArrayView<float>
  NodeSpace::buffer() const
  {
    return {float_buffer_.data(), float_buffer_.size()};
  }
  template <>
  dealii::ArrayView<double>
  NodeSpace::buffer() const
  {
    return {double_buffer_.data(), double_buffer_.size()};
  }


  template <typename Number>
  void
  NodeSpace::load(const FluidVector &vector, Number *const values) const
  {
    const double *const from = vector.begin();
    if (n_components_ == 3)
      for (std::size_t i = 0; i < n_owned_; ++i)
        {
          for (unsigned int c = 0; c < 3; ++c)
            values[4 * i + c] = from[3 * i + c];
          values[4 * i + 3] = 0;
        }
    else
      std::copy(from, from + n_components_ * std::size_t(n_owned_), values);
  }


  template <typename Number>
  void
  NodeSpace::store(const Number *const values, FluidVector &vector, const bool add) const
  {
    double *const      to = vector.begin();
    const unsigned int nc = n_components_, n = stride();
    for (std::size_t i = 0; i < n_owned_; ++i)
      for (unsigned int c = 0; c < nc; ++c)
        to[nc * i + c] = (add ? to[nc * i + c] : 0.) + values[n * i + c];
  }


  namespace
  {
    // The number of numbers a node is known to the compiler, and what is summed cannot be an alias of a weight.
    template <unsigned int n, typename Number>
    void
    fill_constrained(const std::size_t                     first_constrained,
                     const std::vector<unsigned int>      &row_start,
                     const std::vector<NodeSpace::Master> &masters,
                     Number *const                         values)
    {
      for (std::size_t row = 0; row + 1 < row_start.size(); ++row)
        {
          Number sum[n] = {};
          for (unsigned int e = row_start[row]; e < row_start[row + 1]; ++e)
            {
              const Number  weight = masters[e].weight;
              const Number *master = values + std::size_t(n) * masters[e].node;
              for (unsigned int c = 0; c < n; ++c)
                sum[c] += weight * master[c];
            }
          for (unsigned int c = 0; c < n; ++c)
            values[n * (first_constrained + row) + c] = sum[c];
        }
    }


    template <unsigned int n, typename Number>
    void
    give_to_masters(const std::size_t                     first_constrained,
                    const std::vector<unsigned int>      &row_start,
                    const std::vector<NodeSpace::Master> &masters,
                    Number *const                         values)
    {
      for (std::size_t row = 0; row + 1 < row_start.size(); ++row)
        {
          Number value[n];
          for (unsigned int c = 0; c < n; ++c)
            value[c] = values[n * (first_constrained + row) + c];
          for (unsigned int e = row_start[row]; e < row_start[row + 1]; ++e)
            {
              const Number weight = masters[e].weight;
              Number      *master = values + std::size_t(n) * masters[e].node;
              for (unsigned int c = 0; c < n; ++c)
                master[c] += weight * value[c];
            }
        }
    }
  } // namespace


  template <typename Number>
  void
  NodeSpace::update(Number *const values) const
  {
    const std::size_t n = stride();
    if (full_partitioner_->n_mpi_processes() > 1)
      {
        const dealii::ArrayView<Number>       ghosts(values + n * n_owned_, full_partitioner_->n_ghost_indices());
        const dealii::ArrayView<const Number> owned(values, n * n_owned_);
        std::vector<MPI_Request>              requests;
        full_partitioner_->template export_to_ghosted_array_start<Number, dealii::MemorySpace::Host>(0, owned, buffer<Number>(), ghosts, requests);
        full_partitioner_->template export_to_ghosted_array_finish<Number, dealii::MemorySpace::Host>(ghosts, requests);
      }
    if (n == 4)
      fill_constrained<4>(first_constrained_, row_start_, masters_, values);
    else
      fill_constrained<1>(first_constrained_, row_start_, masters_, values);
  }


  template <typename Number>
  void
  NodeSpace::collect(Number *const values) const
  {
    const std::size_t n = stride();
    if (n == 4)
      give_to_masters<4>(first_constrained_, row_start_, masters_, values);
    else
      give_to_masters<1>(first_constrained_, row_start_, masters_, values);
    if (full_partitioner_->n_mpi_processes() > 1)
      {
        const dealii::ArrayView<Number>       ghosts(values + n * n_owned_, full_partitioner_->n_ghost_indices()), owned(values, n * n_owned_);
        const dealii::ArrayView<Number>       temporary = buffer<Number>();
        const dealii::ArrayView<const Number> received(temporary.data(), temporary.size());
        std::vector<MPI_Request>              requests;
        full_partitioner_->template import_from_ghosted_array_start<Number, dealii::MemorySpace::Host>(dealii::VectorOperation::add,
                                                                                                       0,
                                                                                                       ghosts,
                                                                                                       temporary,
                                                                                                       requests);
        full_partitioner_->template import_from_ghosted_array_finish<Number, dealii::MemorySpace::Host>(dealii::VectorOperation::add,
                                                                                                        received,
                                                                                                        owned,
                                                                                                        ghosts,
                                                                                                        requests);
      }
  }


  namespace
  {
    /** How a node of a cell depends on one free node. */
    struct Dependence
    {
      unsigned int master, node; // the latter counted in the cell
      double       weight;
    };
  } // namespace


  void
  NodeSpace::add_constrained_diagonal(const unsigned int        *nodes,
                                      const double               factor,
                                      const std::vector<double> &cell_matrix,
                                      std::vector<double>       &diagonal) const
  {
    std::vector<Dependence> all;
    for (unsigned int a = 0; a < nodes_per_cell_; ++a)
      if (is_free(nodes[a]))
        all.push_back({nodes[a], a, 1.});
      else
        for (const auto &[master, weight] : masters(nodes[a]))
          all.push_back({master, a, weight});
    std::sort(all.begin(), all.end(), [](const Dependence &x, const Dependence &y) { return x.master < y.master; });
    for (auto begin = all.begin(); begin != all.end();)
      {
        const auto end = std::find_if(begin, all.end(), [&](const Dependence &d) { return d.master != begin->master; });
        for (auto i = begin; i != end; ++i)
          for (auto j = begin; j != end; ++j)
            diagonal[begin->master] += factor * i->weight * j->weight * cell_matrix[nodes_per_cell_ * i->node + j->node];
        begin = end;
      }
  }


  std::vector<double>
  NodeSpace::diagonal(const std::vector<double> &cell_matrix, const int power) const
  {
    std::vector<double> factors;
    for (const double h : cell_size_)
      factors.push_back(std::pow(h, power));
    return diagonal(cell_matrix, factors);
  }


  std::vector<double>
  NodeSpace::diagonal(const std::vector<double> &cell_matrix, const std::vector<double> &factors) const
  {
    std::vector<double> sums(n_local_, 0.);
    for (unsigned int cell = 0; cell < n_cells(); ++cell)
      {
        const unsigned int *nodes  = cell_nodes(cell);
        const double        factor = factors[cell];
        if (std::all_of(nodes, nodes + nodes_per_cell_, [&](const unsigned int node) { return is_free(node); }))
          for (unsigned int a = 0; a < nodes_per_cell_; ++a)
            sums[nodes[a]] += factor * cell_matrix[(nodes_per_cell_ + 1) * a];
        else
          add_constrained_diagonal(nodes, factor, cell_matrix, sums);
      }
    std::vector<double> full(full_size(), 0.), result(n_owned_);
    for (std::size_t i = 0; i < first_constrained_; ++i)
      full[stride() * i] = sums[i];
    collect(full.data());
    for (std::size_t i = 0; i < n_owned_; ++i)
      result[i] = full[stride() * i];
    return result;
  }


#define TANKTREAD_INSTANTIATE(Number)                                        \
  template void NodeSpace::load(const FluidVector &, Number *) const;        \
  template void NodeSpace::store(const Number *, FluidVector &, bool) const; \
  template void NodeSpace::update(Number *) const;                           \
  template void NodeSpace::collect(Number *) const;
  TANKTREAD_INSTANTIATE(float)
  TANKTREAD_INSTANTIATE(double)
} // namespace tanktread
