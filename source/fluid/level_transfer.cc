// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: interpolation of velocities from one rung of the mesh to the next, and its transpose.

#include <tanktread/base/counts.h>
#include <tanktread/base/exceptions.h>
#include <tanktread/fluid/cell_averages.h>
#include <tanktread/fluid/level_transfer.h>
#include <tanktread/fluid/quadratic_element.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <limits>

namespace tanktread
{
  using Index = dealii::types::global_dof_index;

  namespace
  {
    constexpr std::size_t stride = 4; // numbers a velocity node, see NodeSpace

    struct Entry
    {
      double weight;
      Index  node;
    };
    using Row = std::vector<Entry>;

    /** What the nodes of a coarse cell follow from: 27, or 8 of linear functions. */
    using CellRows = std::vector<Row>;


    /** A row may be empty, and have no place in memory then. */
    void
    copy_entries(const Row &row, char *const to)
    {
      if (!row.empty())
        std::memcpy(to, row.data(), row.size() * sizeof(Entry));
    }


    /** Number of the cell, lengths of its rows, the rows. */
    std::vector<char>
    pack(const NodeSpace &space, const unsigned int cell, const Index cell_number)
    {
      std::vector<Entry> entries;
      const unsigned int n = space.nodes_per_cell(), header = sizeof(Index) + n; // bytes before the entries
      std::vector<char>  result(header);
      std::memcpy(result.data(), &cell_number, sizeof(Index));
      for (unsigned int a = 0; a < n; ++a)
        {
          const std::size_t  before = entries.size();
          const unsigned int node   = space.cell_nodes(cell)[a];
          if (space.is_free(node))
            entries.push_back({1., space.global_node(node)});
          else
            for (const auto &[master, weight] : space.masters(node))
              entries.push_back({weight, space.global_node(master)});
          result[sizeof(Index) + a] = static_cast<char>(entries.size() - before);
        }
      result.resize(header + entries.size() * sizeof(Entry));
      copy_entries(entries, result.data() + header);
      return result;
    }


    /** Returns the number of the cell. */
    template <typename Bytes>
    Index
    unpack(const Bytes &bytes, CellRows &rows)
    {
      const char *const data = &*bytes.begin() + sizeof(Index);
      const char       *next = data + rows.size();
      Index             cell_number;
      std::memcpy(&cell_number, &*bytes.begin(), sizeof(Index));
      for (unsigned int a = 0; a < rows.size(); ++a)
        {
          rows[a].resize(static_cast<unsigned char>(data[a]));
          if (!rows[a].empty())
            std::memcpy(rows[a].data(), next, rows[a].size() * sizeof(Entry));
          next += rows[a].size() * sizeof(Entry);
        }
      return cell_number;
    }


    /**
     * Row of the node at position (i, j, k) of 5 x 5 x 5, or of 3 x 3 x 3 of linear functions, in a coarse cell; the result is in `row`, its entries for the
     * same node added up.
     */
    void
    interpolate(const CellRows &rows, const std::array<unsigned int, 3> &position, Row &row)
    {
      const unsigned int line = rows.size() == 8 ? 2 : 3; // nodes
      const auto values = [&](const unsigned int i) { return line == 2 ? std::array<double, 3>{{1. - 0.5 * i, 0.5 * i, 0.}} : quadratic_values(0.25 * i); };
      const std::array<double, 3> x = values(position[0]), y = values(position[1]), z = values(position[2]);
      row.clear();
      for (unsigned int a = 0; a < rows.size(); ++a)
        {
          const double w = x[a % line] * y[a / line % line] * z[a / (line * line)];
          if (w != 0.)
            for (const Entry &entry : rows[a])
              row.push_back({w * entry.weight, entry.node});
        }
      std::sort(row.begin(), row.end(), [](const Entry &x, const Entry &y) { return x.node < y.node; });
      std::size_t n = 0;
      for (const Entry &entry : row)
        if (n > 0 && row[n - 1].node == entry.node)
          row[n - 1].weight += entry.weight;
        else
          row[n++] = entry;
      row.resize(n);
    }


    /** Takes rows in any order, one for each owned node. */
    class RowCollector
    {
    public:
      explicit RowCollector(const unsigned int n_owned)
        : place_(n_owned, {nothing, 0})
      {}

      bool
      wants(const unsigned int node) const
      {
        return node < place_.size() && place_[node].first == nothing;
      }

