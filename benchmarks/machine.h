// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: what one core of this machine can do.

#ifndef tanktread_benchmarks_machine_h
#define tanktread_benchmarks_machine_h

#include <tanktread/base/timings.h>
#include <tanktread/fluid/cube_kernel.h>

#include <algorithm>
#include <cstdio>
#include <functional>
#include <vector>

namespace tanktread
{
  /** Shortest time (s) of a call in five series of at least 30 ms each. */
  inline double
  best_time(const std::function<void()> &call)
  {
    double      best    = 1e300;
    std::size_t n_calls = 1;
    for (unsigned int series = 0; series < 5;)
      {
        const Timings clock;
        for (std::size_t i = 0; i < n_calls; ++i)
          call();
        const double seconds = clock.elapsed();
        if (seconds < 0.03)
          n_calls *= 2;
        else
          {
            best = std::min(best, seconds / n_calls);
            ++series;
          }
      }
    return best;
  }


  constexpr long n_rounds = 20000, n_chains = 12; // multiply-adds that do not wait for each other; they fit into 16 registers

  inline volatile double sink; // what is not used would not be computed

  // One function an instruction set, because registers of that width exist only inside it. The limit of x <- m x + a is 1: no number becomes denormal.
#define TANKTREAD_MULTIPLY_ADDS(name, Number, bytes, attributes) \
  attributes inline void name()                                  \
  {                                                              \
    typedef Number Lanes __attribute__((vector_size(bytes)));    \
    Lanes          x[n_chains], sum{};                           \
    for (long k = 0; k < n_chains; ++k)                          \
      x[k] = Lanes{} + Number(k);                                \
    for (long i = 0; i < n_rounds; ++i)                          \
      for (long k = 0; k < n_chains; ++k)                        \
        x[k] = x[k] * Number(0.75) + Number(0.25);               \
    for (long k = 0; k < n_chains; ++k)                          \
      sum += x[k];                                               \
    sink = sum[0];                                               \
  }
  TANKTREAD_MULTIPLY_ADDS(multiply_adds_float, float, 16, )
  TANKTREAD_MULTIPLY_ADDS(multiply_adds_double, double, 16, )
#if defined(__x86_64__)
#  define TANKTREAD_AVX2 __attribute__((target("avx2,fma"), noinline))
#  define TANKTREAD_AVX512 __attribute__((target("avx512f,fma"), noinline))
  TANKTREAD_MULTIPLY_ADDS(multiply_adds_float_avx2, float, 32, TANKTREAD_AVX2)
  TANKTREAD_MULTIPLY_ADDS(multiply_adds_double_avx2, double, 32, TANKTREAD_AVX2)
  TANKTREAD_MULTIPLY_ADDS(multiply_adds_float_avx512, float, 64, TANKTREAD_AVX512)
  TANKTREAD_MULTIPLY_ADDS(multiply_adds_double_avx512, double, 64, TANKTREAD_AVX512)
#endif


  /** Operations a second of the best instruction set, a multiply-add being two, with numbers of 4 or 8 bytes. */
  inline double
  peak(const int bytes_of_number)
  {
    void (*const functions[][2])() = {
      {multiply_adds_float, multiply_adds_double},
#if defined(__x86_64__)
      {multiply_adds_float_avx2, multiply_adds_double_avx2},
      {multiply_adds_float_avx512, multiply_adds_double_avx512}
#endif
    };
    const int    set   = int(best_instruction_set());
    const double lanes = (16 << set) / bytes_of_number;
    return 2. * n_rounds * n_chains * lanes / best_time(functions[set][bytes_of_number == 8]);
  }


  struct Machine
  {
    double triad; // entries a second of a = b + 3 c
    double peak_float, peak_double;

    /** Bytes a second, counting that the processor reads a line before it writes to it. */
    double
    bandwidth() const
    {
      return 32. * triad;
    }
  };


  inline Machine
  measure_machine()
  {
    std::vector<double> a(1 << 24, 0.), b(a.size(), 1.), c(a.size(), 2.); // 128 MB each
    const double        seconds = best_time([&] {
      double *const       to = a.data();
      const double *const x = b.data(), *const y = c.data();
      for (std::size_t i = 0; i < a.size(); ++i)
        to[i] = x[i] + 3. * y[i];
    });
    const Machine       machine{a.size() / seconds, peak(4), peak(8)};
    std::printf(
      "| machine, one thread | |\n|---|---:|\n| stream triad, 24 bytes an entry | %.1f GB/s |\n| the same with the lines read for writing, 32 bytes | %.1f GB/s "
      "|\n| multiply-adds, float | %.0f GFlop/s |\n| multiply-adds, double | %.0f GFlop/s |\n\n",
      24e-9 * machine.triad,
      1e-9 * machine.bandwidth(),
      1e-9 * machine.peak_float,
      1e-9 * machine.peak_double);
    return machine;
  }
} // namespace tanktread

#endif
