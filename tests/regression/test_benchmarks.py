#!/usr/bin/env python3
# SPDX-License-Identifier: LGPL-2.1-or-later
# Part of Tanktread: tests of the scripts of benchmarks/, in a copy of the repository and with a stand-in for the program.
"""What a user's call changes and what it leaves, what is said where Python lacks a package, and the figures of runs."""

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

import numpy as np  # noqa: E402

import run_files  # noqa: E402
import run_scenes  # noqa: E402

SCRIPTS = ["plot_run.py", "interface_study.py", "le_2010/run.py"]


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
        said = self.run_scenes("fig04", "fig06/G0.005_k0", "--update-doc")
        self.assertIn("fig06: stays as it is", said)
        after = self.doc()
        changed = {name for name in {*before, *after} if before.get(name) != after.get(name)}
        self.assertEqual(changed, {"doc/le_2010.md", "doc/figures/le_2010/fig04.png"})
        old, new = (set(doc["doc/le_2010.md"].decode().splitlines()) for doc in (before, after))
        self.assertTrue(any("G0.05_k0.0375, quick" in line for line in new - old))
        others = [line for line in old - new if not line.startswith(("| G0.05_k", "| 4 |"))]
        self.assertEqual(others, [], "lines of other figures")

    def test_resume_and_draw_compute_nothing(self):
        self.run_scenes("fig04")
        record = self.root / "output/le_2010/quick/fig04/G0.05_k0/run.json"
        before = record.stat().st_mtime_ns
        self.assertIn("finished before: 4 of 4", self.run_scenes("fig04", "--resume"))
        self.run_scenes("--draw")
        self.assertEqual(record.stat().st_mtime_ns, before)

    def test_a_run_that_fails_is_reported_and_does_not_stop_the_others(self):
        self.program.write_text(self.program.read_text().replace("exec", 'case "$1" in *k0.01.prm) echo "tanktread: FAILED here"; exit 2;; esac\nexec'))
        self.run_scenes("fig04")
        report = (self.root / "output/le_2010/report.md").read_text()
        self.assertIn("| G0.05_k0.01 | failed: tanktread: FAILED here |", report)
        self.assertIn("G0.05_k0.025, quick", report)


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


class Cores(unittest.TestCase):
    def test_all_are_used(self):
        division = run_scenes.division_of_cores
        self.assertEqual(division(40, 2), (2, 1))
        self.assertEqual(division(1, 2), (1, 2))
        self.assertEqual(division(3, 16), (4, 4))
        self.assertEqual(division(8, 16), (8, 2))
        self.assertEqual(division(40, 8, ranks=2), (4, 2))
        self.assertEqual(division(40, 8, jobs=1), (1, 4))
        self.assertEqual(division(0, 1), (1, 1))


class Files(unittest.TestCase):
    def test_cubics_are_met(self):
        times = np.array([0, 0.1, 0.3, 0.4, 0.8, 1.0, 1.1])
        cubic = lambda t: 1 - 2 * t + 3 * t**2 - 4 * t**3  # noqa: E731
        wanted = np.linspace(0, 1.1, 23)
        np.testing.assert_allclose(run_files.interpolated(times, cubic(times), wanted), cubic(wanted), rtol=0, atol=1e-13)
        values = cubic(times)
        values[0] = np.nan
        self.assertTrue(np.isnan(run_files.interpolated(times, values, 0.05)))
        self.assertAlmostEqual(run_files.interpolated(times, values, 0.2), cubic(0.2), places=12)
        self.assertTrue(np.isnan(run_files.interpolated(times, values, 1.2)))

    def test_references_are_those_of_the_scene(self):
        pair = {"Scene/Shear number G": "0.45", "Scene/Scale modulus": "shear", "Capsule/Prestress": "0.05", "Capsule/Centres": "-4, 0, 0.25; 4, 0, -0.25", "Scene/Reduced bending modulus": "0"}
        names = lambda parameters: [file.name for file in run_files.find_references(parameters)]  # noqa: E731
        self.assertEqual(names(pair), ["crossing_pair_Ca0.45_prestress0.05.csv"])
        for name, value in (("Capsule/Centres", "0, 0, 0"), ("Capsule/Prestress", "0"), ("Scene/Scale modulus", "Young"), ("Scene/Reynolds number", "1")):
            self.assertEqual(names({**pair, name: value}), [], name)
        single = {"Scene/Shear number G": "0.2", "Scene/Reduced bending modulus": "0.04"}
        self.assertEqual(names(single), ["sphere_G0.2_k0.04_variational.csv"])
        for name, value in (("Capsule/Centres", "0, 0, 1"), ("Scene/Scale modulus", "shear"), ("Scene/Flow", "quiescent"), ("Capsule/Thickness", "0.1")):
            self.assertEqual(names({**single, name: value}), [], name)


if __name__ == "__main__":
    unittest.main()
