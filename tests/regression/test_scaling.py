#!/usr/bin/env python3
# SPDX-License-Identifier: LGPL-2.1-or-later
# Part of Tanktread: tests of the scripts of benchmarks/scaling and of the library that counts for them.
"""What is counted and by whom, what is made of it, and what a user's call changes. The library is tried on a small program whose calls are known."""

import argparse
import math
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile
import unittest

import ranks_agree

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parents[1]
sys.path[:0] = [str(ROOT / "benchmarks"), str(ROOT / "benchmarks/scaling")]
import python_packages  # noqa: E402

python_packages.need("numpy", "matplotlib")

import numpy as np  # noqa: E402

import cases  # noqa: E402
import counts  # noqa: E402
import model  # noqa: E402
import report  # noqa: E402

KNOWN = r"""
#include <mpi.h>
#include <stdlib.h>
static volatile double spent;
__attribute__((noinline)) void told(double *x) { MPI_Allreduce(MPI_IN_PLACE, x, 4, MPI_DOUBLE, MPI_SUM, MPI_COMM_WORLD); spent += 1; }
__attribute__((noinline)) void worked(void) { const double start = clock_of(); while (clock_of() < start + 0.3) spent += 1; }
int main(int argc, char **argv)
{
  int rank, n; double x[10] = {0};
  MPI_Init(&argc, &argv); MPI_Comm_rank(MPI_COMM_WORLD, &rank); MPI_Comm_size(MPI_COMM_WORLD, &n);
  for (int i = 0; i < 5; ++i) told(x);
  if (rank == 0) worked();
  MPI_Barrier(MPI_COMM_WORLD);
  for (int i = 0; i < 3; ++i)
    if (rank == 0) MPI_Send(x, 10, MPI_DOUBLE, 1, 0, MPI_COMM_WORLD);
    else MPI_Recv(x, 10, MPI_DOUBLE, 0, 0, MPI_COMM_WORLD, MPI_STATUS_IGNORE);
  int counts[2] = {3, 5}, starts[2] = {0, 3}; float all[8] = {0};
  MPI_Allgatherv(MPI_IN_PLACE, 0, MPI_DATATYPE_NULL, all, counts, starts, MPI_FLOAT, MPI_COMM_WORLD);
  return MPI_Finalize();
}
"""
CLOCK = "#include <time.h>\nstatic double clock_of(void) { struct timespec t; clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t); return t.tv_sec + 1e-9 * t.tv_nsec; }\n"


class Library(unittest.TestCase):
    """count_mpi.c before two ranks of a program whose calls are known."""

    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(cls.folder.cleanup)
        root = pathlib.Path(cls.folder.name)
        cls.library, cls.program, cls.counts = cases.build_library(root), root / "known", root / "counts"
        cls.counts.mkdir()
        (root / "known.c").write_text(CLOCK + KNOWN)
        subprocess.run(["mpicc", "-O1", "-g", "-o", cls.program, root / "known.c"], check=True)
        environment = {**os.environ, "OMPI_ALLOW_RUN_AS_ROOT": "1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1"}
        subprocess.run(["mpirun", "--oversubscribe", "--bind-to", "none", "-np", "2", "env", f"LD_PRELOAD={cls.library}", f"TANKTREAD_COUNT_MPI={cls.counts}", "TANKTREAD_COUNT_PLACES=1", cls.program],
                       check=True, env=environment)
        cls.totals = [counts.read_totals(file) for file in counts.of_each_rank(cls.counts, "totals")]

    def test_calls_and_bytes(self):
        wanted = [{"Allreduce": (5, 160), "Send": (3, 240), "Allgatherv": (1, 12), "Barrier": (1, 0)}, {"Allreduce": (5, 160), "Recv": (3, 0), "Allgatherv": (1, 20), "Barrier": (1, 0)}]
        for (totals, notes), calls in zip(self.totals, wanted):
            self.assertEqual({kind: (number, bytes_) for kind, (number, bytes_, _) in totals.items() if number > 0}, calls)
            self.assertEqual(notes["ranks"], "2")
            self.assertGreater(int(notes["memory, KiB"]), 1000)

    def test_waiting_is_not_work(self):
        """The first rank works for 0.3 s, which the other one waits for, polling."""
        tables = [counts.run_files.read_table(file)[0] for file in counts.of_each_rank(self.counts, "series")]
        worked = [table["cpu"][-1] - table["cpu"][0] for table in tables]
        self.assertGreater(worked[0], 0.25)
        self.assertLess(worked[1], 0.1)
        self.assertEqual([table["sums"][-1] for table in tables], [7, 7])
        self.assertEqual([table["messages"][-1] for table in tables], [3, 0])

    def test_places_have_names(self):
        with open(self.counts / "places_0.csv") as file:
            rows = [line.strip().split(",") for line in file][1:]
        stacks = [(float(row[1]), float(row[2]), row[3].split()) for row in rows if row[0] == "Allreduce"]  # the compiler may have unrolled the loop
        frames = counts.resolved(self.program, sorted({address for _, _, stack in stacks for address in stack}))
        self.assertEqual([sum(row[i] for row in stacks) for i in (0, 1)], [5, 160])
        for _, _, stack in stacks:
            self.assertEqual(frames[stack[0]][0].function, "told")
            self.assertIn("main", [frame.function for address in stack for frame in frames[address]])


