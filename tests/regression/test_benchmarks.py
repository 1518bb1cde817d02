#!/usr/bin/env python3
# SPDX-License-Identifier: LGPL-2.1-or-later
# Part of Tanktread: tests of the scripts of benchmarks/, in a copy of the repository and with a stand-in for the program.
"""What a user's call changes and what it leaves, what is said where Python lacks a package, and the figures of runs."""

import csv
import json
import math
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile
import unittest

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parents[1]
sys.path.insert(0, str(ROOT / "benchmarks"))
import python_packages  # noqa: E402

python_packages.need("numpy", "matplotlib")

SCRIPTS = ["plot_run.py", "plot_study.py", "interface_study.py", "box_study.py", "economy.py", "le_2010/run.py", "flows/run.py", "suspensions/run.py", "work_precision/run.py", "stability/run.py", "scaling/run.py"]


class Repository(unittest.TestCase):
    """A copy of benchmarks/ and doc/."""

    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.root = pathlib.Path(folder.name)
        for name in ("benchmarks", "doc"):
            shutil.copytree(ROOT / name, self.root / name, ignore=shutil.ignore_patterns("__pycache__"))
        self.program = self.root / "program"
        self.program.write_text(f'#!/bin/sh\nexec "{sys.executable}" "{HERE / "fake_program.py"}" "$@"\n')
        self.program.chmod(0o755)

    def call(self, script, *words, python=(), **environment):
        command = [*python, self.root / "benchmarks" / script, *words]
        result = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, env={**os.environ, **environment}, cwd=self.root)
        return result.returncode, result.stdout

    def passes(self, script, *words, python=(sys.executable,)):
        code, said = self.call(script, *words, python=python)
        self.assertEqual(code, 0, said)
        return said

    def doc(self):
        return {str(file.relative_to(self.root)): file.read_bytes() for file in (self.root / "doc").rglob("*") if file.is_file()}