      void
      add(const unsigned int node, const Row &row)
      {
        place_[node] = {entries_.size(), row.size()};
        entries_.insert(entries_.end(), row.begin(), row.end());
      }

      InterpolationRows
      sorted() const
      {
        InterpolationRows result;
        index_count(entries_.size(), "entries of the interpolation between two fluid meshes");
        result.start.reserve(place_.size() + 1);
        result.node.reserve(entries_.size());
        result.weight.reserve(entries_.size());
        result.start.push_back(0);
        for (const auto &[begin, length] : place_)
          {
            if (begin == nothing)
              throw NumericalError("A node of the fluid mesh has no value from the next coarser mesh.");
            for (std::size_t e = begin; e < begin + length; ++e)
              {
                result.node.push_back(entries_[e].node);
                result.weight.push_back(entries_[e].weight);
              }
            result.start.push_back(result.node.size());
          }
        return result;
      }

    private:
      static constexpr std::size_t                      nothing = std::numeric_limits<std::size_t>::max();
      std::vector<std::pair<std::size_t, unsigned int>> place_;
      std::vector<Entry>                                entries_;
    };


    /** Position of each locally owned active cell among them, at its active cell index. */
    std::vector<unsigned int>
    owned_cell_numbers(const FluidMesh::Triangulation &triangulation)
    {
      std::vector<unsigned int> result(triangulation.n_active_cells());
      unsigned int              n = 0;
      for (const auto &cell : triangulation.active_cell_iterators())
        if (cell->is_locally_owned())
          result[cell->active_cell_index()] = n++;
      return result;
    }
  } // namespace


  InterpolationRows
  climb_with_interpolation(FluidMesh &mesh, const NodeSpace &coarse, const std::function<const NodeSpace &()> &number_fine_nodes)
  {
    FluidMesh::Triangulation       &triangulation = mesh.triangulation();
    const std::vector<unsigned int> coarse_number = owned_cell_numbers(triangulation);
    // The cells that are packed are those of the mesh before.
    const Index        first  = first_cell(coarse);
    const unsigned int handle = triangulation.register_data_attach(
      [&](const auto &cell, const auto) {
      const unsigned int number = coarse_number[cell->active_cell_index()];
      return pack(coarse, number, first + number);
      },
      true);
    mesh.climb();

    const NodeSpace                &fine        = number_fine_nodes();
    const std::vector<unsigned int> fine_number = owned_cell_numbers(triangulation);
    RowCollector                    collector(fine.n_owned());
    const unsigned int              n_nodes = fine.nodes_per_cell(), n = n_nodes == 8 ? 2 : 3;
    CellRows                        rows(n_nodes);
    Row                             row;
    std::vector<Index>              parent(fine.n_cells());
    triangulation.notify_ready_to_unpack(handle, [&](const auto &cell, const auto, const auto &bytes) {
      const Index number = unpack(bytes, rows);
      if (!cell->has_children())
        {
          const unsigned int *nodes                      = fine.cell_nodes(fine_number[cell->active_cell_index()]);
          parent[fine_number[cell->active_cell_index()]] = number;
          for (unsigned int a = 0; a < n_nodes; ++a)
            if (collector.wants(nodes[a]))
              collector.add(nodes[a], rows[a]);
          return;
        }
      for (unsigned int child = 0; child < 8; ++child)
        {
          const unsigned int *nodes                                    = fine.cell_nodes(fine_number[cell->child(child)->active_cell_index()]);
          parent[fine_number[cell->child(child)->active_cell_index()]] = number;
          for (unsigned int a = 0; a < n_nodes; ++a)
            if (collector.wants(nodes[a]))
              {
                interpolate(rows, {{(n - 1) * (child % 2) + a % n, (n - 1) * (child / 2 % 2) + a / n % n, (n - 1) * (child / 4) + a / (n * n)}}, row);
                collector.add(nodes[a], row);
              }
        }
    });
    InterpolationRows result = collector.sorted();
    result.parent            = std::move(parent);
    return result;
  }