# What addr2line says of two addresses; the first one is of inlined code.
SAID = """0x00000000000001a0
dealii::sum(double)
/usr/include/deal.II/mpi.h:12
tanktread::NodeSpace::update<double>(double*) const
/home/build/../source/fluid/node_space.cc:179 (discriminator 2)
0x00000000000001b0
tanktread::LinearReport tanktread::solve_fgmres<tanktread::MonolithicOperator, tanktread::MonolithicPreconditioner>(int)
/home/include/tanktread/fluid/linear_solver.h:68
"""


class Places(unittest.TestCase):
    def test_what_addr2line_says(self):
        frames = counts.parsed(SAID)
        self.assertEqual([len(frames["0x1a0"]), len(frames["0x1b0"])], [2, 1])
        place = counts.Place("Isend", 3, 24, frames["0x1a0"] + frames["0x1b0"])
        self.assertEqual((place.where, place.group, place.in_solve, place.in_step, place.is_message), ("fluid/node_space.cc:179", "liquid", True, False, True))

    def test_groups(self):
        def group(*files):
            return counts.group([counts.Frame("", *(file.split("/") if file else (None, "")), "1") for file in files])
        self.assertEqual(group("fluid/node_space.cc", "fluid/stokes_operator.cc", "solver/monolithic_system.cc"), "liquid")
        self.assertEqual(group(None, "fluid/node_space.cc", "coupling/vertex_averages.cc", "solver/monolithic_system.cc"), "coupling")
        self.assertEqual(group("coupling/coupling.cc", "solver/time_level.cc"), "coupling")
        self.assertEqual(group("solver/shell_layout.cc", "fluid/linear_solver.h"), "shells")
        self.assertEqual(group("base/mpi_errors.cc", "solver/distributed_shell.cc"), "shells")
        self.assertEqual(group("fluid/krylov_basis.cc", "fluid/linear_solver.h", "solver/newton_solver.cc"), "Krylov")
        self.assertEqual(group("simulation/results.cc"), "rest")
        self.assertEqual(group(None, "base/mpi_errors.cc"), "rest")

    def test_sums_of_groups_and_the_largest(self):
        def place(kind, calls, bytes_, file, solve=True):
            layer, name = file.split("/")
            functions = ["x", "solve_fgmres<tanktread::MonolithicOperator>(" if solve else "y", "tanktread::Simulation::step()"]
            return counts.Place(kind, calls, bytes_, [counts.Frame(function, layer, name, "7") for function in functions])
        places = [place("Bcast", 4, 400, "solver/a.cc"), place("Bcast", 1, 100, "solver/a.cc"), place("Allreduce", 50, 50, "fluid/b.cc"), place("Isend", 2, 6, "fluid/c.cc"),
                  place("Allreduce", 8, 64, "coupling/d.cc", False)]
        self.assertEqual(counts.by_group(places, False, True)["shells"], [5, 500])
        self.assertEqual(counts.by_group(places, False, True)["coupling"], [0, 0])
        self.assertEqual(counts.by_group(places, False, False)["coupling"], [8, 64])
        self.assertEqual(counts.by_group(places, True, True)["liquid"], [2, 6])
        self.assertEqual(counts.largest(places, 1), [("Bcast", "solver/a.cc:7", "shells", 5, 500), ("Allreduce", "fluid/b.cc:7", "liquid", 50, 50)])