class Le2010(Repository):
    def run_scenes(self, *words, **options):
        return self.passes("le_2010/run.py", *words, "--program", str(self.program), "--ranks", "1", **options)

    def test_results_go_to_output_and_doc_stays(self):
        before = self.doc()
        self.run_scenes("fig04", python=())  # by its run bit
        self.assertEqual(self.doc(), before)
        output = self.root / "output/le_2010"
        report = (output / "report.md").read_text()
        self.assertIn("## Fig. 4", report)
        self.assertNotIn("## Fig. 5", report)
        self.assertIn("D falls", report.replace("does not always fall", "D falls"))
        self.assertEqual([file.name for file in (output / "figures").iterdir()], ["fig04.png"])
        self.assertTrue((output / "quick/fig04/G0.05_k0/run.json").is_file())

    def test_doc_changes_where_it_was_asked_to(self):
        before = self.doc()
        said = self.run_scenes("fig04", "fig06/G0.005_k0", "--full", "--update-doc")
        self.assertIn("fig06: stays as it is in doc/, not all of its runs are there", said)
        after = self.doc()
        changed = {name for name in {*before, *after} if before.get(name) != after.get(name)}
        self.assertEqual(changed, {"doc/le_2010.md", "doc/figures/le_2010/fig04.png"})
        old, new = (doc["doc/le_2010.md"].decode().split("\n## ") for doc in (before, after))
        different = [(a, b) for a, b in zip(old, new) if a != b]
        self.assertEqual([b[:6] for _, b in different], ["Fig. 4", "What t"])
        self.assertIn("| G0.05_k0.0375, full | steady, last values at 10 | 0.30009 ± 0.00030 |", different[0][1])  # 0.3 (1 + 1e-3/3)
        statements = set(different[1][0].splitlines()) - set(different[1][1].splitlines())
        self.assertEqual([line for line in statements if not line.startswith(("| 4 |", "| all |"))], [], "statements on other figures")
        shutil.rmtree(self.root / "output")
        said = self.run_scenes("fig04", "--quick", "--update-doc")
        self.assertIn("fig04: stays as it is in doc/, which has G0.05_k0, G0.05_k0.01, G0.05_k0.025, G0.05_k0.0375 at a finer resolution", said)
        self.assertEqual(self.doc(), after)

    def test_error_bars_and_differences_from_the_reference(self):
        self.run_scenes("fig04", "--fair")
        report = (self.root / "output/le_2010/report.md").read_text()
        wanted = 0.194632  # of the reference, from which the stand-in's 0.3 (1 + 1e-3)(1 - exp(-10)) is far
        value, bar = 0.3003 * (1 - math.exp(-10)), 9e-4
        self.assertIn(f"| G0.05_k0, fair | steady, last values at 10 | {value:.5f} ± {bar:.5f} ({100 * (value / wanted - 1):+.2f} %) |", report)
        self.assertIn("| G0.05_k0.025, fair | steady, last values at 10 | 0.30029 ± 0.00090 | ", report)  # without a reference
        self.assertIn("\n0 of the 4 differences in brackets that stand beside an error bar are within it.\n", report)
        said = self.passes("error_bars.py", "--missed")  # the curves of two scenes have a reference
        self.assertIn("| 3e-3, λ = 5: curves | 0 of 4 | ", said)
        self.assertIn("\n3e-3 sphere_G0.05_k0_lambda5 D_curve: bar 0.0009, error 0.1", said)
        settings = json.loads((self.root / "output/le_2010/fair/fig04/G0.05_k0/run.json").read_text())["settings"]
        self.assertEqual(settings, {"Accuracy/Target error": "3e-3", "Study/Vary": "target, stop"})

    def test_a_study_is_computed_anew_or_goes_on(self):
        self.run_scenes("fig04/G0.05_k0")
        folder = self.root / "output/le_2010/quick/fig04/G0.05_k0"
        record = json.loads((folder / "run.json").read_text())
        self.assertIn("cpu_seconds", record)
        (folder / "left").touch()
        self.run_scenes("fig04/G0.05_k0")
        self.assertFalse((folder / "left").exists())
        (folder / "left").touch()
        (folder / "run.json").unlink()  # as if it had been interrupted
        self.run_scenes("fig04/G0.05_k0", "--resume")
        self.assertTrue((folder / "left").exists())
        self.assertNotIn("cpu_seconds", json.loads((folder / "run.json").read_text()))

    def test_resume_and_draw_compute_nothing(self):
        self.run_scenes("fig04")
        record = self.root / "output/le_2010/quick/fig04/G0.05_k0/run.json"
        before = record.stat().st_mtime_ns
        self.assertIn("finished before: 4 of 4", self.run_scenes("fig04", "--resume"))
        self.run_scenes("--draw")
        self.assertEqual(record.stat().st_mtime_ns, before)

    def test_a_part_of_a_figure_is_drawn(self):
        self.assertNotIn("No artists", self.run_scenes("fig03/G0.05_k0"))
        self.assertTrue((self.root / "output/le_2010/figures/fig03.png").is_file())

    def test_a_run_that_fails_is_reported_and_does_not_stop_the_others(self):
        self.program.write_text(self.program.read_text().replace("exec", 'case "$1" in *k0.01.prm) echo "tanktread: FAILED here"; exit 2;; esac\nexec'))
        self.run_scenes("fig04")
        report = (self.root / "output/le_2010/report.md").read_text()
        self.assertIn("| G0.05_k0.01 | failed: tanktread: FAILED here |", report)
        self.assertIn("G0.05_k0.025, quick", report)


