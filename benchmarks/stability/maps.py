# SPDX-License-Identifier: LGPL-2.1-or-later
# Part of Tanktread: which runs the maps of stability consist of.
"""A map is a table of runs: what the scene is like goes down (rows), how it is computed goes to the right (columns, from coarse to fine). The last run of a row that comes to its end is
what the others of its group of rows are compared with."""

import collections
import re

# settings: {"Section/Parameter": value}; group: rows with the same group are compared with the last finished run of the last row
Row = collections.namedtuple("Row", "label settings group")
Column = collections.namedtuple("Column", "label settings full", defaults=[False])  # full: left out with --quick
# scene: name of the parameter file; settings: of all runs; down, across: what rows and columns are; note: what is worth knowing of the map;
# compared: whether runs are compared with the last of their group
Map = collections.namedtuple("Map", "name title scene settings down rows across columns note compared", defaults=[True])
Cell = collections.namedtuple("Cell", "map row column")

STEPS_ALONE = {"Time/Tolerance": "0"}
SCHEMES = ["backward Euler", "BDF2", "BDF3", "SDIRK3"]


def rows(parameter, values, **more):
    return [Row(str(value), {parameter: str(value), **more}, str(value)) for value in values]


def steps(*values, full=()):
    return [Column(f"{value:g}", {**STEPS_ALONE, "Time/Step": f"{value:g}"}, value in full) for value in values]


def columns(parameter, *values, full=()):
    return [Column(str(value), {parameter: str(value)}, value in full) for value in values]


def cells(*values, full=()):
    return columns("Fluid mesh/Finest cell", *values, full=full)


KHAT = [0.001, 0.04, 1]
SCHEME_ROWS = [Row(f"{scheme}, κ̂ {khat:g}", {"Time/Scheme": scheme, "Scene/Reduced bending modulus": f"{khat:g}"}, f"{khat:g}") for khat in KHAT for scheme in SCHEMES]
EXPLICIT = {**STEPS_ALONE, "Solver/Coupling": "explicit"}
EXPLICIT_STEPS = steps(0.1, 0.03, 0.01, 0.003, 0.001, full=[0.001])


def pair(gap):
    return {"Capsule/Centres": f"0, 0, {1 + gap / 2:g}; 0, 0, {-1 - gap / 2:g}"}


def image(gap):
    """A sphere in a box of side 2 + gap; below 3, which a box has to have, a disk of radius 3/2 - gap/2 instead: its images along x and y are that far away."""
    side = max(3, 2 + gap)
    radius = (side - gap) / 2
    return {"Scene/Box side": f"{side:g}, {side:g}, {2 * side:g}", "Fluid mesh/Coarsest cell": f"{side / 2:g}", "Capsule/Shape": "oblate", "Capsule/Aspect ratio": f"{radius ** -3:.6g}"}


def near(neighbour, settings, gaps=(1, 0.3, 0.1, 0.05, 0.02)):
    return [Row(f"{neighbour} {gap:g}a", settings(gap), f"{neighbour} {gap:g}") for gap in gaps]


# G and kappa hat of the figures of Le (2010), a scheme and a step a column; the last is what the others are compared with.
PAPER = [(0.005, 0.01), (0.005, 0.02), (0.005, 0.05), (0.008, 0.002), (0.008, 0.005), (0.05, 0), (0.05, 0.005), (0.05, 0.01), (0.05, 0.025), (0.05, 0.0375), (0.2, 0), (0.2, 0.04), (0.2, 0.1), (0.2, 0.15),
         (0.5, 0.01), (0.5, 0.04)]
PAPER_ROWS = [Row(f"G {G:g}, κ̂ {khat:g}", {"Scene/Shear number G": f"{G:g}", "Scene/Reduced bending modulus": f"{khat:g}"}, f"{G} {khat}") for G, khat in PAPER]
NO_MEMBRANE = {"Scene/Reduced bending modulus": "1", "Capsule/Membrane law": "none"}
RELAXING_ROWS = [Row("ellipsoid", NO_MEMBRANE, "ellipsoid"), Row("biconcave", {**NO_MEMBRANE, "Capsule/Shape": "biconcave"}, "biconcave")]


