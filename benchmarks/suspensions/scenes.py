# SPDX-License-Identifier: LGPL-2.1-or-later
# Part of Tanktread: the scenes with several capsules: which runs there are, what each sets beside its parameter file.
"""SCENES by name, in groups; run_of(name), settings(name, resolution): what run_scenes computes."""

import dataclasses
import math
import pathlib
import sys

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent))
import run_scenes  # noqa: E402

OUTPUT = run_scenes.ROOT / "output/suspensions"
RESOLUTIONS = ("quick", "full")
CELLS = {"quick": 0.4, "full": 0.2}  # about so large, at the shells of a suspension; its box decides
LEVEL = {"quick": 2, "full": 3}
COARSE_STEPS = {"Time/Step": "0.2"}
LONG_RUN = {"Fluid mesh/Finest cell": "0.325626", "Fluid mesh/Coarsest cell": "1.30251"}  # of 27 capsules


@dataclasses.dataclass(frozen=True)
class Scene:
    """A run. `group`: the part of the report that it belongs to; `label`: its name there; `prm`: its parameter file; `own`: what it sets beside; `finer`: what full sets
    beside that; `only`: the resolution that has it, "" both."""
    group: str
    label: str
    prm: str
    own: dict
    finer: dict
    only: str = ""


def box_side(number, fraction):
    """Of a cube in which spheres of radius one take this part."""
    return (number * 4 * math.pi / 3 / fraction) ** (1 / 3)


def cells_along(side, cell):
    """Cells along the side, about as large as asked for: a multiple of eight, which can be halved down to a few."""
    return max(16, 8 * round(side / cell / 8))


def in_box(number, fraction, resolution, **others):
    """Settings of spheres at random places in a cube."""
    side = round(box_side(number, fraction), 3)
    n = cells_along(side, CELLS[resolution])
    return {"Capsule/Number": str(number), "Scene/Box side": f"{side:g}", "Fluid mesh/Finest cell": f"{side / n * 1.0001:.6g}",
            "Fluid mesh/Coarsest cell": f"{4 * side / n * 1.0001:.6g}", "Shell mesh/Level": str(LEVEL[resolution]), **others}


def inertia(label, reynolds, **others):
    finer = {"Fluid mesh/Finest cell": "0.1953125", "Shell mesh/Level": "3", "Time/Step": "0.1"}
    return Scene("inertia", label, "inertia_pair", {"Scene/Reynolds number": f"{reynolds:g}", **others}, finer)


def crossing(ratio, unbounded=False):
    finer = {"Fluid mesh/Finest cell": "0.15625", "Shell mesh/Level": "3"}
    faces = {"Scene/Boundary": "unbounded", "Scene/Box side": "20, 10, 10"} if unbounded else {}
    return Scene("crossing", f"λ = {ratio:g}" + (", unbounded liquid" if unbounded else ""), "crossing", {"Scene/Viscosity ratio": f"{ratio:g}", **faces}, finer)


def films_of(number, percent, resolution, films):
    return {"Fluid mesh/Finest cell in gaps": f'{float(in_box(number, percent / 100, resolution)["Fluid mesh/Finest cell"]) / films:.6g}'} if films > 1 else {}


def suspension(number, percent, seed=1, reynolds=0, end=10, only="", gap=0.1, films=1, **others):
    """`films`: how many times smaller cells may become where shells are near each other."""
    label = (f"{number} at {percent} %" + (f", seed {seed}" if seed > 1 else "") + (f", Re = {reynolds:g}" if reynolds else "")
             + (f", cells down to h/{films} for films" if films > 1 else ""))
    own, finer = ({**in_box(number, percent / 100, resolution), "Capsule/Seed": str(seed), "Capsule/Least gap": f"{gap:g}", "Scene/Reynolds number": f"{reynolds:g}",
                   "Scene/End time": f"{end:g}", **films_of(number, percent, resolution, films), **others} for resolution in RESOLUTIONS)
    return Scene("suspension", label, "suspension", own, finer, only)


