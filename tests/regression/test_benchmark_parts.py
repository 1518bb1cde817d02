#!/usr/bin/env python3
# SPDX-License-Identifier: LGPL-2.1-or-later
# Part of Tanktread: tests of what the scripts of benchmarks/ share, and of the drawing of shells.
"""Cores and runs, light on a shell, numbers with bars, curves of runs and of references."""

import math
import pathlib
import sys
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "benchmarks"))
import python_packages  # noqa: E402

python_packages.need("numpy", "matplotlib")

import numpy as np  # noqa: E402

import plot_style  # noqa: E402, F401
import report_parts  # noqa: E402
import run_files  # noqa: E402
import run_scenes  # noqa: E402

sys.path.insert(0, str(run_scenes.ROOT / "benchmarks/le_2010"))
import snapshots  # noqa: E402


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


class Snapshots(unittest.TestCase):
    """An octahedron: the directions of its vertices are its normals."""

    def setUp(self):
        points = np.array([[1, 0, 0], [-1, 0, 0], [0, 1, 0], [0, -1, 0], [0, 0, 1], [0, 0, -1]], dtype=float)
        faces = np.array([[0, 2, 4], [2, 1, 4], [1, 3, 4], [3, 0, 4], [2, 0, 5], [1, 2, 5], [3, 1, 5], [0, 3, 5]])
        self.flat = {"points": points, "faces": faces, "velocity": points[:, [2, 1, 0]]}
        self.smooth = {**self.flat, "normals": points}

    def test_files_without_normals_have_those_of_their_faces(self):
        shell = snapshots.with_normals(self.flat)
        self.assertTrue(np.allclose(shell["points"].reshape(-1, 3, 3), self.flat["points"][self.flat["faces"]]))
        self.assertTrue(np.allclose(shell["normals"].reshape(-1, 3, 3).mean(axis=1), self.flat["points"][self.flat["faces"]].sum(axis=1) / np.sqrt(3)))
        self.assertIs(snapshots.with_normals(self.smooth), self.smooth)

    def test_what_is_seen_is_the_side_towards_us(self):
        right, up = snapshots.SCREEN
        self.assertTrue(np.allclose([right @ right, up @ up, right @ up], [1, 1, 0]))
        self.assertTrue(np.allclose(np.cross(right, up), snapshots.EYE))
        for shell in (self.flat, self.smooth):
            for vertex, fill in ((4, "black"), (5, "none")):  # above and below
                axis = snapshots.plt.figure().add_subplot()
                snapshots.draw_shell(axis, shell, vertex, 1)
                triangles = axis.collections[0]._triangulation.triangles
                points = snapshots.with_normals(shell)["points"]
                self.assertTrue((points[triangles].sum(axis=1) @ snapshots.EYE > 0).all())
                self.assertEqual(len(triangles), np.sum(self.flat["points"][self.flat["faces"]].sum(axis=1) @ snapshots.EYE > 0))
                self.assertEqual(axis.lines[0].get_markerfacecolor(), fill)
                snapshots.plt.close(axis.figure)

    def test_light_follows_the_normals(self):
        colors = snapshots.colors_of({**self.smooth, "velocity": np.zeros((6, 3))}, 1)[:, :3].sum(axis=1)
        self.assertEqual(np.argmax(colors), np.argmax(self.smooth["points"] @ snapshots.direction(*snapshots.LAMP)))


class Values(unittest.TestCase):
    def test_value_and_bar(self):
        value = report_parts.Value
        self.assertEqual(str(value(0.380239, 0.00031234, 0.38)), "0.38024 ± 0.00031 (+0.06 %)")
        self.assertEqual(str(value(2.29148, 0.027)), "2.291 ± 0.027")
        self.assertEqual(str(value(0.0059, 0.00002, 0.00588)), "0.005900 ± 0.000020 (+0.00002)")
        self.assertEqual(str(value(0.380239)), "0.38024")
        self.assertEqual(str(value(math.nan, 1.)), "–")
        self.assertTrue(value(1., 0.1, 1.05).is_within_bar)
        self.assertFalse(value(1., 0.1, 1.15).is_within_bar)
        self.assertFalse(value(1., math.nan, 1.15).is_compared)


class Files(unittest.TestCase):
    def test_largest_differences_of_curves(self):
        times = np.linspace(0, 6, 121)
        series = lambda D, theta: {"time": times, "D": D, "theta": theta}  # noqa: E731
        D, theta = 0.2 + 0.05 * np.cos(times), 0.45 + 0.1 * np.sin(times)  # passes 1/2, where the angle jumps
        theta -= theta > 0.5
        of_D, of_theta = run_files.largest_differences(series(D * 1.01, theta), series(D, theta))
        self.assertAlmostEqual(of_D, 0.01, places=12)
        self.assertAlmostEqual(of_theta, 0, places=12)
        coarse = {name: column[::7] for name, column in series(D, theta).items()}
        of_D, of_theta = run_files.largest_differences(series(D, theta + 0.003), coarse)
        self.assertAlmostEqual(of_D, 0, places=12)
        self.assertAlmostEqual(of_theta, 0.003, places=12)
        early = {name: column[:61] for name, column in series(D, theta).items()}
        self.assertAlmostEqual(run_files.largest_differences(early, series(np.where(times > 3, 1, D), theta))[0], 0, places=12)

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
        pair = {"Scene/Shear number G": "0.45", "Scene/Scale modulus": "shear", "Capsule/Prestress": "0.05", "Capsule/Centres": "-4, 0, 0.25; 4, 0, -0.25",
                "Scene/Reduced bending modulus": "0"}
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