class Figures(unittest.TestCase):
    def test_a_step(self):
        """The start and the two first steps do not count, nor does what comes after the last row."""
        times = counts.times_of_rows(np.array([2., 5., 8., 9., 10.]), 110.)
        self.assertEqual(list(times), [102, 105, 108, 109, 110])
        self.assertAlmostEqual(counts.a_step(times, ([100, 102, 108, 110, 120], [0, 50, 60, 70, 700])), 5)

    def test_boxes_and_places(self):
        self.assertEqual([cases.bricks(n) for n in (1, 2, 4, 8, 16, 6)], [[1, 1, 1], [2, 1, 1], [2, 2, 1], [2, 2, 2], [4, 2, 2], [2, 3, 1]])
        for case in (cases.Case(1, 1), cases.Case(8, 2), cases.Case(16, 4, 0.2)):
            settings = cases.settings(case)
            sides = [float(side) for side in settings["Scene/Box side"].split(",")]
            self.assertAlmostEqual(case.capsules * 4 / 3 * math.pi / np.prod(sides), case.fraction, places=10)
            centres = np.array([[float(x) for x in centre.split(",")] for centre in settings["Capsule/Centres"].split(";")])
            self.assertEqual(len(centres), case.capsules)
            self.assertTrue((np.abs(centres[:, 2]) + 1.1 < 0.5 * sides[2]).all())
            gaps = [np.linalg.norm(a - b - sides * np.array([1, 1, 0]) * np.round((a - b) / sides)) for i, a in enumerate(centres) for b in centres[:i]]
            self.assertGreater(min(gaps, default=3), 2.3)

    def test_efficiency(self):
        row = {"series": "weak strong", "state": "done", "fraction": 0.1}
        weak = [{**row, "capsules": 2 * n, "ranks": n, "cpu_slowest": cpu} for n, cpu in ((1, 1.), (2, 1.25), (4, 2.))]
        self.assertEqual(report.efficiency(weak), [1, 0.8, 0.5])
        strong = [{**row, "capsules": 16, "ranks": n, "cpu_slowest": cpu} for n, cpu in ((1, 8.), (2, 5.), (4, 2.))]
        self.assertEqual(report.efficiency(strong), [1, 0.8, 1])


    def test_parts_of_messages(self):
        row = {f"{group}_sums": number for group, number in zip(counts.GROUPS, (1, 2, 3, 4, 0))} | {f"{group}_sum_bytes": number for group, number in zip(counts.GROUPS, (1e3, 2e3, 5e6, 0, 0))}
        self.assertEqual(report.amount(row, ["shells"], "sum", ""), "3, 5 MB")
        self.assertEqual(report.amount(row, ["rest"], "sum", ""), "0")
        self.assertEqual(report.amount(row, list(counts.GROUPS), "sum", ""), "10, 5 MB")
        self.assertEqual(report.of_shells(row, "sum", ""), "50 %, 100 %")


class Model(unittest.TestCase):
    def rows(self):
        law = [(n, p, 0.1 * n / p + 0.01 * n + 0.02) for n, p in ((1, 1), (2, 1), (8, 1), (16, 1), (2, 2), (4, 4), (8, 4), (16, 4))]
        return [{"state": "done", "fraction": 0.1, "places": 0, "capsules": n, "ranks": p, "linear": 8., "cells": 1400 * n, "cpu_slowest": cpu, "memory_largest": 150 + 20 * n / p + 3 * n, "messages": 100. * (p - 1),
                 "bytes": 1e6 * (n / p) ** (2 / 3), "sums": 50 + 9 * n + 3 * min(n, p), "sum_bytes": 1e5 * n + 500} for n, p, cpu in law]

    def test_laws_are_found(self):
        law = model.of_rows(self.rows(), 0.1)
        for found, wanted in ((law.work, (0.1, 0.01, 0.02)), (law.memory, (20, 3, 150)), (law.sums, (50, 9, 3)), (law.sum_bytes, (1e5, 500))):
            np.testing.assert_allclose(found, wanted, rtol=1e-6)
        self.assertAlmostEqual(law.a_neighbour, 100)
        self.assertAlmostEqual(law.surface, 1e6)
        parts = law.parts(800, 100, 1e-6, 1e9)
        wanted = {"divided work": 0.8, "work of all ranks": 8.02, "messages, latency": 2600e-6, "messages, bytes": 4e-3, "sums, latency": (50 + 7200 + 300) * 1e-6 * math.log2(100),
                  "sums, bytes": 2 * (8e7 + 500) / 1e9}
        self.assertEqual(parts.keys(), wanted.keys())
        for name, value in wanted.items():
            self.assertAlmostEqual(parts[name], value, places=6, msg=name)
        self.assertEqual(model.limit(parts), "work of all ranks")
        self.assertAlmostEqual(law.crossing_of_work(), 10)
        self.assertAlmostEqual(law.crossing_of_bytes(1e9), 500, places=4)
        crossing = law.crossing_of_latency(1e-6)
        self.assertAlmostEqual(9e-6 * crossing * math.log2(crossing), 0.1, places=6)
        self.assertEqual([value for name, value in law.parts(8, 1).items() if "work" not in name], [0, 0, 0, 0])

    def test_iterations_and_cells_are_not_taken_for_work_of_all_ranks(self):
        rows = self.rows()
        for i, row in enumerate(rows):
            factor = 1 + 0.2 * (i % 3)
            for name in ("linear", "cpu_slowest", "messages", "bytes", "sums", "sum_bytes"):
                row[name] *= factor
        dense = {**rows[-1], "fraction": 0.2, "cells": 2 * 1400 * 16, "linear": 8., "cpu_slowest": 0.1 * 16 * 2 / 4 + 0.01 * 16 + 0.02}
        law = model.of_rows([*rows, dense], 0.1)
        factor = law.iterations / 8
        np.testing.assert_allclose(law.work, factor * np.array([0.1, 0.01, 0.02]), rtol=1e-6)
        np.testing.assert_allclose(law.sums, factor * np.array([50, 9, 3]), rtol=1e-6)
        self.assertLess(law.error, 1e-6)

    def test_no_coefficient_is_negative(self):
        np.testing.assert_allclose(model.fit([[1, 1], [2, 1], [4, 1]], [1, 3, 7])[1], 0, atol=1e-12)

    def test_too_few_cases(self):
        self.assertIsNone(model.of_rows([row for row in self.rows() if row["ranks"] == 1], 0.1))
        self.assertIsNone(model.of_rows(self.rows(), 0.2))


