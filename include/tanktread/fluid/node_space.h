// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: numbering of the free nodes of a continuous field, and what the other nodes follow from.

#ifndef tanktread_fluid_node_space_h
#define tanktread_fluid_node_space_h

#include <deal.II/base/aligned_vector.h>
#include <deal.II/base/partitioner.h>

#include <tanktread/fluid/types.h>

#include <memory>
#include <vector>

namespace tanktread
{
  class ScalarSpace;

  /**
   * The nodes of a Q1 or Q2 field with `n_components` (1, 3 or 4) numbers a node, kept together.
   *
   * Only free nodes are unknowns; they have global numbers, contiguous on each rank, in the order in which the cells meet them. Vectors of unknowns have
   * entries n_components * node + component and live on partitioner(). Kernels work on *full arrays* of one rank, n_local() nodes long, with entries stride() *
   * node + component:
   *
   *     owned free nodes | ghosts (free nodes of other ranks) | nodes with several masters (hanging ones) | one that is always zero (prescribed velocities)
   *
   * Three components have a stride of four numbers, which makes a node one aligned load (measured: kernels twice as fast); the fourth is zero or void.
   *
   * A periodic copy has no place of its own: the cells refer to its master. So cell loops need no constraints, and those nodes that have masters are computed
   * once each.
   */
  class NodeSpace
  {
  public:
    /**
     * Collective. Nothing of `space` is kept. Throws std::logic_error for another number of components, InputError if there are more nodes than can be counted
     * four times with the integers of this build of deal.II.
     */
    NodeSpace(const ScalarSpace &space, unsigned int n_components);

    unsigned int
    n_components() const
    {
      return n_components_;
    }
    /** Free nodes of this rank, which are the first ones of full arrays. */
    unsigned int
    n_owned() const
    {
      return n_owned_;
    }
    unsigned int
    n_local() const
    {
      return n_local_;
    }
    unsigned int
    stride() const
    {
      return n_components_ == 1 ? 1 : 4;
    }
    /** Length of a full array. */
    std::size_t
    full_size() const
    {
      return std::size_t(stride()) * n_local_;
    }
    /** Global number of the first owned free node. */
    dealii::types::global_dof_index
    first_owned() const
    {
      return partitioner_->local_range().first / n_components_;
    }
    /** Global number of an owned or ghost node. */
    dealii::types::global_dof_index
    global_node(const unsigned int local) const
    {
      return partitioner_->local_to_global(n_components_ * local) / n_components_;
    }
    const std::shared_ptr<const dealii::Utilities::MPI::Partitioner> &
    partitioner() const
    {
      return partitioner_;
    }

    /** Locally owned active cells, in deal.II's order. */
    unsigned int
    n_cells() const
    {
      return cell_size_.size();
    }
    /** 8 for Q1, 27 for Q2. */
    unsigned int
    nodes_per_cell() const
    {
      return nodes_per_cell_;
    }
    /** Places in full arrays of the cell's nodes, in lexicographic order (x fastest). */
    const unsigned int *
    cell_nodes(const unsigned int cell) const
    {
      return cell_nodes_.data() + std::size_t(nodes_per_cell_) * cell;
    }
    const std::vector<double> &
    cell_sizes() const
    {
      return cell_size_;
    }

    /** A free node (its place in full arrays, owned or ghost) and its weight, which single precision holds exactly: a product of 3/8, 3/4, -1/8 or halves. */
    struct Master
    {
      unsigned int node;
      float        weight;
    };
    /** The free nodes that a node of a full array follows from, [begin, end): itself, several, or none. */
    struct Masters
    {
      const Master *first, *last;
      const Master *
      begin() const
      {
        return first;
      }
      const Master *
      end() const
      {
        return last;
      }
    };
    /** Masters of a node beyond owned and ghost ones. */
    Masters
    masters(const unsigned int node) const
    {
      const unsigned int row = node - first_constrained_;
      return {masters_.data() + row_start_[row], masters_.data() + row_start_[row + 1]};
    }
    bool
    is_free(const unsigned int node) const
    {
      return node < first_constrained_;
    }

    /** Copies a vector of unknowns to the owned entries of a full array. Number: float or double. */
    template <typename Number>
    void
    load(const FluidVector &vector, Number *values) const;

    /** The same way back; adds if `add`. */
    template <typename Number>
    void
    store(const Number *values, FluidVector &vector, bool add) const;

    /** Fills all of a full array from its owned entries. Collective. */
    template <typename Number>
    void
    update(Number *values) const;

    /** The transpose: adds what cells have put at ghosts and constrained nodes to the owned entries; the rest of the array is void then. Collective. */
    template <typename Number>
    void
    collect(Number *values) const;

    /**
     * Diagonal of the condensed matrix assembled of size^power cell_matrix over the cells, hanging nodes included exactly: one number an owned node.
     * Collective.
     *
     * @param cell_matrix of the unit cube, row by row.
     */
    std::vector<double>
    diagonal(const std::vector<double> &cell_matrix, int power) const;

    /** The same with a factor for each cell. */
    std::vector<double>
    diagonal(const std::vector<double> &cell_matrix, const std::vector<double> &factors) const;

  private:
    void
    add_constrained_diagonal(const unsigned int *nodes, double factor, const std::vector<double> &cell_matrix, std::vector<double> &diagonal) const;

    template <typename Number>
    dealii::ArrayView<Number>
    buffer() const;

    unsigned int                                               n_components_, nodes_per_cell_, n_owned_ = 0, first_constrained_ = 0, n_local_ = 0;
    std::shared_ptr<const dealii::Utilities::MPI::Partitioner> partitioner_, full_partitioner_; // the latter has stride() numbers a node
    std::vector<unsigned int>                                  cell_nodes_;
    std::vector<double>                                        cell_size_;
    std::vector<unsigned int>                                  row_start_; // of masters_, one row for each constrained node and one, empty, for the zero node
    std::vector<Master>                                        masters_;
    mutable dealii::AlignedVector<float>                       float_buffer_; // for messages
    mutable dealii::AlignedVector<double>                      double_buffer_;
  };
} // namespace tanktread

#endif