class Flows(Repository):
    """The stand-in's D is larger by (4/side)^3, everything else is the reference's. The page is begun from nothing."""

    def setUp(self):
        super().setUp()
        (self.root / "doc/flows.md").unlink(missing_ok=True)

    def run_scenes(self, *words):
        return self.passes("flows/run.py", *words, "--program", str(self.program), "--ranks", "1")

    def rows(self, report, scene):
        """{first cell: others} of all tables of a scene."""
        text = report.read_text().split(f"## {scene}\n")[1].split("\n## ")[0]
        rows = [line.strip("| ").split(" | ") for line in text.splitlines() if line.startswith("| ") and not line.startswith("|  |")]
        return {cells[0]: cells[1:] for cells in rows}

    def test_comparison_with_the_references(self):
        before = self.doc()
        for resolution in ("--quick", "--wide"):
            self.run_scenes(resolution)
        self.assertEqual(self.doc(), before)
        report = self.root / "output/flows/report.md"
        same, near, nearer = "(+0.00 %)", "(+0.80 %)", "(+0.10 %)"
        ends = {"Planar extension": ("D at 8", near, nearer), "Above a wall": ("D at 30", near, nearer), "Plane Poiseuille flow": ("D at 30", near, nearer),
                "A pair passing in shear": ("D at 32", nearer, "(+0.01 %)")}  # whose boxes are twice as large
        for scene, (at, at_quick, at_wide) in ends.items():
            reference, quick, wide = self.rows(report, scene)[at]
            self.assertIn(at_quick, quick, scene)
            self.assertIn(at_wide, wide, scene)
        wall = self.rows(report, "Above a wall")
        self.assertEqual(wall["z − z₀ at 30"], ["0.69491", f"0.69491 {same}", f"0.69491 {same}"])
        self.assertEqual(wall["u_x at 10"], ["2.2056", f"2.2056 {same}", f"2.2056 {same}"])
        self.assertEqual(self.rows(report, "Plane Poiseuille flow")["z − z₀ at 10"], ["-0.037475", f"-0.037475 {same}", f"-0.037475 {same}"])
        self.assertEqual(self.rows(report, "A pair passing in shear")["largest offset"][:3], ["0.720", "0.72513", f"0.72513 {same}"])
        self.assertEqual(self.rows(report, "A pair passing in shear")["smallest gap"][:3], ["–", "0.34215", f"0.34215 {same}"])
        self.assertEqual(len(list((self.root / "output/flows/figures").glob("*.png"))), 5)

    def test_doc_changes_where_it_was_asked_to(self):
        self.run_scenes("wall", "--wide", "--update-doc")
        text = (self.root / "doc/flows.md").read_text()
        self.assertIn("## Above a wall", text)
        self.assertNotIn("## Planar extension", text)
        shutil.rmtree(self.root / "output")
        said = self.run_scenes("wall", "planar_extension", "--quick", "--update-doc")
        self.assertIn("wall: stays as it is in doc/, which has it at wide", said)
        report = self.root / "doc/flows.md"
        self.assertIn("## Planar extension", report.read_text())
        self.assertEqual(report.read_text().split("## Above a wall")[1], text.split("## Above a wall")[1])

    def test_scenes_without_walls_in_unbounded_liquid(self):
        self.run_scenes("--unbounded")
        folder = self.root / "output/flows/unbounded"
        self.assertEqual({run.name for run in folder.iterdir()}, {"crossing_pair", "planar_extension", "uniaxial_extension", "parabola"})
        for run, side in (("planar_extension", "7.5"), ("crossing_pair", "30, 7.5, 7.5")):
            settings = json.loads((folder / run / "run.json").read_text())["settings"]
            self.assertEqual((settings["Scene/Boundary"], settings["Scene/Box side"]), ("unbounded", side))
        code, said = self.call("flows/run.py", "wall", "--unbounded", python=(sys.executable,))
        self.assertEqual(code, 2)
        self.assertIn("wall has walls", said)

    def test_what_is_left_of_a_failed_run_is_reported(self):
        self.program.write_text(self.program.read_text().replace("exec", 'echo "tanktread: FAILED early"; exit 2\nexec'))
        self.assertIn("wall: exit code 2: tanktread: FAILED early", self.run_scenes("wall"))
        self.assertIn("No results: quick: tanktread: FAILED early.", (self.root / "output/flows/report.md").read_text())

    def test_plots_of_several_capsules(self):
        self.run_scenes("crossing_pair")
        folder = self.root / "output/flows/quick/crossing_pair"
        said = self.passes("plot_run.py", folder)
        self.assertEqual({file.stem for file in folder.glob("*.png")}, {"deformation", "trajectory", "convergence", "contour", "suspension"})
        self.assertIn("difference +0.100 %", said)
        self.assertIn("deformation.png: 2 capsule(s)", said)
        self.assertIn("contour.png: 2 capsule(s)", said)


