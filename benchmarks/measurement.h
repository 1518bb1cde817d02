// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: time and memory, and tables of what something costs on a series of meshes.

#ifndef tanktread_benchmarks_measurement_h
#define tanktread_benchmarks_measurement_h

#include <deal.II/base/mpi.h>

#include <tanktread/base/timings.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <functional>
#include <string>
#include <vector>

namespace tanktread
{
  inline std::string
  formatted(const char *const format, const double number)
  {
    char text[40];
    std::snprintf(text, sizeof(text), format, number);
    return text;
  }


  /** One column of a row. */
  struct Entry
  {
    std::string name, text;
    double      cost; // what grows with the number of cells; zero: nothing of that kind
  };
  using Entries = std::vector<Entry>;

  /** A number of things. */
  inline Entry
  count(const std::string &name, const double number)
  {
    return {name, formatted("%.0f", number), 0.};
  }


  /** A time. */
  inline Entry
  seconds(const std::string &name, const double time)
  {
    return {name + ", s", formatted("%.3g", time), time};
  }


  /** All about one mesh; each part is a row of its own table. */
  struct Measurement
  {
    std::string mesh;
    double      n_cells = 0.;
    Entries     problem, algebraic, solves_at_sphere, solves, plain_steps, steps, viscous_steps, pair_steps;
  };


  inline std::string
  line(const std::string &first, const Entries &entries, const std::string Entry::*const what)
  {
    std::string result = "| " + first + " |";
    for (const Entry &entry : entries)
      result += " " + entry.*what + " |";
    return result + "\n";
  }


  /** Markdown, one row a mesh. */
  inline std::string
  table(const std::string &title, const std::vector<Measurement> &all, const Entries Measurement::*const part)
  {
    const Entries &first  = all.front().*part;
    std::string    result = title + "\n\n" + line("h", first, &Entry::name) + "|---|";
    for (std::size_t i = 0; i < first.size(); ++i)
      result += "---:|";
    result += "\n";
    for (const Measurement &measurement : all)
      result += line(measurement.mesh, measurement.*part, &Entry::text);
    return result + "\n";
  }


  /** log(cost_2/cost_1)/log(cells_2/cells_1) between successive meshes, one row a cost. */
  inline std::string
  table_of_exponents(const std::vector<Measurement> &all)
  {
    std::string head = "| cost grows with the number of cells to the power |", rule = "|---|", rows;
    for (std::size_t m = 1; m < all.size(); ++m)
      {
        head += " " + all[m - 1].mesh + " to " + all[m].mesh + " |";
        rule += "---:|";
      }
    for (const auto part : {&Measurement::problem,
                            &Measurement::algebraic,
                            &Measurement::solves_at_sphere,
                            &Measurement::solves,
                            &Measurement::plain_steps,
                            &Measurement::steps,
                            &Measurement::viscous_steps,
                            &Measurement::pair_steps})
      for (std::size_t i = 0; i < (all[0].*part).size(); ++i)
        {
          if ((all[0].*part)[i].cost == 0.)
            continue;
          rows += "| " + (all[0].*part)[i].name + " |";
          for (std::size_t m = 1; m < all.size(); ++m)
            {
              const double ratio    = (all[m].*part)[i].cost / (all[m - 1].*part)[i].cost,
                           exponent = std::log(ratio) / std::log(all[m].n_cells / all[m - 1].n_cells);
              rows += std::isfinite(exponent) ? formatted(" %.2f |", exponent) : " - |";
            }
          rows += "\n";
        }
    return head + "\n" + rule + "\n" + rows;
  }


  inline double
  median(std::vector<double> values)
  {
    std::sort(values.begin(), values.end());
    return values[values.size() / 2];
  }


  inline bool
  is_first_rank()
  {
    return dealii::Utilities::MPI::this_mpi_process(MPI_COMM_WORLD) == 0;
  }


  /** Median of the wall times (s) of `n` calls; the slowest rank counts. Collective. */
  inline double
  median_time(const unsigned int n, const std::function<void()> &call)
  {
    std::vector<double> times;
    for (unsigned int i = 0; i < n; ++i)
      {
        MPI_Barrier(MPI_COMM_WORLD);
        const Timings clock;
        call();
        times.push_back(dealii::Utilities::MPI::max(clock.elapsed(), MPI_COMM_WORLD));
      }
    std::sort(times.begin(), times.end());
    return times[n / 2];
  }


  /** Makes the largest memory a matter of what comes now; without Linux's /proc it stays that of all before. */
  inline void
  forget_peak_memory()
  {
    std::ofstream("/proc/self/clear_refs") << "5";
  }


  /** Largest resident memory, sum over the ranks, what they share of libraries counted once (GB). Collective. */
  inline double
  peak_memory()
  {
    std::ifstream file("/proc/self/status");
    double        peak = 0., libraries = 0.; // kB
    for (std::string word; file >> word;)
      if (word == "VmHWM:")
        file >> peak;
      else if (word == "RssFile:")
        file >> libraries;
    return 1e-6 * (dealii::Utilities::MPI::sum(peak - libraries, MPI_COMM_WORLD) + dealii::Utilities::MPI::max(libraries, MPI_COMM_WORLD));
  }
} // namespace tanktread

#endif
