#!/usr/bin/env python3
# SPDX-License-Identifier: LGPL-2.1-or-later
# Part of Tanktread: tests of the scripts that check runs: what they must not let pass.
"""Feeds check_run.py, run_regression.py and expect.py what a broken program would leave."""

import argparse
import os
import pathlib
import subprocess
import sys
import tempfile
import unittest

import check_run
import run_regression

HERE = pathlib.Path(__file__).resolve().parent
GOOD = ["0,1e-17,nan,2,0", "0.5,0.1,0.2,2.0001,1e-12", "1,0.2,0.19,2.0002,-1e-12"]


class Folder(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def history(self, rows):
        (self.folder / "history.csv").write_text("\n".join(["time,D_xz,theta,area,volume_error", *rows]) + "\n")
        return self.folder / "history.csv"


class CheckRun(Folder):
    def failures(self, rows, **options):
        self.history(rows)
        args = {"output": self.folder, "volume_error": 1e-8, "time": 1, "steps": None, "keeps": [], "varies": [], "contours": None, "expect": []}
        return list(check_run.failures_of_history(argparse.Namespace(**{**args, **options})))

    def test_good_rows_pass(self):
        self.assertEqual(self.failures(GOOD, keeps=["area=1e-3"], varies=["D_xz"], expect=["D_xz=0.2,0.01"]), [])

    def test_numbers_that_are_wrong(self):
        self.assertTrue(self.failures([*GOOD[:2], "1,0.2,0.19,2,2e-8"]))
        self.assertTrue(self.failures(GOOD, time=1.1))
        self.assertTrue(self.failures(GOOD, steps=3))
        self.assertEqual(self.failures(GOOD, steps=2), [])
        self.assertTrue(self.failures(GOOD, keeps=["area=1e-5"]))
        self.assertTrue(self.failures([GOOD[1]] * 3, time=0.5, varies=["D_xz"]))
        self.assertTrue(self.failures(GOOD, expect=["D_xz=0.21,0.01"]))

    def test_what_is_not_a_number_fails_in_any_row(self):
        for row in range(3):
            def with_nan(column):
                rows = [line.split(",") for line in GOOD]
                rows[row][column] = "nan"
                return [",".join(line) for line in rows]
            self.assertTrue(self.failures(with_nan(4)), f"volume error in row {row}")
            self.assertTrue(self.failures(with_nan(3), keeps=["area=1e-3"]), f"area in row {row}")
            self.assertTrue(self.failures(with_nan(1), varies=["D_xz"]), f"D in row {row}")
        self.assertTrue(self.failures([*GOOD[:2], "nan,0.2,0.19,2,0"]), "time")
        self.assertTrue(self.failures([*GOOD[:2], "1,nan,0.19,2,0"], expect=["D_xz=0.2,0.01"]), "expected value")


class RunRegression(Folder):
    def selected(self, rows, names=("time", "D_xz", "theta", "area")):
        run_regression.select_columns(self.history(rows), list(names), self.folder / "compared.csv")
        return (self.folder / "compared.csv").read_text().splitlines()

    def test_columns_are_selected(self):
        self.assertEqual(self.selected(GOOD), ["time,D_xz,theta,area", "0,1e-17,nan,2", "0.5,0.1,0.2,2.0001", "1,0.2,0.19,2.0002"])

    def test_two_runs_that_are_equally_wrong_do_not_agree(self):
        for row in ("1,0.2,0.19,nan,0", "1,nan,0.19,2,0", "1,0.2,nan,2,0"):
            with self.assertRaises(SystemExit, msg=row):
                self.selected([*GOOD, row])

    def test_no_rows_and_no_column(self):
        for rows, names in (([], ("time",)), (GOOD, ("time", "wrong"))):
            with self.assertRaises(SystemExit):
                self.selected(rows, names)


class Scripts(unittest.TestCase):
    def test_what_names_its_interpreter_can_be_started(self):
        root = HERE.parents[1]
        scripts = [file for folder in ("benchmarks", "tests") for file in (root / folder).rglob("*.py") if file.read_text().startswith("#!")]
        self.assertGreater(len(scripts), 10)
        self.assertEqual([str(file) for file in scripts if not os.access(file, os.X_OK)], [])


class Expect(unittest.TestCase):
    def code(self, exit_code, expression, script):
        command = [sys.executable, str(HERE / "expect.py"), exit_code, expression, sys.executable, "-c", script]
        return subprocess.run(command, stdout=subprocess.DEVNULL).returncode

    def test_exit_code_and_words(self):
        script = "import sys; print('one'); sys.stderr.write('two\\n'); sys.exit(2)"
        self.assertEqual(self.code("2", "^two$", script), 0)
        self.assertEqual(self.code("0", "^two$", script), 1)
        self.assertEqual(self.code("2", "^three$", script), 1)


if __name__ == "__main__":
    unittest.main()