class Agreement(unittest.TestCase):
    def test_differences(self):
        rows = [{"time": 0., "power": 2., "gap": math.inf, "theta": math.nan}, {"time": 1., "power": 4., "gap": 0.5, "theta": 0.1}]
        other = [dict(row) for row in rows]
        self.assertEqual(ranks_agree.largest_difference(rows, other), (0, None, None))
        other[1]["power"], other[1]["gap"] = 4.4, 0.52
        difference, column, row = ranks_agree.largest_difference(rows, other)
        self.assertAlmostEqual(difference, 0.4 / 4.4)
        self.assertEqual((column, row), ("power", 1))
        for changed in ({"theta": math.nan}, {"gap": math.inf}):
            self.assertEqual(ranks_agree.largest_difference(rows, [rows[0], {**rows[1], **changed}])[0], math.inf)
        self.assertEqual(ranks_agree.largest_difference(rows, rows[:1])[0], math.inf)
        self.assertEqual(ranks_agree.largest_difference(rows, [{**row, "new": 0.} for row in rows])[0], math.inf)


class Calls(unittest.TestCase):
    """A copy of benchmarks/ and doc/, and a stand-in for the program."""

    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.root = pathlib.Path(folder.name)
        for name in ("benchmarks", "doc"):
            shutil.copytree(ROOT / name, self.root / name, ignore=shutil.ignore_patterns("__pycache__"))
        self.program = self.root / "program"
        self.program.write_text(f'#!/bin/sh\nunset LD_PRELOAD\nexec "{sys.executable}" "{HERE / "fake_program.py"}" "$@"\n')
        self.program.chmod(0o755)

    def call(self, *words):
        command = [sys.executable, self.root / "benchmarks/scaling/run.py", *words, "--program", self.program, "--launcher", "env FAKE_RANKS={ranks}"]
        result = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, cwd=self.root)
        return result.returncode, result.stdout

    def doc(self):
        return {str(file.relative_to(self.root)): file.read_bytes() for part in ("doc", "benchmarks") for file in (self.root / part).rglob("*") if file.is_file() and "__pycache__" not in str(file)}

    def test_page_and_doc(self):
        before = self.doc()
        self.assertEqual(self.call("proportion", "weak", "strong", "memory")[0], 0)
        self.assertEqual(self.doc(), before)
        page = (self.root / "output/scaling/scaling.md").read_text()
        self.assertIn("| 8 | 11200 | 0.88 | 0.11 | 1.00 | 2.0, 8.0 | 14 | 280 | 35 |", page)
        self.assertIn("| 4 | 8 | 11200 | 0.28 | 0.28 | 79 % | ", page)  # (0.2 + 0.02) / (0.2 + 0.08)
        self.assertIn("100 ms × N/P + 10 ms × N + 0 ms", page)
        code, said = self.call("--draw", "--update-doc")
        self.assertEqual(code, 0, said)
        after = self.doc()
        self.assertEqual({name for name in {*before, *after} if before.get(name) != after.get(name)} - {"benchmarks/scaling/places.csv"},
                         {"doc/scaling.md", "doc/figures/scaling.png", "benchmarks/scaling/points.csv"})

    def test_bad_words_and_runs_that_fail(self):
        self.assertIn("no such series: wek; there are proportion", self.call("wek")[1])
        self.assertIn("--fraction 0.4; allowed", self.call("--fraction", "0.4")[1])
        self.program.write_text("#!/bin/sh\necho tanktread: FAILED here; exit 2\n")
        code, said = self.call("proportion")
        self.assertEqual(code, 0, said)
        self.assertIn("Runs that failed: 1_capsules_10_percent_1_ranks_8_steps: tanktread: FAILED here;", (self.root / "output/scaling/scaling.md").read_text())


if __name__ == "__main__":
    unittest.main()
