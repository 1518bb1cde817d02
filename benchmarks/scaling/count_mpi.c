// SPDX-License-Identifier: LGPL-2.1-or-later
// Part of Tanktread: counts what a program says to MPI, and the processor time that it spends outside of it.

/*
 * A library to be loaded before the program (LD_PRELOAD), which stands between it and MPI by the profiling interface. At MPI_Finalize each rank writes into the
 * folder named by TANKTREAD_COUNT_MPI
 *
 *   totals_<rank>.csv   kind,calls,bytes,cpu_seconds: of each MPI function that is counted; bytes are those that this rank hands over, cpu_seconds processor
 *                       time within the call (polling included); before them lines "# key: value": ranks, processor seconds of the process, largest memory
 *   series_<rank>.csv   the same sums at many times: time (s since 1970), cpu (s, outside MPI), waiting (s, within), messages, bytes, sums (calls of all
 *                       ranks), sum_bytes
 *   places_<rank>.csv   only with TANKTREAD_COUNT_PLACES=1: kind,calls,bytes and return addresses within the program, innermost first, less its base: for
 *                       addr2line. Costs some microseconds a call.
 *
 * One thread a rank calls MPI. MPI_Test and MPI_Iprobe are not counted: a program that polls by them seems to work.
 */

#define _GNU_SOURCE
#include <link.h>
#include <mpi.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <time.h>
#include <unwind.h>

// ------------------------------------------------------------------------------------------------------------------------------- what is counted
enum Kind
{
  ISEND, // messages between two ranks
  SEND,
  ISSEND,
  SENDRECV,
  ALLREDUCE, // calls of all ranks of a communicator
  IALLREDUCE,
  REDUCE,
  BCAST,
  EXSCAN,
  SCAN,
  ALLGATHER,
  ALLGATHERV,
  ALLTOALL,
  ALLTOALLV,
  GATHER,
  GATHERV,
  SCATTER,
  SCATTERV,
  REDUCE_SCATTER,
  BARRIER,
  IBARRIER,
  WAIT, // nothing is handed over
  WAITALL,
  WAITSOME,
  WAITANY,
  RECV,
  PROBE,
  N_KINDS
};

static const char *const names[N_KINDS] = {"Isend",          "Send",      "Issend",     "Sendrecv", "Allreduce", "Iallreduce", "Reduce",  "Bcast",   "Exscan",
                                           "Scan",           "Allgather", "Allgatherv", "Alltoall", "Alltoallv", "Gather",     "Gatherv", "Scatter", "Scatterv",
                                           "Reduce_scatter", "Barrier",   "Ibarrier",   "Wait",     "Waitall",   "Waitsome",   "Waitany", "Recv",    "Probe"};

enum
{
  MAX_FRAMES = 32,
  N_PLACES   = 1 << 16, // of a table with open addresses
  N_SAMPLES  = 1 << 17
};

typedef struct
{
  double calls, bytes, seconds;
} Sum;

typedef struct
{
  double time, cpu, waiting, messages, bytes, sums, sum_bytes;
} Sample;

typedef struct
{
  int       kind, n_frames;
  double    calls, bytes;
  uintptr_t frames[MAX_FRAMES];
} Place;

static Sum       sums[N_KINDS];
static Sample    now, *samples = NULL;
static Place    *places   = NULL;
static int       n_places = 0, n_samples = 0, overflow = 0;
static double    interval = 2e-3; // seconds between samples; doubled, and every other sample dropped, when there is no room
static uintptr_t base, first_address, last_address;

// ------------------------------------------------------------------------------------------------------------------------------------ clocks
static double
seconds_of(const clockid_t clock)
{
  struct timespec t;
  clock_gettime(clock, &t);
  return t.tv_sec + 1e-9 * t.tv_nsec;
}

