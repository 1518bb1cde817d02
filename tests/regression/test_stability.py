#!/usr/bin/env python3
# SPDX-License-Identifier: LGPL-2.1-or-later
# Part of Tanktread: tests of how benchmarks/stability judges runs.
"""Folders like those of runs, and what is said of them."""

import json
import pathlib
import shutil
import sys
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path[:0] = [str(ROOT / "benchmarks"), str(ROOT / "benchmarks/stability")]
import python_packages  # noqa: E402

python_packages.need("numpy", "matplotlib")

import run_table  # noqa: E402

import maps  # noqa: E402
import outcomes  # noqa: E402

NAMES = "time,D_xz,L,B,W,volume,area,membrane_energy,bending_energy,volume_error,detail_ratio,newton_iterations,linear_iterations,wall_time".split(",")
WARNED = "WARNED from time 0.5 on: worst_gap came to 0.1 at time 1 (threshold 0.5).\n"
HALVED = "Step of length 1 failed from the extrapolated state: no\nStep of length 1 failed from the last state: no\nStep of length 1.000000 halved.\nStep of length 0.500000 rejected: outside.\nStep of length 0.500000 halved.\nStep of length 0.25 repeated: its local error\n"
SHEAR, REST = (next(map_ for map_ in maps.MAPS if map_.name == name) for name in ("viscosity_ratio", "schemes_relaxation"))


class Outcomes(unittest.TestCase):
    def setUp(self):
        self.folder, self.before = pathlib.Path(tempfile.mkdtemp()), outcomes.OUTPUT
        outcomes.OUTPUT = self.folder

    def tearDown(self):
        outcomes.OUTPUT = self.before
        shutil.rmtree(self.folder)

    def judge(self, map_=SHEAR, column=0, code=0, message="", log="", D=(0.0, 0.3), energy=(1.0, 0.9), wall=10, row=0):
        """What is said of a run with these rows."""
        cell = maps.Cell(map_, map_.rows[row], map_.columns[column])
        run = outcomes.run_of(cell)
        folder = run.folder(maps.name(cell))
        folder.mkdir(parents=True, exist_ok=True)
        lines = [",".join(NAMES)] + [",".join(map(str, [i, value, 1, 1, 1, 4, 12, e, 0, 1e-6, 0.3, 2 * i, 8 * i, wall])) for i, (value, e) in enumerate(zip(D, energy))]
        (folder / "history.csv").write_text("\n".join(lines) + "\n")
        (folder / "log.txt").write_text(log)
        (folder / "run.json").write_text(json.dumps({"input": run.key(maps.settings(cell)), "exit_code": code, "message": message, "seconds": 12, "cpu_seconds": 11}))
        return cell, outcomes.row_of(cell, outcomes.record_of(cell))

    def outcome(self, **how):
        return self.judge(**how)[1]["outcome"]

    def test_runs_that_are_done(self):
        self.assertEqual(self.outcome(), "holds")
        self.assertEqual(self.outcome(log=WARNED), "warned")
        self.assertEqual(self.outcome(D=(0.0, float("nan"))), "nan")
        self.assertEqual(self.judge(log="WARNING: what the file sets is too coarse for Accuracy/Target error: cells, ...\n")[1]["warnings"], "too_coarse")
        row = self.judge(log=HALVED + WARNED)[1]
        self.assertEqual((row["outcome"], row["halved"], row["repeated"], row["warnings"]), ("halves", 2, 1, "gap"))
        self.assertEqual((row["newton_a_step"], row["linear_a_step"], row["cpu_a_unit"]), (2, 8, 11))

    def test_runs_that_are_not(self):
        self.assertEqual(self.outcome(code=1, message="got 3; allowed: 4"), "refused")
        row = self.judge(code=2, log="FAILED at time 0.500000: no step\n")[1]
        self.assertEqual((row["outcome"], row["message"]), ("ends", "at time 0.500000: no step"))
        self.assertEqual(self.outcome(code=2, message="terminate called"), "crash")
        self.assertEqual(self.outcome(code=-11), "crash")
        self.assertEqual(self.outcome(code=-24), "limit")
        self.assertEqual(self.outcome(code=-24, wall=1), "hang")

    def test_energy_has_to_fall_at_rest_only(self):
        self.assertEqual(self.outcome(energy=(1.0, 1.1)), "holds")
        self.assertEqual(self.outcome(map_=REST, energy=(1.0, 1.1)), "wrong")
        self.assertEqual(self.outcome(map_=REST, energy=(1.0, 1.1), log=WARNED), "warned")
        self.assertEqual(self.outcome(map_=REST, energy=(1.0, 1.0 - 1e-9)), "holds")

    def test_what_is_off_without_a_warning_is_wrong(self):
        pairs = [self.judge(column=column, D=(0.0, D), log=log) for column, (D, log) in enumerate([(0.24, WARNED), (0.24, ""), (0.3, "")])]
        outcomes.compare(*zip(*pairs))
        self.assertEqual([row["outcome"] for _, row in pairs], ["warned", "wrong", "holds"])
        self.assertAlmostEqual(pairs[1][1]["error_D"], 0.2)
        self.assertNotIn("error_D", pairs[2][1])

    def test_what_is_compared_with_has_finished(self):
        pairs = [self.judge(column=0, D=(0.0, 0.2)), self.judge(column=1, D=(0.0, 0.25)), self.judge(column=2, D=(0.0, 0.1), code=2, log="FAILED at time 1: no\n")]
        outcomes.compare(*zip(*pairs))
        self.assertAlmostEqual(pairs[0][1]["error_D"], 0.2)
        self.assertNotIn("error_D", pairs[2][1])

    def test_the_table_is_read_as_it_was_written(self):
        row = self.judge(log=WARNED)[1]
        outcomes.write(self.folder / "table.csv", {"mode": "quick: yes"}, [row])
        notes, (found,) = run_table.read(self.folder / "table.csv", outcomes.NUMBERS)
        self.assertEqual(notes, {"mode": "quick: yes"})
        self.assertEqual([found[key] for key in ("outcome", "warnings", "halved", "D")], ["warned", "gap", 0, 0.3])
        self.assertTrue(found["error_D"] != found["error_D"])


class Maps(unittest.TestCase):
    def test_every_run_has_a_folder_of_its_own(self):
        names = [maps.name(cell) for map_ in maps.MAPS for cell in maps.cells_of(map_, False)]
        self.assertEqual(len(names), len(set(names)))

    def test_quick_leaves_out_and_adds_nothing(self):
        for map_ in maps.MAPS:
            self.assertLessEqual(set(map(maps.name, maps.cells_of(map_, True))), set(map(maps.name, maps.cells_of(map_, False))))


if __name__ == "__main__":
    unittest.main()
