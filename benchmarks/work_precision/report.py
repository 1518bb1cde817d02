# SPDX-License-Identifier: LGPL-2.1-or-later
# Part of Tanktread: the page of errors against costs; every number in it comes from points.csv.
"""Markdown: what limits each scene, what reaches an error most cheaply, powers, all points."""

import math
import statistics

import norms
import sweeps
from chart import dependable
from report_parts import table

SYMBOLS = {"D": "D", "theta": "θ", "viscosity": "[η]"}
BOUNDS = (0.03, 0.01, 0.003, 0.001, 0.0003)


def percent(value):
    return "–" if not math.isfinite(value) else f"{100 * value:.2g} %"


def plain(value, digits=3):
    return "–" if not math.isfinite(value) else f"{value:.{digits}g}"


def scenes_in(rows):
    return [scene for scene in sweeps.SCENES if any(row["scene"] == scene.name for row in rows)]


def of(rows, scene, cause=None):
    return [row for row in rows if row["scene"] == scene.name and row["outcome"] == "done" and cause in (None, row["cause"])]


def base_run(notes, scene):
    return sweeps.name(sweeps.base(scene, notes.get("mode") == "full"))


def share(rows, start, quantity="D"):
    """What a sweep says that its cause is worth at the base run: the differences from there to its finest point, added up; NaN where the base is the finest or not in it."""
    runs = [row["run"] for row in rows]
    if start not in runs or runs.index(start) == len(runs) - 1:
        return math.nan
    found = [row[f"difference_{quantity}"] for row in rows[runs.index(start):-1]]
    return sum(found) if all(map(math.isfinite, found)) else math.nan


def limits(notes, rows, quantity):
    """Table of what each cause is worth at the base runs, the largest of a scene in bold."""
    scenes, body = scenes_in(rows), []
    causes = [cause for cause in {row["cause"]: None for row in rows} if cause != "joint"]
    shares = {scene.name: {cause: share(of(rows, scene, cause), base_run(notes, scene), quantity) for cause in causes} for scene in scenes}
    most = {name: max(filter(math.isfinite, found.values()), default=math.nan) for name, found in shares.items()}
    for cause in causes:
        values = [(shares[scene.name][cause], most[scene.name]) for scene in scenes]
        if any(math.isfinite(value) for value, _ in values):
            body.append([cause, *(f"**{percent(value)}**" if value == largest > 0 else percent(value) for value, largest in values)])
    titles = {"error_": "error, all times", "end_error_": "error at the end"}
    for start, title in titles.items():
        body.append([f"*{title}*", *(percent(at_base(notes, rows, scene, start + quantity)) for scene in scenes)])
    if quantity == "D":
        body.append(["*error of the period*", *(percent(at_base(notes, rows, scene, "period_error")) for scene in scenes)])
    return table([SYMBOLS[quantity], *(f"{scene.title}; `{base_run(notes, scene)}`" for scene in scenes)], body)


def at_base(notes, rows, scene, column):
    return next((row[column] for row in of(rows, scene) if row["run"] == base_run(notes, scene)), math.nan)


def advice(notes, rows, scene):
    """What reaches an error of D most cheaply, where the truth is known that well."""
    doubt = float(notes.get(f"doubt of {scene.name} D", "nan"))
    found = dependable(notes, rows, scene, "error_D")
    said, missed = {}, []
    for bound in BOUNDS:
        if doubt > bound / 2 or math.isnan(doubt):
            continue
        best = norms.cheapest([point[0] for point in found], [point[1] for point in found], bound)
        if best is None:
            missed.append(percent(bound))
        else:
            said.setdefault(found[best], []).append(percent(bound))
    sentences = [f"within {' and '.join(bounds)}: `{run}`, {plain(cost)} CPU s ({percent(error)})" for (cost, error, run), bounds in said.items()]
    text = f"**{scene.title}.** " + ("Cheapest for D at all times " + "; ".join(sentences) + "." if sentences else "")
    if missed:
        text += f" Not reached: {', '.join(missed)}."
    if not sentences and not missed:
        text += "What is true is not known well enough for advice."
    return text + (f" What is true is itself uncertain by {percent(doubt)}." if doubt > 0 else "") + "\n"


def dial(rows):
    """What runs with a target error have reached: "" if there are none."""
    body = []
    for scene in scenes_in(rows):
        for row in of(rows, scene, "target error"):
            body.append([scene.title, percent(row["value"]), percent(row["error_D"]), plain(row["error_D"] / row["value"], 2), percent(row["error_theta"] * 0.25), percent(row["end_error_D"]),
                         plain(row["cells"], 6), plain(row["control_points"], 6), plain(row["steps"], 6), plain(row["cpu_seconds"])])
    head = ["scene", "Accuracy/Target error", "error of D, all times", "over the target", "error of θ/π, all times, absolute", "error of D at the end", "cells", "control points", "steps", "CPU s"]
    return "\n## Target error\n\nRuns with nothing set but the target and the boundary. The dial also ends a run where it holds its shape for steady: such a run is compared, and costs, as long as it lasts.\n\n" + table(head, body) if body else ""


