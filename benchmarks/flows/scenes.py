# SPDX-License-Identifier: LGPL-2.1-or-later
# Part of Tanktread: the scenes of several capsules and of flows other than shear alone, their reference solutions, and their series in the frame of those.
"""SCENES by name; Result: what a run has left, ready to be compared at equal times."""

import dataclasses
import pathlib
import sys

import numpy as np

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent))
import run_files  # noqa: E402
import run_scenes  # noqa: E402

OUTPUT = run_scenes.ROOT / "output/flows"

# How fine and in which box: (finest cell, level of the control mesh, side of the box). From coarse to fine; quick and wide differ by the box alone, and the last two
# from quick and full by their boxes in unbounded liquid, for scenes without walls.
RESOLUTIONS = {"quick": (0.3125, 2, 20), "wide": (0.3125, 2, 40), "full": (0.15625, 3, 40), "unbounded": (0.3125, 2, 7.5), "unbounded-full": (0.15625, 3, 7.5)}
UNBOUNDED_SIDES = {"crossing_pair": "30, 7.5, 7.5", "parabola": "7.5, 7.5, 10"}  # room for a pair that ends 20a apart, for a capsule off the middle


@dataclasses.dataclass(frozen=True)
class Scene:
    """What the results of a parameter file are compared with, in which quantities. `times`: for which the report gives numbers, the last is the end."""
    title: str
    about: str
    reference: str
    quantities: tuple
    times: tuple


SCENES = {
    "crossing_pair": Scene(
        "A pair passing in shear",
        "Ca = 0.45, prestress 0.05, centres at (∓4, 0, ±0.25). Numbers are those of the first capsule. The box is a cube of 40a, 80a or 160a, "
        "in unbounded liquid 30a × 7.5a × 7.5a: at the end the capsules are 20a apart.",
        "crossing_pair_Ca0.45_prestress0.05.csv", ("x", "z", "D", "theta"), (5, 15, 20, 32)),
    "planar_extension": Scene(
        "Planar extension", "(x, 0, −z) on all faces of the box, Ca = 0.1, prestress 0.05; at the end the shape is steady.",
        "planar_extension_Ca0.1_prestress0.05.csv", ("D", "L", "B", "W"), (1, 8)),
    "uniaxial_extension": Scene(
        "Uniaxial extension", "(x, −y/2, −z/2) on all faces of the box, Ca = 0.1, prestress 0.05; at the end the shape is steady.",
        "uniaxial_extension_Ca0.1_prestress0.05.csv", ("D", "L", "B", "W"), (1, 8)),
    "parabola": Scene(
        "Plane Poiseuille flow", "(H/2)(1 − z²/H²) along x without walls, H = 5, Ca = 1, prestress 0.05, from z₀ = 1.5; the box between faces is wider than the parabola, that in "
        "unbounded liquid 7.5a × 7.5a × 10a.",
        "plane_poiseuille_Ca1_H5_z1.5_prestress0.05.csv", ("z_moved", "u_x", "u_z", "D", "theta"), (5, 10, 30)),
    "wall": Scene(
        "Above a wall", "Shear, Ca = 0.3, prestress 0.05, centre at a distance of 2 from the lower wall at first; u_x is seen from that wall. "
        "The upper wall is not in the reference.",
        "wall_Ca0.3_d2_prestress0.05.csv", ("z_moved", "u_x", "u_z", "D", "theta"), (5, 10, 30)),
}


def is_at(name, resolution):
    """Whether the scene has the resolution: walls are not in unbounded liquid."""
    return name != "wall" or not resolution.startswith("unbounded")


def settings(name, resolution):
    """What a resolution adds to the parameter file."""
    cell, level, side = RESOLUTIONS[resolution]
    result = {"Fluid mesh/Finest cell": f"{cell:g}", "Shell mesh/Level": str(level), "Scene/Box side": str(side)}
    if resolution.startswith("unbounded"):
        result |= {"Scene/Boundary": "unbounded", "Scene/Box side": UNBOUNDED_SIDES.get(name, str(side)), "Fluid mesh/Coarsest cell": "1.25"}
    elif name == "crossing_pair":  # small differences of height add up for 16/rate before the pair meets, so it takes larger boxes
        side = {"quick": 40, "wide": 80, "full": 160}[resolution]
        result["Scene/Box side"] = f"{side}"
        result["Fluid mesh/Coarsest cell"] = f"{side / 16:g}"
    if name == "wall":
        result["Capsule/Centres"] = f"0, 0, {2 - side / 2:g}"
        result["Scene/Frame velocity"] = f"{2.3 - side / 2:g}, 0, 0"  # near that of the capsule, so that the mesh need not follow it
    if name == "parabola":
        result["Scene/Frame velocity"] = "2.27, 0, 0"
    return result