/* Nothing before `least` seconds have passed since the last one. */
static void
add_sample(const double least)
{
  const double time = seconds_of(CLOCK_REALTIME);
  if (samples == NULL || (n_samples > 0 && time < samples[n_samples - 1].time + least))
    return;
  if (n_samples == N_SAMPLES)
    {
      for (n_samples = 0; n_samples < N_SAMPLES / 2; ++n_samples)
        samples[n_samples] = samples[2 * n_samples];
      interval *= 2;
    }
  now.time             = time;
  samples[n_samples++] = now;
}

// ------------------------------------------------------------------------------------------------------------------------------------ places
static int
find_program(struct dl_phdr_info *info, size_t size, void *unused)
{
  (void)size;
  (void)unused;
  base = info->dlpi_addr;
  for (int i = 0; i < info->dlpi_phnum; ++i)
    if (info->dlpi_phdr[i].p_type == PT_LOAD && (info->dlpi_phdr[i].p_flags & PF_X))
      {
        first_address = base + info->dlpi_phdr[i].p_vaddr;
        last_address  = first_address + info->dlpi_phdr[i].p_memsz;
      }
  return 1; // the first one is the program
}

static _Unwind_Reason_Code
add_frame(struct _Unwind_Context *context, void *where)
{
  Place          *place   = where;
  const uintptr_t address = _Unwind_GetIP(context);
  if (address >= first_address && address < last_address)
    place->frames[place->n_frames++] = address - 1 - base;
  return place->n_frames < MAX_FRAMES ? _URC_NO_REASON : _URC_END_OF_STACK;
}

static void
add_place(const int kind, const double bytes)
{
  Place place = {.kind = kind, .n_frames = 0};
  memset(place.frames, 0, sizeof(place.frames));
  _Unwind_Backtrace(add_frame, &place);
  size_t hash = kind;
  for (int i = 0; i < place.n_frames; ++i)
    hash = (hash ^ place.frames[i]) * 0x9E3779B97F4A7C15u;
  for (size_t i = hash >> 40;; ++i)
    {
      Place *const found = &places[i % N_PLACES];
      if (found->calls == 0)
        {
          if (n_places > N_PLACES / 2)
            {
              overflow = 1;
              return;
            }
          ++n_places;
          *found = place;
        }
      if (found->kind == kind && found->n_frames == place.n_frames && memcmp(found->frames, place.frames, sizeof(place.frames)) == 0)
        {
          found->calls += 1;
          found->bytes += bytes;
          return;
        }
    }
}

// -------------------------------------------------------------------------------------------------------------------------------------- calls
static double
begin(const int kind, const double bytes)
{
  sums[kind].calls += 1;
  sums[kind].bytes += bytes;
  if (kind < ALLREDUCE)
    now.messages += 1, now.bytes += bytes;
  else if (kind < WAIT)
    now.sums += 1, now.sum_bytes += bytes;
  if (places != NULL && kind < WAIT)
    add_place(kind, bytes);
  return seconds_of(CLOCK_THREAD_CPUTIME_ID);
}

static int
end(const int kind, const double start, const int result)
{
  const double stop = seconds_of(CLOCK_THREAD_CPUTIME_ID);
  sums[kind].seconds += stop - start;
  now.waiting += stop - start;
  now.cpu = stop - now.waiting;
  add_sample(interval);
  return result;
}

static double
size_of(const double count, MPI_Datatype type)
{
  int size = 0;
  if (type != MPI_DATATYPE_NULL)
    PMPI_Type_size(type, &size);
  return count * size;
}

static int
rank_in(MPI_Comm communicator)
{
  int rank;
  PMPI_Comm_rank(communicator, &rank);
  return rank;
}

static double
sum_of(const int *counts, MPI_Comm communicator)
{
  int    n;
  double result = 0;
  PMPI_Comm_size(communicator, &n);
  for (int i = 0; i < n; ++i)
    result += counts[i];
  return result;
}