def schemes_at(step, fine):
    choices = [(scheme, step) for scheme in SCHEMES] + [("SDIRK3", fine)]
    return [Column(f"{scheme}, {length:g}", {**STEPS_ALONE, "Time/Scheme": scheme, "Time/Step": f"{length:g}"}) for scheme, length in choices]


MAPS = [
    Map("schemes_shear", "Steps in shear", "sphere", {}, "scheme, κ̂", SCHEME_ROWS, "γ̇Δt", steps(2, 1, 0.5, 0.1),
        "Steps of one length, without a bound on their local error (Time/Tolerance = 0)."),
    Map("explicit_shear", "Explicit steps in shear", "sphere", {**EXPLICIT, "Scene/End time": "0.3"}, "κ̂", rows("Scene/Reduced bending modulus", [0, *KHAT]), "γ̇Δt", EXPLICIT_STEPS,
        "The shell moves with the velocity of the last step: what one has instead of Newton's method, at its limit of stability."),
    Map("schemes_relaxation", "Steps in relaxation", "relaxing", {}, "scheme, κ̂", SCHEME_ROWS, "Δt in μa³/κ_B", steps(0.5, 0.25, 0.1, 0.02),
        "With κ̂ = 0.001 the membrane is 1000 times stiffer than the bending by which time is measured."),
    Map("paper_shear", "Steps of a half at the κ̂ of Le (2010)", "sphere", {"Scene/End time": "3"}, "G, κ̂", PAPER_ROWS, "scheme, γ̇Δt", schemes_at(0.5, 0.1), "Spheres, to γ̇t = 3."),
    Map("paper_relaxation", "The same in relaxation", "relaxing", {"Scene/End time": "2"}, "shape", RELAXING_ROWS, "scheme, Δt in μa³/κ_B", schemes_at(0.5, 0.1), "Bending alone."),
    Map("explicit_relaxation", "Explicit steps in relaxation", "relaxing", {**EXPLICIT, "Scene/End time": "0.03"}, "κ̂", rows("Scene/Reduced bending modulus", KHAT), "Δt in μa³/κ_B",
        steps(0.01, 0.003, 0.001, 0.0003, 0.0001, full=[0.0001]), "As in shear."),
    Map("wrinkles", "Small G with and without bending", "sphere", {}, "G, κ̂",
        [Row(f"G {G:g}, κ̂ {khat:g}", {"Scene/Shear number G": f"{G:g}", "Scene/Reduced bending modulus": f"{khat:g}"}, f"{G} {khat}") for G in (0.05, 0.005) for khat in (0, 0.0005, 0.005)],
        "level of the control mesh", columns("Shell mesh/Level", 1, 2, 3, 4, full=[4]), "A membrane without bending wrinkles where shear compresses it, from control point to control point."),
    Map("compression", "Compressed at rest", "relaxing", {"Capsule/Prestress": "-0.05", "Scene/End time": "0.1"}, "κ̂",
        rows("Scene/Reduced bending modulus", [0.0001, 0.001, 0.01]), "level of the control mesh", columns("Shell mesh/Level", 1, 2, 3, 4, full=[4]),
        "The membrane is too large for the volume by 5 % in length: it buckles. Its energy still has to fall."),
    Map("large_G", "Large G: no steady state", "sphere", {"Scene/End time": "6", "Time/Limit tolerance": "1e-2"}, "G",
        rows("Scene/Shear number G", [0.2, 0.5, 1, 3, 10]), "κ̂", columns("Scene/Reduced bending modulus", 0.04, 0.005, 0),
        "To γ̇t = 6, with a stop where the limit of the shape is known; κ̂ falls to the right, so that runs are not compared.", False),
    Map("viscosity_ratio", "Viscosity ratio", "sphere", {}, "λ", rows("Scene/Viscosity ratio", [0.01, 0.1, 1, 10, 100]), "γ̇Δt", steps(1, 0.3, 0.1, full=[]), ""),
    Map("skalak", "Skalak's C", "sphere", {"Capsule/Membrane law": "Skalak"}, "C", rows("Capsule/Area dilatation number", [1, 10, 100, 1000, 10000]), "γ̇Δt", steps(1, 0.3, 0.1), ""),
    Map("meshes", "Control mesh against cells", "sphere", {}, "cells", rows("Fluid mesh/Finest cell", [0.928, 0.464, 0.232]), "level of the control mesh",
        columns("Shell mesh/Level", 0, 1, 2, 3, 4, full=[4]), "Control points are about 1.2, 0.6, 0.3, 0.15 and 0.07 a apart at levels 0 to 4: from five cells to a sixth of a cell."),
    Map("cells", "Cells a radius", "sphere", {}, "shape",
        [Row("sphere", {}, "sphere"), Row("oblate 0.5", {"Capsule/Shape": "oblate", "Capsule/Aspect ratio": "0.5", "Capsule/Inclination": "0.25"}, "oblate"),
         Row("biconcave", {"Capsule/Shape": "biconcave", "Capsule/Inclination": "0.25", "Capsule/Reference curvature": "initial"}, "biconcave")],
        "finest cell", cells(0.928, 0.464, 0.232, 0.116, full=[0.116]), "The target of 1 % takes 0.46 a for the sphere; a cell of 0.5 a is two a radius."),
    Map("crossing", "Steps that cross many cells", "box", {}, "γ̇Δt",
        [Row(f"{step:g}", {**STEPS_ALONE, "Time/Step": f"{step:g}"}, f"{step:g}") for step in (1, 0.3, 0.1)], "speed of the frame",
        [Column(f"{speed:g}", {"Scene/Frame velocity": f"{-speed:g}, 0, 0"}) for speed in (100, 30, 10, 3, 0)],
        "The liquid moves through the box with the capsule, cells are 0.5 a: a step crosses up to 200. The shape should be that at speed 0, with which it is compared."),
    Map("gaps", "Gaps", "box", {"Scene/End time": "0.5"}, "gap to",
        near("wall", lambda gap: {"Capsule/Centres": f"0, 0, {-2 + gap:g}"}) + near("capsule", pair), "finest cell", cells(0.5, 0.25, 0.125, full=[0.125]),
        "D of the first capsule is compared; the gap itself is in the warnings."),
    Map("images", "Gaps to the own image", "box", {"Scene/End time": "0.5"}, "gap to", near("image", image, (2.5, 1.2, 0.7, 0.3, 0.1, 0.02)), "finest cell", cells(0.5, 0.25, 0.125),
        "A sphere, below a gap of 1a a flat disk in a box 3a wide and long; the interface needs four cells between a shell and its image."),
    Map("dimple", "The dimple of a disk closing", "biconcave",
        {"Scene/Flow": "linear", "Scene/Velocity gradient": "1, 0, 0, 0, 1, 0, 0, 0, -2", "Scene/End time": "1.5", "Capsule/Inclination": "0", "Capsule/Area dilatation number": "1"}, "G",
        rows("Scene/Shear number G", [0.02, 0.1, 0.5, 2]), "finest cell", cells(0.5, 0.25, 0.125, full=[0.125]),
        "Extension along x and y presses the two sheets of the disk together."),
    Map("inertia", "Reynolds number", "box", {"Scene/End time": "1"}, "Re", rows("Scene/Reynolds number", [0, 1, 10, 30, 100]), "γ̇Δt", steps(0.5, 0.2, 0.05), ""),
    Map("thickness", "Thick and thin shells", "sphere", {"Scene/Reduced bending modulus": "0"}, "thickness/a", rows("Capsule/Thickness", [0.002, 0.02, 0.1, 0.3, 0.6]), "γ̇Δt", steps(1, 0.3, 0.1), ""),
    Map("spheroids", "Spheroids from flat to long", "sphere", {"Capsule/Shape": "ellipsoid", "Capsule/Reference curvature": "initial", "Capsule/Inclination": "0.25"}, "c/a",
        [Row(f"{ratio:g}", {"Capsule/Axes": f"1, 1, {ratio:g}"}, f"{ratio:g}") for ratio in (0.1, 0.2, 0.5, 2, 5, 10)], "finest cell", cells(0.6, 0.3, 0.15, full=[0.15]),
        ""),
]


def cells_of(map_, quick):
    return [Cell(map_, row, column) for row in map_.rows for column in map_.columns if not (quick and column.full)]


def settings(cell):
    return {**cell.map.settings, **cell.row.settings, **cell.column.settings}


def name(cell):
    """The folder of a run."""
    return "/".join([cell.map.name, re.sub(r"[^\w.]+", "_", f"{cell.row.label}__{cell.column.label}")])