def described(resolution):
    cell, level, side = RESOLUTIONS[resolution]
    liquid = " in unbounded liquid" if resolution.startswith("unbounded") else ""
    return f"cells of {cell:g} a at the shell, {10 * 4 ** level + 2} control points, a box of {side} a{liquid}"


def run_of(name):
    return run_scenes.Run(HERE, OUTPUT, name)


def reference(name):
    """(standard columns, with `z_moved` where there is z, and `gap` or `gap_wall`; notes) of the scene's reference solution."""
    table, notes = run_files.read_table(run_files.REFERENCE_FOLDER / SCENES[name].reference)
    return {**with_way(run_files.standard_columns(table)), **{column: table[column] for column in ("gap", "gap_wall") if column in table}}, notes


def with_way(series):
    return {**series, "z_moved": series["z"] - series["z"][0]} if "z" in series else series


class Result:
    """One run of a scene at a resolution. `capsules` is [] when there is nothing; else series in the frame of the reference."""

    def __init__(self, name, resolution):
        run = run_of(name)
        self.name, self.resolution, self.record = name, resolution, run.record(resolution)
        self.capsules, self.suspension = [], {}
        if self.record is None:
            return
        folder = run.folder(resolution)
        tables = [table for _, table in run_files.tables_of_capsules(folder, "history")]
        self.capsules = [with_way(run_files.standard_columns(table)) for table in tables if "time" in table]
        settings = self.record["settings"]
        frame = float(settings.get("Scene/Frame velocity", "0").split(",")[0])
        if name == "wall":  # seen from the lower wall, which moves with the velocity -side/2
            side = float(settings["Scene/Box side"].split(",")[-1])
            frame += side / 2
            for series in self.capsules:
                series["z"] = series["z"] + side / 2 - 2
        for series in self.capsules:
            series["x"] = series["x"] + frame * series["time"]
            series["u_x"] = series["u_x"] + frame
        if (folder / "suspension.csv").is_file():
            self.suspension = run_files.read_table(folder / "suspension.csv")[0]

    def state(self):
        """"done", or what became of it."""
        if self.record is None:
            return "not run"
        return "done" if self.record["exit_code"] == 0 else self.record["message"] or f"exit code {self.record['exit_code']}"

    def at(self, time, quantity):
        """Value of the first capsule at a time, by a cubic through the rows around it."""
        series = self.capsules[0]
        return run_files.interpolated(series["time"], series[quantity], time)

    def largest_difference(self, quantity, wanted):
        """(largest |run - reference| at the rows of the run, the time of it)."""
        series = self.capsules[0]
        differences = np.abs(series[quantity] - run_files.interpolated(wanted["time"], wanted[quantity], series["time"]))
        if not np.isfinite(differences).any():
            return np.nan, np.nan
        worst = np.nanargmax(differences)
        return differences[worst], series["time"][worst]

    def smallest_gap(self):
        """Between the capsules, by a parabola; NaN where suspension.csv is missing."""
        return float(-peak(self.suspension["time"], -self.suspension["smallest_gap"])[1]) if "smallest_gap" in self.suspension else np.nan

    def offset(self):
        """(distance along the flow, distance across) of the first from the second of a pair, over 2a; rows that both have."""
        rows = min(len(series["time"]) for series in self.capsules)
        first, second = self.capsules[:2]
        return tuple((first[name][:rows] - second[name][:rows]) / 2 for name in ("x", "z"))


def peak(x, y):
    """(x, y) of the highest point of a curve, by a parabola through the three highest rows."""
    i = int(np.clip(np.nanargmax(y), 1, len(y) - 2))
    a, b, c = np.polyfit(x[i - 1:i + 2] - x[i], y[i - 1:i + 2], 2)
    return (x[i], y[i]) if a == 0 else (x[i] - b / (2 * a), c - b * b / (4 * a))
