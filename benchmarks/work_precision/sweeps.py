# SPDX-License-Identifier: LGPL-2.1-or-later
# Part of Tanktread: which runs a scene is computed with.
"""A choice is what a user decides for a scene; a sweep changes one part of it (or several together, "joint"), from coarse to fine."""

import collections
import math
import re

# What is usual: the program's defaults, but for the boundary.
Choice = collections.namedtuple("Choice", "cells level step interface scheme tolerance boundary side newton linear method coupling stop target",
                                defaults=["enriched", "BDF3", 0, "unbounded", 7.5, 1e-4, 0.1, "matrix-free", "implicit", 0, 0])
Point = collections.namedtuple("Point", "cause value choice")
# viscosity_ratio as in the parameter file; step: that of the full base, about as good as its mesh; steady, swinging: what else is compared
Scene = collections.namedtuple("Scene", "name title viscosity_ratio step steady swinging")

SCENES = [
    Scene("sphere", "Sphere, G = 0.2, κ̂ = 0.04, λ = 1", 1, 0.1, True, False),
    Scene("sphere_lambda5", "Sphere, G = 0.05, κ̂ = 0.01, λ = 5", 5, 0.1, True, False),
    Scene("oblate", "Oblate spheroid, G = 0.05, κ̂ = 0.01, swinging", 1, 0.05, False, True),
    Scene("biconcave", "Biconcave disk, G = 0.1, κ̂ = 0.01, λ = 4, tumbling", 4, 0.05, False, False),
]
JOINT = [(16, 1, 0.2), (32, 2, 0.1), (64, 3, 0.05), (128, 4, 0.025)]  # cells per 10 a, level, step: everything of second order is halved
STOP_END = 30
BELOW_BASE = ("plain interface", "backward Euler", "explicit coupling")  # of lower order than the base: what is better than that is so by chance


def parameters(choice):
    """The settings of the program."""
    if choice.target:
        return {"Accuracy/Target error": f"{choice.target:g}"}
    wanted = {"Fluid mesh/Finest cell": 10 / choice.cells, "Shell mesh/Level": choice.level, "Time/Step": choice.step, "Solver/Interface": choice.interface, "Time/Scheme": choice.scheme,
              "Time/Tolerance": choice.tolerance, "Scene/Boundary": choice.boundary, "Scene/Box side": choice.side, "Solver/Newton tolerance": choice.newton,
              "Solver/Linear tolerance": choice.linear, "Solver/Method": choice.method, "Solver/Coupling": choice.coupling, "Time/Steady tolerance": choice.stop}
    if choice.stop:
        wanted["Scene/End time"] = STOP_END
    return {name: value if isinstance(value, str) else f"{value:g}" for name, value in wanted.items()}


def name(choice):
    """One word a choice: mesh and step, and what is not as usual."""
    if choice.target:
        return f"target{choice.target:g}"
    usual = Choice(0, 0, 0)
    words = [f"h{choice.cells}", f"l{choice.level}", f"dt{choice.step:g}"]
    for field, word in (("interface", ""), ("scheme", ""), ("tolerance", "tol"), ("boundary", ""), ("side", "box"), ("newton", "newton"), ("linear", "linear"), ("method", ""), ("coupling", ""),
                        ("stop", "stop")):
        value = getattr(choice, field)
        if value != getattr(usual, field):
            words.append(word + (value.replace(" ", "-") if isinstance(value, str) else f"{value:g}"))
    return "_".join(words)


def base(scene, full):
    """What the sweeps of one cause start from."""
    return Choice(64, 3, scene.step) if full else Choice(32, 2, 0.1)


def sweeps(scene, full, schemes, has_dial):
    """The points of a scene. `schemes`: values of Time/Scheme; has_dial: whether the program knows Accuracy/Target error."""
    start = base(scene, full)
    result = [Point("joint", 10 / cells, Choice(cells, level, step)) for cells, level, step in JOINT[:4 if full else 3]]

    def add(cause, field, values, origin=start):
        result.extend(Point(cause, 10 / value if field == "cells" else 0.5**value if field == "level" else value, origin._replace(**{field: value})) for value in values)

    add("cells", "cells", [16, 32, 64, 128] if full else [16, 32, 64])
    add("control mesh", "level", [1, 2, 3, 4] if full else [1, 2, 3])
    add("step", "step", [0.4, 0.2, 0.1, 0.05, 0.025] if full else [0.4, 0.2, 0.1, 0.05])
    for cells, level, _ in JOINT[1:] if full else JOINT[:2]:
        add("plain interface", "cells", [cells], start._replace(level=level, interface="plain"))
    for scheme in schemes:
        if scheme != start.scheme:
            add(scheme, "step", [0.4, 0.2, 0.1] if full else [0.4, 0.2], start._replace(scheme=scheme))
    add("tolerance of steps", "tolerance", [1e-2, 3e-3, 1e-3, 3e-4, 1e-4] if full else [1e-3, 1e-4], start._replace(step=0.4))
    add("unbounded box", "side", [5, 7.5, 10])
    add("box between faces", "side", [20, 40] if full else [20], start._replace(boundary="faces"))
    result.append(Point("box between faces", math.inf, start))
    add("Newton tolerance", "newton", [1e-3, 1e-4, 1e-5, 1e-6] if full else [1e-3, 1e-4, 1e-5])
    add("linear tolerance", "linear", [0.5, 0.1, 0.01] if full else [0.1, 0.01])
    if scene.steady:
        add("stop", "stop", [1e-2, 1e-3, 1e-4] if full else [1e-2, 1e-3])
    small = Choice(32, 2, 0.1)  # for comparison only: these are dear
    if full and scene.viscosity_ratio == 1:
        add("assembled solver", "step", [0.1], small._replace(method="assembled"))
    if full:
        add("explicit coupling", "step", [0.01, 0.005] if scene.viscosity_ratio == 1 else [0.01], small._replace(coupling="explicit"))
    if has_dial:
        add("target error", "target", [1e-2, 3e-3, 1e-3] if full else [1e-2, 3e-3], Choice(0, 0, 0))
    return result


def schemes_and_dial(printed):
    """(values of Time/Scheme, whether Accuracy/Target error exists) from what --print-parameters prints."""
    section = printed.partition("subsection Time\n")[2].partition("\nend")[0]
    comment = " ".join(line.strip("# ") for line in section.partition("set Scheme")[0].splitlines())
    allowed = re.search(r"Allowed: one of (.*?)\. Default", comment)
    if not allowed:
        raise ValueError("--print-parameters does not say what Time/Scheme may be")
    accuracy = printed.partition("subsection Accuracy\n")[2].partition("\nend")[0]
    return [word.strip() for word in allowed[1].split(",")], "set Target error" in accuracy