def powers(rows):
    """Powers of the differences with the parameter, of the error with the parameter and with CPU seconds, where these differ enough to have one."""
    body = []
    for scene in scenes_in(rows):
        for cause in {row["cause"]: None for row in rows}:
            column = "end_error_D" if cause == "stop" else "error_D"
            series = [row for row in of(rows, scene, cause) if math.isfinite(row[column])]
            if len({row["value"] for row in series}) < 2:
                continue
            value, error, cpu, change = ([row[key] for row in series] for key in ("value", column, "cpu_seconds", "difference_D"))
            found = [norms.power(value[:-1], change[:-1]), norms.power(value, error) if varies(error, 1.2) else math.nan, norms.power(cpu, error) if varies(cpu, 1.5) and varies(error, 1.2) else math.nan]
            body.append([scene.name, cause, f"{value[0]:.3g} … {value[-1]:.3g}", f"{percent(error[0])} … {percent(error[-1])}", *map(plain, found)])
    return table(["scene", "cause", "parameter", "error of D (stop: at the end)", "power of differences", "power of the error", "power of the error with CPU s"], body)


def varies(values, factor):
    return max(values) > factor * min(values)


def all_points(rows, scene):
    body = []
    for row in [row for row in rows if row["scene"] == scene.name]:
        errors = [percent(row[key]) for key in ("error_D", "error_theta", "error_viscosity", "end_error_D", "end_error_theta", "end_error_viscosity", "period_error")]
        body.append([row["cause"], f"`{row['run']}`", *(errors if row["outcome"] == "done" else [row["outcome"].replace("|", "/")] + ["–"] * 6), plain(row["cpu_seconds"]),
                     plain(row["wall_seconds"]), f"{row['steps']:.0f}" if row["steps"] == row["steps"] else "–", f"{row['cells']:.0f}" if row["cells"] == row["cells"] else "–",
                     plain(row["newton_iterations"]), plain(row["linear_iterations"])])
    return table(["cause", "run", "D", "θ", "[η]", "D, end", "θ, end", "[η], end", "period", "CPU s", "wall s", "steps", "cells", "Newton a step", "linear a step"], body)


HEAD = """# Work and precision

Error against CPU seconds of one rank for four capsules in unbounded shear flow, one cause of error at a time and all together. Made by

    benchmarks/work_precision/run.py --build build/release --doc{quick}

on {machine}, {date}, runs at a time: {jobs}; {program}. Wall over CPU seconds: {disturbed} in the middle, 1 where no neighbour disturbs. Runs are named by cells per 10a at the shell (h), level of the control mesh (l), step (dt), and what else differs from the enriched
interface, BDF3 without tolerance, unbounded liquid in a box of 7.5a, tolerances 10⁻⁴ (Newton) and 0.1 (linear), matrix-free and implicit.

- **Errors at all times** are the largest difference at the rows of a run, those of the first steps included, over the largest D or [η]; of θ over π/4. **At the end**: of the last row from
  the steady state. **Period**: time between the last two maxima of D.
- **What is true**: for D and θ the boundary-integral solutions of `benchmarks/reference`; for [η], and for the biconcave disk altogether, what the two finest runs of the sweep "joint" tend to
  with second order. That is not independent of the program, and the finest run's own error follows from it, by which what is true has to be doubted:
  {doubts}.
- **joint** halves cells, control mesh and step together: (h, l, dt) = {joint}.

![error against CPU seconds](FIGURE)

Grey: the Pareto front. Where a run has a larger error than the next coarser one of its sweep, errors of different sign have cancelled in the coarser one; front and advice give that the larger error, and to plain interface, backward Euler and explicit coupling none below that of the run in the middle. Shaded: below the uncertainty of what is true. Crosses: another code, front tracking on an octree (explicit, λ = 1, no bending,
thus a simpler scene), for γ̇t = 1 only and not for the whole run: cells of a/4 with loosened tolerances 26 s (D −12 %), a/8 with default tolerances 835 s (error not known), a/16, its default, about 5000 s (1 to 5 %).
"""


def neighbours(rows):
    """Median of wall over CPU seconds of the longer half of the runs."""
    costs = sorted((row["cpu_seconds"], row["wall_seconds"]) for row in rows)
    return statistics.median(wall / cpu for cpu, wall in costs[len(costs) // 2:]) if costs else math.nan


def page(notes, rows, figure):
    doubts = "; ".join(f"{scene.title}: {', '.join(f'{SYMBOLS[quantity]} {percent(value)}' for quantity, value in values)}" for scene in scenes_in(rows) if (values := [
        (quantity, float(notes[f"doubt of {scene.name} {quantity}"])) for quantity in norms.QUANTITIES if float(notes.get(f"doubt of {scene.name} {quantity}", 0)) > 0]))
    text = HEAD.format(quick=" --quick" if notes.get("mode") == "quick" else "", machine=notes.get("machine", ""), date=notes.get("date", ""), jobs=notes.get("runs at a time", ""),
                       program=notes.get("program", ""), disturbed=plain(neighbours(rows)), doubts=doubts or "not known yet", joint=", ".join(f"({c}, {l}, {s:g})" for c, l, s in sweeps.JOINT)).replace("FIGURE", figure)
    text += "\n## What limits\n\nChange (largest over all times) from the run at the head of a column to the finest of each sweep: what a cause is worth there; below the errors of that run. "
    text += "Of a cause of second order that ends with half the parameter, 3/4 are seen.\n\n" + "\n".join(limits(notes, rows, quantity) for quantity in norms.QUANTITIES)
    text += "\n## Cheapest\n\n" + "\n".join(advice(notes, rows, scene) for scene in scenes_in(rows))
    text += dial(rows)
    text += "\n## Powers\n\nBy least squares in logarithms; differences from one value to the next show the cause alone, errors also what else is wrong.\n\n" + powers(rows)
    for scene in scenes_in(rows):
        text += f"\n## {scene.title}\n\n" + all_points(rows, scene)
    return text