  template <typename Number>
  LevelTransfer<Number>::LevelTransfer(const InterpolationRows &rows, const NodeSpace &coarse, const NodeSpace &fine)
    : n_coarse_(coarse.n_owned())
    , n_fine_(fine.n_owned())
    , start_(rows.start.begin(), rows.start.end())
    , weight_(rows.weight.begin(), rows.weight.end())
  {
    const Index        first = coarse.first_owned(), n_global = coarse.partitioner()->size() / coarse.n_components();
    std::vector<Index> ghosts;
    for (const Index node : rows.node)
      if (node < first || node >= first + n_coarse_)
        ghosts.push_back(node);
    std::sort(ghosts.begin(), ghosts.end());
    ghosts.erase(std::unique(ghosts.begin(), ghosts.end()), ghosts.end());

    node_.reserve(rows.node.size());
    for (const Index node : rows.node)
      node_.push_back(node >= first && node < first + n_coarse_ ? node - first
                                                                : n_coarse_ + (std::lower_bound(ghosts.begin(), ghosts.end(), node) - ghosts.begin()));

    dealii::IndexSet owned(stride * n_global), ghost_set(stride * n_global);
    owned.add_range(stride * first, stride * (first + n_coarse_));
    for (const Index node : ghosts)
      ghost_set.add_range(stride * node, stride * (node + 1));
    partitioner_ = std::make_shared<dealii::Utilities::MPI::Partitioner>(owned, ghost_set, coarse.partitioner()->get_mpi_communicator());
    values_.resize(stride * (n_coarse_ + ghosts.size()));
    buffer_.resize(partitioner_->n_import_indices());
  }


  template <typename Number>
  void
  LevelTransfer<Number>::prolongate(const Number *const coarse, Number *const fine) const
  {
    const Number *values = coarse;
    if (partitioner_->n_mpi_processes() > 1)
      {
        const dealii::ArrayView<const Number> owned(coarse, stride * n_coarse_);
        const dealii::ArrayView<Number> ghosts(values_.data() + stride * n_coarse_, partitioner_->n_ghost_indices()), buffer(buffer_.data(), buffer_.size());
        std::vector<MPI_Request>        requests;
        partitioner_->template export_to_ghosted_array_start<Number, dealii::MemorySpace::Host>(0, owned, buffer, ghosts, requests);
        std::copy(coarse, coarse + stride * n_coarse_, values_.data());
        partitioner_->template export_to_ghosted_array_finish<Number, dealii::MemorySpace::Host>(ghosts, requests);
        values = values_.data();
      }
    const unsigned int *const start = start_.data(), *const node = node_.data();
    const Number *const weight = weight_.data();
    for (std::size_t i = 0; i < n_fine_; ++i)
      {
        Number sum[stride] = {};
        for (unsigned int e = start[i]; e < start[i + 1]; ++e)
          {
            const Number *const value = values + stride * node[e];
            for (std::size_t c = 0; c < stride; ++c)
              sum[c] += weight[e] * value[c];
          }
        for (std::size_t c = 0; c < stride; ++c)
          fine[stride * i + c] += sum[c];
      }
  }


  template <typename Number>
  void LevelTransfer<Number>::restrict(const Number *const fine, Number *const coarse) const
  {
    std::fill(values_.begin(), values_.end(), Number(0));
    const unsigned int *const start = start_.data(), *const node = node_.data();
    const Number *const weight = weight_.data();
    Number *const       values = values_.data();
    for (std::size_t i = 0; i < n_fine_; ++i)
      {
        Number given[stride];
        for (std::size_t c = 0; c < stride; ++c)
          given[c] = fine[stride * i + c];
        for (unsigned int e = start[i]; e < start[i + 1]; ++e)
          {
            const Number  w     = weight[e];
            Number *const value = values + stride * node[e];
            for (std::size_t c = 0; c < stride; ++c)
              value[c] += w * given[c];
          }
      }
    if (partitioner_->n_mpi_processes() > 1)
      {
        const dealii::ArrayView<Number> owned(values_.data(), stride * n_coarse_);
        const dealii::ArrayView<Number> ghosts(values_.data() + stride * n_coarse_, partitioner_->n_ghost_indices()), buffer(buffer_.data(), buffer_.size());
        const dealii::ArrayView<const Number> received(buffer_.data(), buffer_.size());
        std::vector<MPI_Request>              requests;
        partitioner_->template import_from_ghosted_array_start<Number, dealii::MemorySpace::Host>(dealii::VectorOperation::add, 0, ghosts, buffer, requests);
        partitioner_->template import_from_ghosted_array_finish<Number, dealii::MemorySpace::Host>(dealii::VectorOperation::add,
                                                                                                   received,
                                                                                                   owned,
                                                                                                   ghosts,
                                                                                                   requests);
      }
    std::copy(values_.begin(), values_.begin() + stride * n_coarse_, coarse);
  }


  template class LevelTransfer<float>;
  template class LevelTransfer<double>;
} // namespace tanktread
