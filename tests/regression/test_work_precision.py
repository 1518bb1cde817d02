#!/usr/bin/env python3
# SPDX-License-Identifier: LGPL-2.1-or-later
# Part of Tanktread: tests of the pure parts of benchmarks/work_precision.
"""Error norms, extrapolation, powers, Pareto front, guard against cancellation, and which runs there are."""

import math
import pathlib
import sys
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path[:0] = [str(ROOT / "benchmarks"), str(ROOT / "benchmarks/work_precision")]
import python_packages  # noqa: E402

python_packages.need("numpy", "matplotlib")

import numpy as np  # noqa: E402

import norms  # noqa: E402
import sweeps  # noqa: E402


def curve(times, error=0.0, theta_shift=0.0):
    """Cubics in time, which are read off without error."""
    times = np.asarray(times, dtype=float)
    D = 0.1 + 0.2 * times - 0.03 * times**3
    return {"time": times, "D": D + error * times * (1 - times), "theta": 0.25 - 0.1 * times + theta_shift, "viscosity": 2 + times**2 + error}


FINE, COARSE = np.linspace(0, 1, 41), np.linspace(0, 1, 11)


class Norms(unittest.TestCase):
    def test_difference_is_found_wherever_the_rows_are(self):
        largest_D = curve(FINE)["D"].max()
        for times in (COARSE, FINE, np.array([0, 0.07, 0.31, 0.5, 0.83, 1])):
            self.assertAlmostEqual(norms.largest(curve(times, 0.4), curve(FINE), "D", dense=True), 0.1 / largest_D, delta=1e-12 if 0.5 in times else 1e-4)
            self.assertLess(norms.largest(curve(times), curve(FINE), "D", dense=True), 1e-13)
        self.assertAlmostEqual(norms.largest(curve(FINE, 0.4), curve(COARSE), "D"), 0.1 / curve(COARSE)["D"].max(), places=12)
        self.assertAlmostEqual(norms.largest(curve(FINE, 0.3), curve(COARSE), "viscosity"), 0.1, places=12)

    def test_first_steps_count(self):
        run = curve(FINE)
        run["D"] = run["D"].copy()
        run["D"][1] += 0.05
        self.assertAlmostEqual(norms.largest(run, curve(FINE), "D"), 0.05 / run["D"].max(), places=12)

        run["theta"] = run["theta"].copy()
        run["theta"][1] += 0.025
        for dense in (False, True):
            self.assertAlmostEqual(norms.largest(run, curve(FINE), "theta", dense), 0.1, places=12)

    def test_rows_between_those_of_a_dense_truth_count(self):
        run = curve(FINE)
        run["D"] = run["D"].copy()
        run["D"][7] += 0.05  # COARSE has every fourth row
        self.assertAlmostEqual(norms.largest(run, curve(COARSE), "D", dense=True), 0.05 / run["D"].max(), places=12)
        self.assertLess(norms.largest(run, curve(COARSE), "D"), 1e-13)

    def test_half_turns_of_the_angle_are_nothing(self):
        self.assertAlmostEqual(norms.largest(curve(FINE, 0, 1.01), curve(FINE), "theta"), 0.04, places=12)
        self.assertAlmostEqual(norms.largest(curve(FINE, 0, -2), curve(FINE), "theta"), 0, places=12)
        turning = np.linspace(0.25, -1.25, 30)
        wrapped = (turning + 0.5) % 1 - 0.5
        np.testing.assert_allclose(norms.continuous(np.append(math.nan, wrapped))[1:], turning, rtol=0, atol=1e-14)

    def test_angle_without_a_value_at_the_start(self):
        run, true = curve(FINE), curve(FINE)
        true["theta"] = true["theta"].copy()
        true["theta"][0] = math.nan
        self.assertEqual(norms.largest(run, true, "theta"), 0)
        run["theta"] = run["theta"].copy()
        run["theta"][20] = math.nan
        self.assertEqual(norms.largest(run, true, "theta"), math.inf)

    def test_a_run_that_ends_early_is_compared_as_long_as_it_lasts(self):
        self.assertAlmostEqual(norms.largest(norms.until(curve(FINE, 0.4), 0.25), curve(FINE), "D"), 0.4 * 0.1875 / curve(FINE)["D"].max(), places=12)

    def test_a_run_may_end_between_two_rows_of_the_truth(self):
        for dense in (False, True):
            self.assertAlmostEqual(norms.largest(curve(np.linspace(0, 0.56, 9), 0.4), curve(COARSE), "viscosity", dense), 0.4 / 3, places=12)
        self.assertAlmostEqual(norms.largest(curve(FINE, 0.4), norms.until(curve(COARSE), 0.56), "viscosity"), 0.4 / 2.25, places=12)

    def test_second_order_is_removed(self):
        guess = norms.extrapolated(curve(FINE, 0.1, 0.01), curve(COARSE, 0.4, 1.04))  # the angle by half a turn off
        for quantity in norms.QUANTITIES:
            self.assertLess(norms.largest(guess, curve(COARSE), quantity), 1e-12, quantity)

    def test_period(self):
        sys.path.append(str(ROOT / "benchmarks/le_2010"))
        import motion  # pylint: disable=import-outside-toplevel
        times = np.linspace(0, 16, 161)
        self.assertAlmostEqual(norms.period({"time": times, "D": 0.2 + 0.05 * np.sin(2 * math.pi * times / 6.5)}, motion.extrema), 6.5, places=4)
        self.assertTrue(math.isnan(norms.period({"time": times, "D": 0.2 + 0.01 * times}, motion.extrema)))