static double
n_ranks(MPI_Comm communicator)
{
  int n;
  PMPI_Comm_size(communicator, &n);
  return n;
}

#define COUNTED(name, kind, handed_over, parameters, arguments) \
  int MPI_##name parameters                                     \
  {                                                             \
    const double start = begin(kind, handed_over);              \
    return end(kind, start, PMPI_##name arguments);             \
  }

#include "counted_calls.h"

// ------------------------------------------------------------------------------------------------------------------------------ start and end
static void
start_counting(void)
{
  if (getenv("TANKTREAD_COUNT_MPI") == NULL)
    return;
  samples                  = malloc(N_SAMPLES * sizeof(Sample));
  const char *const wanted = getenv("TANKTREAD_COUNT_PLACES");
  if (wanted != NULL && strcmp(wanted, "1") == 0)
    {
      dl_iterate_phdr(find_program, NULL);
      places = calloc(N_PLACES, sizeof(Place));
    }
}

int
MPI_Init(int *argc, char ***argv)
{
  const int result = PMPI_Init(argc, argv);
  start_counting();
  return result;
}

int
MPI_Init_thread(int *argc, char ***argv, int required, int *provided)
{
  const int result = PMPI_Init_thread(argc, argv, required, provided);
  start_counting();
  return result;
}

static FILE *
open_file(const char *name, const int rank)
{
  char path[4096];
  snprintf(path, sizeof(path), "%s/%s_%d.csv", getenv("TANKTREAD_COUNT_MPI"), name, rank);
  FILE *const file = fopen(path, "w");
  if (file == NULL)
    perror(path);
  return file;
}

static void
write_totals(FILE *file)
{
  struct rusage usage;
  getrusage(RUSAGE_SELF, &usage);
  fprintf(file, "# ranks: %.0f\n# cpu seconds: %.6f\n# memory, KiB: %ld\n", n_ranks(MPI_COMM_WORLD), seconds_of(CLOCK_PROCESS_CPUTIME_ID), usage.ru_maxrss);
  fprintf(file, "# places: %s\nkind,calls,bytes,cpu_seconds\n", places == NULL ? "not asked for" : overflow ? "not all, the table was full" : "all");
  for (int kind = 0; kind < N_KINDS; ++kind)
    fprintf(file, "%s,%.0f,%.0f,%.6f\n", names[kind], sums[kind].calls, sums[kind].bytes, sums[kind].seconds);
}

static void
write_series(FILE *file)
{
  fprintf(file, "time,cpu,waiting,messages,bytes,sums,sum_bytes\n");
  for (const Sample *s = samples; s < samples + n_samples; ++s)
    fprintf(file, "%.6f,%.6f,%.6f,%.0f,%.0f,%.0f,%.0f\n", s->time, s->cpu, s->waiting, s->messages, s->bytes, s->sums, s->sum_bytes);
}

static void
write_places(FILE *file)
{
  fprintf(file, "kind,calls,bytes,frames\n");
  for (const Place *place = places; place < places + N_PLACES; ++place)
    if (place->calls > 0)
      {
        fprintf(file, "%s,%.0f,%.0f,", names[place->kind], place->calls, place->bytes);
        for (int i = 0; i < place->n_frames; ++i)
          fprintf(file, "%s%#lx", i > 0 ? " " : "", (unsigned long)place->frames[i]);
        fprintf(file, "\n");
      }
}

int
MPI_Finalize(void)
{
  if (samples != NULL)
    {
      add_sample(0);
      const int   rank   = rank_in(MPI_COMM_WORLD);
      FILE *const totals = open_file("totals", rank), *const series = open_file("series", rank), *const all = places != NULL ? open_file("places", rank) : NULL;
      if (totals != NULL)
        write_totals(totals), fclose(totals);
      if (series != NULL)
        write_series(series), fclose(series);
      if (all != NULL)
        write_places(all), fclose(all);
    }
  return PMPI_Finalize();
}
