# SPDX-License-Identifier: LGPL-2.1-or-later
# Part of Tanktread: tables of the report of the scenes of Le (2010).
"""What the runs of a figure have come to, and by what means: functions of the figure's results that return Markdown."""

import math

import numpy as np

import run_files
import values
from report_parts import Value, show, table

REFERENCE_TIMES = (0.25, 0.75)  # of the relaxation
WHOLE_RUN = ["D, whole run", "θ/π, whole run"]


def short(result):
    """Name of the run, and of the resolution at which it was done."""
    return result.name.split("/")[1] + (f", {result.resolution}" if result.state() == "done" else "")


def whole_run(result, reference):
    """Two cells: bar over the whole run, and largest difference from the reference."""
    shown = lambda value, is_angle: show(value) if math.isnan(value) else f"{value:.5f}" if is_angle else f"{100 * value:.2g} %"  # noqa: E731
    return [f"± {shown(bar, k == 1)}" + ("" if math.isnan(error) else f" ({shown(error, k == 1)})") for k, (bar, error) in enumerate(values.whole_run(result, reference))]


def compared(rows):
    """How many of the differences from a reference in these rows are within the bars."""
    found = [cell.is_within_bar for row in rows for cell in row if isinstance(cell, Value) and cell.is_compared]
    return f"\n{sum(found)} of the {len(found)} differences in brackets that stand beside an error bar are within it.\n" if found else ""


def made(head, rows):
    return table(head, rows) + compared(rows) if rows else ""


def relaxation(results):
    """Semi-axes at the times for which there is a reference, and the end of each run."""
    rows = []
    for result in results:
        if not result.series:
            continue
        reference = result.reference()
        row = [short(result)]
        for time in REFERENCE_TIMES:
            for name in ("L", "B", "W"):
                row.append(values.at(result, name, time, values.value_at(reference[0], name, time) if reference else math.nan))
        end = {name: result.series[name][-1] for name in ("time", "L", "B")}
        rows.append(row + [f"t = {end['time']:g}: {end['L'] / end['B'] - 1:.1e}"])
    return made(["run"] + [f"{name}({time:g})" for time in REFERENCE_TIMES for name in ("L", "B", "W")] + ["L/B − 1 at the end"], rows)


def steady(results):
    rows = []
    for result in results:
        if not result.series:
            continue
        reference = result.reference()
        wanted = [reference[0][name][-1] if reference else math.nan for name in ("D", "theta")]
        known = "limits" if math.isfinite(result.number("D_limit")) else "last values"
        rows.append([short(result), f"{result.summary.get('mode', '–')}, {known} at {show(result.series['time'][-1], 3)}", values.limit(result, "D", "D", wanted[0]),
                     values.limit(result, "theta", "theta", wanted[1]), *(values.limit(result, name, name) for name in ("intrinsic_viscosity", "N1", "N2")),
                     *whole_run(result, reference and reference[0])])
    return made(["run", "motion", "D", "θ/π", "[η]", "N₁", "N₂", *WHOLE_RUN], rows)


def motion(results):
    rows = []
    for result in results:
        if not result.series:
            continue
        reference = result.reference()
        wanted = (reference[1] if reference else None) or {}
        frequency = "tumbling_frequency" if result.summary.get("mode") == "tumbling" else "tank_treading_frequency"
        rows.append([short(result), result.summary.get("mode", "–") + (f" (reference: {wanted['mode']})" if wanted else ""),
                     *(values.of_summary(result, name, wanted.get(name, math.nan)) for name in ("D_minimum", "D_maximum", "D_period")), values.of_summary(result, frequency),
                     *(values.mean(result, name) for name in ("intrinsic_viscosity", "N1", "N2")), f"{values.area_change(result)} %",
                     *whole_run(result, reference and reference[0])])
    return made(["run", "motion", "D min", "D max", "period of D", "turns per 1/γ̇", "mean [η]", "mean N₁", "mean N₂", "area changes by", *WHOLE_RUN], rows)


def resources(results):
    """What was chosen for each run, and what it took."""
    rows = []
    for result in results:
        if not result.series:
            continue
        cell, level, tolerance = (run_files.number(result.chosen.get(name, "nan")) for name in ("Fluid mesh/Finest cell", "Shell mesh/Level", "Time/Tolerance"))
        points = "–" if math.isnan(level) else str(10 * 4 ** int(level) + 2)
        rows.append([short(result), show(cell, 3), points, str(int(result.series["cells"].max())), "fixed steps" if tolerance == 0 else show(tolerance, 2), str(len(result.series["time"]) - 1),
                     f"{np.abs(result.series['volume_error']).max():.0e}", show(result.record.get("cpu_seconds"), 3)])
    return table(["run", "h/a", "control points", "cells", "tolerance of steps, a", "steps", "volume error", "CPU s"], rows) if rows else ""
