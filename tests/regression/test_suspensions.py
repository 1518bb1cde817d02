#!/usr/bin/env python3
# SPDX-License-Identifier: LGPL-2.1-or-later
# Part of Tanktread: tests of averages over time, of the boxes of suspensions, and of benchmarks/suspensions with a stand-in for the program.
"""Series whose means and errors are known."""

import math
import pathlib
import sys
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "benchmarks"))
import python_packages  # noqa: E402

python_packages.need("numpy", "matplotlib")

import numpy as np  # noqa: E402

import run_scenes  # noqa: E402

sys.path.insert(0, str(run_scenes.ROOT / "benchmarks/suspensions"))
import averages  # noqa: E402
import scenes  # noqa: E402
from test_benchmarks import Repository  # noqa: E402


class Averages(unittest.TestCase):
    """Between rows a series is a straight line, whose means are known exactly."""

    uneven = np.array([0, 0.3, 1.1, 2.6, 3.3, 4.7, 5.9, 7.7, 9.2, 10])

    def test_of_a_constant(self):
        mean, error, blocks = averages.block_average(self.uneven, 0 * self.uneven + 1.7, begin=2, n_blocks=4)
        self.assertAlmostEqual(mean, 1.7, places=14)
        self.assertAlmostEqual(error, 0, places=14)
        self.assertEqual(len(blocks), 4)

    def test_of_a_line(self):
        mean, error, blocks = averages.block_average(self.uneven, 3 * self.uneven - 1, begin=2, n_blocks=4)
        self.assertTrue(np.allclose(blocks, [8, 14, 20, 26], atol=1e-12))  # at 3, 5, 7, 9
        self.assertAlmostEqual(mean, 17, places=12)
        self.assertAlmostEqual(error, math.sqrt((9**2 + 3**2 + 3**2 + 9**2) / 3) / 2, places=12)

    def test_blocks_of_a_whole_period_all_have_its_mean(self):
        times = np.arange(0, 12.125, 0.125)
        zigzag = np.abs(times % 1 - 0.5)  # mean 1/4
        mean, error, _ = averages.block_average(times, zigzag, begin=4, n_blocks=4)
        self.assertAlmostEqual(mean, 0.25, places=12)
        self.assertAlmostEqual(error, 0, places=12)

    def test_the_start_does_not_count(self):
        times = np.linspace(0, 10, 101)
        self.assertEqual(averages.block_average(times, np.where(times < 4, 1e6, 2.))[:2], (2, 0))

    def test_noise_has_its_error(self):
        """Values that know nothing of each other: the mean of n of them is off by 1/sqrt(n)."""
        random = np.random.default_rng(1)
        times = np.arange(0, 404.0)
        runs = [averages.block_average(times, random.standard_normal(len(times)), n_blocks=16)[:2] for _ in range(400)]
        means, errors = np.array(runs).T
        self.assertAlmostEqual(means.std() * 20, 1, delta=0.1)
        self.assertAlmostEqual(errors.mean() * 20, 1, delta=0.05)

    def test_too_short_a_series_has_none(self):
        self.assertTrue(math.isnan(averages.block_average([0, 1, 2], [1, 1, 1])[0]))
        self.assertTrue(math.isnan(averages.block_average([0, 4.5], [1, 1])[0]))
        self.assertTrue(math.isnan(averages.block_average([], [])[0]))

    def test_over_runs(self):
        self.assertEqual(averages.over_runs([1.4, 1.5, 1.6])[0], 1.5)
        self.assertAlmostEqual(averages.over_runs([1.4, 1.5, 1.6])[1], 0.1 / math.sqrt(3), places=14)
        self.assertTrue(math.isnan(averages.over_runs([1.4])[1]))

    def test_of_directions(self):
        """0.45 pi and -0.45 pi are 0.1 pi apart, with pi/2 between them; one capsule may have a row less."""
        first = {"time": np.array([0, 1, 2.]), "D": np.array([0.1, 0.2, 0.3]), "theta": np.array([0.45, 0.2, 0.1])}
        second = {"time": np.array([0, 1.]), "D": np.array([0.3, 0.2]), "theta": np.array([-0.45, 0.1])}
        self.assertTrue(np.allclose(averages.mean_of_capsules([first, second], "D")[1], [0.2, 0.2]))
        times, theta = averages.mean_of_capsules([first, second], "theta")
        self.assertTrue(np.allclose(times, [0, 1]))
        self.assertTrue(np.allclose(np.abs(theta), [0.5, 0.15]))


class Boxes(unittest.TestCase):
    def test_fraction_and_cells(self):
        self.assertAlmostEqual(8 * 4 * math.pi / 3 / scenes.box_side(8, 0.1)**3, 0.1, places=14)
        for name in scenes.SCENES:
            for resolution in scenes.RESOLUTIONS:
                given = scenes.settings(name, resolution)
                if "Capsule/Number" in given:
                    side, cell, coarsest = (float(given[key]) for key in ("Scene/Box side", "Fluid mesh/Finest cell", "Fluid mesh/Coarsest cell"))
                    self.assertAlmostEqual(math.log2(coarsest / cell), 2, places=3)
                    self.assertLess(abs(side / cell / 8 - round(side / cell / 8)), 1e-2, name)
                    self.assertLess(coarsest, side / 2)


class Script(Repository):
    """The stand-in's capsules turn back; its suspensions have the relative viscosity 1 + 2.5 times the volume fraction, after a start that is wrong."""

    def run_scenes(self, *words):
        return self.passes("suspensions/run.py", *words, "--program", str(self.program), "--ranks", "1")

    def test_report_of_all_groups(self):
        before = self.doc()
        self.run_scenes("inertia_10", "crossing_1", "random_8_10", "random_8_10_seed2", "random_8_20_inertia", "speed_base")
        self.assertEqual(self.doc(), before)
        text = (self.root / "output/suspensions/report.md").read_text()
        self.assertIn("| 8 at 10 % | 1.250000 ± 0.000000 | 1.52 |", text)
        self.assertIn("8 at 10 %: 1.250000 ± 0.000000 of 2 seeds", text)
        self.assertIn("| Re = 10 | yes | -0.109 at 22.82 |", text)
        self.assertIn("| λ = 1 | 0.200 |", text)
        self.assertEqual({file.stem for file in (self.root / "output/suspensions/figures").glob("*.png")}, {"inertia", "crossing", "suspension"})

    def test_doc_changes_where_it_was_asked_to(self):
        (self.root / "doc/suspensions.md").unlink(missing_ok=True)
        self.run_scenes("random_8_10", "--update-doc")
        first = (self.root / "doc/suspensions.md").read_text()
        self.assertNotIn("## Pairs with inertia", first)
        self.run_scenes("inertia_10", "--update-doc")
        second = (self.root / "doc/suspensions.md").read_text()
        self.assertIn("## Pairs with inertia", second)
        self.assertEqual(second.split("## Suspensions")[1], first.split("## Suspensions")[1])

    def test_names_that_there_are_not(self):
        code, said = self.call("suspensions/run.py", "random_9_10", "--program", str(self.program), python=(sys.executable,))
        self.assertEqual(code, 2)
        self.assertIn("no such scene or group: random_9_10", said)
        code, said = self.call("suspensions/run.py", "random_64_20", "--program", str(self.program), python=(sys.executable,))
        self.assertIn("random_64_20 is for --full", said)


if __name__ == "__main__":
    unittest.main()