def speed(label, n_cells, end=2, **others):
    """16 capsules at 20 %, cells along the side."""
    side = round(box_side(16, 0.2), 3)
    own = {**in_box(16, 0.2, "quick"), "Fluid mesh/Finest cell": f"{side / n_cells * 1.0001:.6g}", "Fluid mesh/Coarsest cell": f"{4 * side / n_cells * 1.0001:.6g}",
           "Capsule/Least gap": "0.2", "Scene/End time": f"{end:g}", **COARSE_STEPS, **others}
    return Scene("speed", label, "suspension", own, {}, "quick")


SCENES = {
    "inertia_3": inertia("Re = 3", 0.75),
    "inertia_10": inertia("Re = 10", 2.5),
    "inertia_50": inertia("Re = 50", 12.5),
    **{f"inertia_{number}_shear": inertia(f"Re = {number}, Ca with G_s", number / 4, **{"Scene/Scale modulus": "shear"}) for number in (3, 10, 50)},
    "inertia_10_radius": inertia("Re = 10 on the radius", 10),
    "inertia_50_cells": inertia("Re = 50, larger cells", 12.5, **{"Fluid mesh/Finest cell": "0.520834", "Fluid mesh/Coarsest cell": "2.083334"}),
    "inertia_50_steps": inertia("Re = 50, longer steps", 12.5, **{"Time/Step": "0.4"}),
    "crossing_1": crossing(1),
    "crossing_5": crossing(5),
    "crossing_1_unbounded": crossing(1, unbounded=True),
    "crossing_5_unbounded": crossing(5, unbounded=True),
    **{f"random_8_{percent:02d}": suspension(8, percent, end=12, **COARSE_STEPS) for percent in (5, 10, 20, 30)},
    **{f"random_8_{percent:02d}_seed{seed}": suspension(8, percent, seed, end=12, **COARSE_STEPS) for percent in (10, 20) for seed in (2, 3)},
    **{f"random_8_{percent:02d}_inertia": suspension(8, percent, reynolds=10, end=12, **COARSE_STEPS) for percent in (10, 20)},
    "random_8_20_seed2_films": suspension(8, 20, 2, end=12, films=4, **COARSE_STEPS),
    "random_8_30_films": suspension(8, 30, end=12, films=4, **COARSE_STEPS),
    "random_27_10": suspension(27, 10, only="quick", gap=0.3, **COARSE_STEPS, **LONG_RUN),
    "random_27_20": suspension(27, 20, **COARSE_STEPS),
    "random_64_10": suspension(64, 10, end=8, gap=0.3, **COARSE_STEPS),
    "random_64_20": suspension(64, 20, only="full", **COARSE_STEPS),
    "red_8_20": Scene("red", "8 at 20 %", "red_cells", {}, {}, "quick"),
    "speed_base": speed("h = 0.29", 24),
    "speed_coarse": speed("h = 0.43", 16),
    "speed_cells": speed("h = 0.22", 32, end=1),
    "speed_points": speed("642 points", 24, end=1, **{"Shell mesh/Level": "3"}),
    "speed_steps": speed("shorter steps", 24, end=1, **{"Time/Step": "0.1"}),
    "speed_ratio": speed("h = 0.29, λ = 5", 24, **{"Scene/Viscosity ratio": "5"}),
}


class Run(run_scenes.Run):
    """A scene's parameter file and folders; several scenes have the same file."""

    def __init__(self, name):
        super().__init__(HERE, OUTPUT, name)
        self.prm = HERE / f"{SCENES[name].prm}.prm"


def run_of(name):
    return Run(name)


def is_at(name, resolution):
    return SCENES[name].only in ("", resolution)


def settings(name, resolution):
    """What a run sets beside its parameter file."""
    scene = SCENES[name]
    return {**scene.own, **(scene.finer if resolution == "full" else {})}