class Choices(unittest.TestCase):
    def test_powers(self):
        h = np.array([0.4, 0.2, 0.1])
        self.assertAlmostEqual(norms.power(h, 3 * h**2.5), 2.5, places=12)
        self.assertAlmostEqual(norms.power(np.append(h, math.inf), np.append(3 * h**2.5, 1)), 2.5, places=12)
        self.assertTrue(math.isnan(norms.power([0.1, 0.1], [1, 2])))
        self.assertTrue(math.isnan(norms.power([0.1, 0.2], [1, 0])))

    def test_front(self):
        self.assertEqual(norms.pareto([1, 2, 3, 2.5, 4], [0.5, 0.3, 0.1, 0.4, 0.1]), [0, 1, 2])
        self.assertEqual(norms.pareto([2, 1, math.nan, 1], [1, 1, 0, 2]), [1])
        self.assertEqual(norms.cheapest([3, 1, 2], [0.01, 0.2, 0.05], 0.1), 2)
        self.assertIsNone(norms.cheapest([3, 1, 2], [0.01, 0.2, 0.05], 0.001))

    def test_cancelled_errors_are_not_believed(self):
        guard = norms.guarded([[("a", 0.9), ("b", 0.1), ("c", 0.3)], [("d", 0.2), ("b", 0.1), ("e", 0.05)]])
        self.assertEqual(guard, {"a": 0.9, "b": 0.3, "c": 0.3, "d": 0.2, "e": 0.05})


class Sweeps(unittest.TestCase):
    def test_runs_differ_in_name_where_they_differ(self):
        for scene in sweeps.SCENES:
            for full in (False, True):
                choices = {point.choice for point in sweeps.sweeps(scene, full, ["BDF2", "backward Euler", "BDF3"], True)}
                self.assertEqual(len({sweeps.name(choice) for choice in choices}), len(choices))
                self.assertEqual(len({tuple(sweeps.parameters(choice).items()) for choice in choices}), len(choices))
                self.assertIn(sweeps.base(scene, full), choices)

    def test_sweeps_go_from_coarse_to_fine(self):
        for scene in sweeps.SCENES:
            points = sweeps.sweeps(scene, True, ["BDF2"], True)
            for cause in {point.cause for point in points} - {"unbounded box", "box between faces"}:
                values = [point.value for point in points if point.cause == cause]
                self.assertEqual(values, sorted(values, reverse=True), cause)

    def test_what_the_program_knows(self):
        printed = "subsection Time\n  # BDF2: good.\n  # Allowed: one of BDF2, backward\n  # Euler, SDIRK3. Default: BDF2.\n  set Scheme = BDF2\nend\n"
        self.assertEqual(sweeps.schemes_and_dial(printed), (["BDF2", "backward Euler", "SDIRK3"], False))
        self.assertEqual(sweeps.schemes_and_dial(printed + "\nsubsection Accuracy\n  set Target error = 0\nend\n")[1], True)
        with self.assertRaises(ValueError):
            sweeps.schemes_and_dial("subsection Time\nend\n")


if __name__ == "__main__":
    unittest.main()