class WorkPrecision(Repository):
    """The stand-in's D is larger by a tenth of the square of the cell, everything else is right."""

    def run_biconcave(self, *words):
        (self.root / "tanktread").write_text(self.program.read_text())
        (self.root / "tanktread").chmod(0o755)
        return self.passes("work_precision/run.py", "--build", str(self.root), "--quick", "--scenes", "biconcave", *words)

    def points(self, file="output/work_precision/points.csv"):
        lines = [line for line in (self.root / file).read_text().splitlines() if not line.startswith("#")]
        return list(csv.DictReader(lines))

    def test_errors_of_the_stand_in_are_found(self):
        before = self.doc()
        self.run_biconcave()
        self.assertEqual(self.doc(), before)
        rows = self.points()
        for row in rows:
            cell = float(dict(setting.split("=") for setting in row["settings"].split("; "))["Fluid mesh/Finest cell"])
            for quantity, error in (("D", 0.1 * cell**2), ("viscosity", 0.1 * cell**2), ("theta", 0)):
                self.assertAlmostEqual(float(row[f"error_{quantity}"]), error, delta=1e-4 * error + 1e-8, msg=row["run"])
        cells = [row for row in rows if row["cause"] == "cells"]
        self.assertEqual([row["run"] for row in cells], ["h16_l2_dt0.1", "h32_l2_dt0.1", "h64_l2_dt0.1"])
        self.assertIn("backward Euler", {row["cause"] for row in rows})
        page = (self.root / "output/work_precision/work_precision.md").read_text()
        self.assertIn("| biconcave | cells | 0.625 … 0.156 | 3.9 % … 0.24 % | 1.99 | 2 |", page)
        self.assertTrue((self.root / "output/work_precision/work_precision.png").is_file())

    def test_nothing_is_computed_twice_and_doc_changes_where_it_was_asked_to(self):
        self.assertIn("h32_l2_dt0.1 biconcave: done", self.run_biconcave())
        record = self.root / "output/work_precision/h32_l2_dt0.1/biconcave/run.json"
        before, doc = record.stat().st_mtime_ns, self.doc()
        self.assertNotIn("biconcave: done", self.run_biconcave("--doc"))
        self.assertEqual(record.stat().st_mtime_ns, before)
        changed = {name for name, content in self.doc().items() if doc.get(name) != content}
        self.assertEqual(changed, {"doc/work_precision.md", "doc/figures/work_precision.png"})
        self.assertEqual(self.points(), self.points("benchmarks/work_precision/points.csv"))
        shutil.rmtree(self.root / "output")
        self.run_biconcave("--draw")
        self.assertIn("## Cheapest", (self.root / "output/work_precision/work_precision.md").read_text())


class Economy(Repository):
    def measure(self, *words):
        return self.passes("economy.py", "--program", str(self.program), "--cells", "16", "--savings", "lambda,limit", *words)

    def report(self):
        return (self.root / "output/economy/economy.md").read_text()

    def test_runs_in_turn_and_their_differences(self):
        said = self.measure("--repeat", "2")
        self.assertEqual([line.split(":")[0] for line in said.splitlines()[:-1]],
                         ["lambda_16/with", "lambda_16/without"] * 2 + ["limit_16/with", "limit_16/without"] * 2)
        report = self.report()
        row = next(line.strip("| ").split(" | ") for line in report.splitlines() if line.startswith("| one viscosity"))
        self.assertEqual(row[6:8], ["0", "0"])  # the stand-in always gives the same
        self.assertIn("| 40 / 40 |", report)
        limit = next(line.strip("| ").split(" | ") for line in report.splitlines() if line.startswith("| stop when the limit"))
        self.assertEqual(limit[6], "–")  # it knows no limit
        parameters = [(self.root / f"output/economy/lambda_16/{kind}/economy.json").read_text() for kind in ("with", "without")]
        self.assertIn('"Scene/Viscosity ratio": "1"', parameters[0])
        self.assertIn('"Scene/Viscosity ratio": "1.000000001"', parameters[1])

    def test_what_is_there_is_not_measured_again(self):
        self.measure()
        self.assertEqual(len(self.measure().splitlines()), 1)
        self.assertEqual(len(self.measure("--repeat", "2").splitlines()), 5)
        prm = self.root / "benchmarks/economy.prm"
        prm.write_text(prm.read_text().replace("= 0.2", "= 0.1"))
        self.assertEqual(len(self.measure().splitlines()), 5)

    def test_doc_changes_where_it_was_asked_to(self):
        before = self.doc()
        self.measure()
        self.assertEqual(self.doc(), before)
        self.measure("--report", "--update-doc")
        self.assertEqual(self.doc(), {**before, "doc/economy.md": self.report().encode()})

    def test_a_run_that_fails_is_reported(self):
        self.program.write_text("#!/bin/sh\nexit 2\n")
        self.assertIn("exit code 2", self.measure())
        self.assertIn("| exit code 2 | exit code 2 | – |", self.report())


class Packages(Repository):
    def test_another_python_is_found(self):
        code, said = self.call("le_2010/run.py", "--help", python=(sys.executable, "-S"))  # without the installed packages
        self.assertEqual(code, 0, said)
        self.assertIn("--update-doc", said)

    def test_one_line_where_there_is_none(self):
        folder = self.root / "without"  # comes before the installed packages of every Python
        folder.mkdir()
        for package in ("numpy", "matplotlib"):
            (folder / f"{package}.py").write_text("raise ImportError")
        for script in SCRIPTS:
            code, said = self.call(script, python=(sys.executable,), PYTHONPATH=str(folder))
            self.assertEqual(code, 1, said)
            self.assertEqual(len(said.splitlines()), 1, said)
            self.assertIn(f"{pathlib.Path(script).name}: ", said)
            self.assertIn("install python3-numpy python3-matplotlib (Debian)", said)


if __name__ == "__main__":
    unittest.main()
