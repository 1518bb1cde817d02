# SPDX-License-Identifier: LGPL-2.1-or-later
# Part of Tanktread: the report of the scenes of Le (2010).
"""write(file, results, ...): what the runs show, figure by figure, and for each statement in the text of Le (2010)."""

import math

import numpy as np

import motion
import report_parts
import runs
import statements
from report_parts import difference, show, table

TITLES = {
    "fig01": "Relaxation in a liquid at rest",
    "fig02": "Spheres in shear: sections of the deformed shells",
    "fig03": "Spheres in shear: deformation and inclination",
    "fig04": "Spheres with viscosity ratio 5",
    "fig05": "Oblate spheroid, G = 0.05",
    "fig06": "Oblate spheroid, G = 0.005",
    "fig07": "Oblate spheroid, G = 0.008",
    "fig08": "Oblate spheroid, G = 0.05, viscosity ratio 5",
    "fig09": "Biconcave capsule, G = 0.5, viscosity ratio 2",
    "fig10": "Biconcave capsule, G = 0.5, viscosity ratio 2: snapshots",
    "fig11": "Biconcave capsule, G = 0.1, viscosity ratio 4",
    "fig12": "Biconcave capsule, G = 0.1, viscosity ratio 4: snapshots",
}
REFERENCE_TIMES = (0.25, 0.75)


def short(result):
    return result.name.split("/")[1] + (f", {result.resolution}" if result.state() == "done" else "")


def not_done(results):
    """Rows for runs without a result."""
    return [(short(result), result.state()) for result in results if result.state() != "done"]


def relaxation_table(results):
    """Semi-axes at the times for which there is a reference, and the end of each run."""
    rows = []
    for result in results:
        if not result.series:
            continue
        reference = result.reference()
        cells = [short(result)]
        for time in REFERENCE_TIMES:
            for name in ("L", "B", "W"):
                wanted = runs.interpolated(reference[0]["time"], reference[0][name], time) if reference else math.nan
                cells.append(difference(result.at(time, name), wanted))
        last = {name: result.series[name][-1] for name in ("time", "L", "B")}
        cells += [f"t = {last['time']:g}: {last['L'] / last['B'] - 1:.1e}", f"{np.abs(result.series['volume_error']).max():.0e}", str(len(result.series["time"]) - 1)]
        rows.append(cells)
    head = ["run"] + [f"{name}({time:g})" for time in REFERENCE_TIMES for name in ("L", "B", "W")] + ["L/B − 1 at the end", "volume error", "steps"]
    return table(head, rows) if rows else ""


def steady_table(results):
    rows = []
    for result in results:
        if not result.series:
            continue
        reference = result.reference()
        last = {name: result.series[name][-1] for name in ("D_xz", "theta", "intrinsic_viscosity", "N1", "N2", "time")}
        wanted = [reference[0][name][-1] if reference else math.nan for name in ("D", "theta")]
        rows.append([short(result), result.summary.get("mode", "–"), show(last["time"], 3), difference(last["D_xz"], wanted[0]), difference(last["theta"], wanted[1]),
                     show(last["intrinsic_viscosity"], 4), show(last["N1"], 3), show(last["N2"], 3), f"{np.abs(result.series['volume_error']).max():.0e}"])
    head = ["run", "motion", "end", "D (from the reference)", "θ/π (from the reference)", "[η]", "N₁", "N₂", "volume error"]
    return table(head, rows) if rows else ""


def motion_table(results):
    rows = []
    for result in results:
        if not result.series:
            continue
        reference = result.reference()
        wanted = (reference[1] if reference else None) or {}
        cells = [short(result), result.summary.get("mode", "–") + (f" (reference: {wanted['mode']})" if wanted else "")]
        cells += [difference(result.number(name), wanted.get(name, math.nan)) for name in ("D_minimum", "D_maximum", "D_period")]
        frequency = result.number("tumbling_frequency") if result.summary.get("mode") == "tumbling" else result.number("tank_treading_frequency")
        late = result.series["time"] >= result.number("from") if not math.isnan(result.number("from")) else slice(None)
        cells += [show(frequency, 4), show(float(np.mean(result.series["intrinsic_viscosity"][late])), 4), f"{np.abs(result.series['volume_error']).max():.0e}",
                  f"{100 * np.abs(result.series['area'] / result.series['area'][0] - 1).max():.2g} %"]
        rows.append(cells)
    head = ["run", "motion", "D min", "D max", "period of D", "turns per 1/γ̇", "mean [η]", "volume error", "area changes by"]
    return table(head, rows) if rows else ""


def evenness(results):
    """How far the maxima of D lie apart, in our runs and in the reference: how periodic either is."""
    lines = []
    for result in results:
        reference = result.reference() if result.series else None
        if not reference or not reference[1]:
            continue
        ours = motion.summary(result.series["time"], result.series["D_xz"], result.series["theta"], result.series["alpha"])
        spread = [f"{min(found['D_maxima']):.5f} to {max(found['D_maxima']):.5f}" for found in (ours, reference[1]) if len(found["D_maxima"]) > 1]
        if len(spread) == 2:
            lines.append(f"{short(result)}: maxima of D from {spread[0]}, of the reference from {spread[1]}")
    text = "Without bending the shell carries compressive tensions and wants to wrinkle; how finely it can depends on its mesh, and the reference is uneven too. "
    return text + "; ".join(lines) + ".\n" if lines else ""


NOTES = {"fig07": evenness}
TABLES = {"fig01": relaxation_table, "fig02": None, "fig03": steady_table, "fig04": steady_table, "fig10": None, "fig12": None}


def heading(figure):
    return f"## Fig. {int(figure[3:])}: {TITLES[figure]}\n"


def section(figure, results, figures_folder):
    wanted = results.of(figure)
    text = [heading(figure), f"![{TITLES[figure]}]({figures_folder}/{figure}.png)\n"]
    make = TABLES.get(figure, motion_table)
    if make:
        text.append(make(wanted))
    if figure in NOTES:
        text.append(NOTES[figure](wanted))
    missing = not_done(wanted)
    if missing:
        text.append(table(["run without a result", "why"], missing))
    return "\n".join(part for part in text if part)


INTRODUCTION = """# The scenes of Le (2010)

D. V. Le, *Effect of bending stiffness on the deformation of liquid capsules enclosed by thin shells in shear flow*, Phys. Rev. E 82, 016318 (2010), computed with this code.
This page is written by

    benchmarks/le_2010/run.py [--quick | --full] --update-doc

from the results that it finds; the parameter files are in `benchmarks/le_2010`. Each run is shown at the finest resolution at which it was done: {resolutions}. In shear, bending has the form
`moment-only`, the paper's. Dashed curves and the
differences in brackets are from the boundary-integral solutions of `benchmarks/reference`, which are for an unbounded liquid; what the box does is part of the difference. Where there is no
bracket there is no such solution. Motion, periods and frequencies are judged by the rule of `doc/theory.md`, section 8.2.

Choices where the paper leaves one: "inclined at 45°" is read as the long axis of the section at 45° to the flow (`Inclination = 0.25`); oblate and biconcave shells bend about their
initial curvature, spheres and relaxing shells about a flat one; Skalak's C is 150 in figs. 9 and 10 and 100 in figs. 11 and 12. In the relaxation scenes the membrane is absent (`Membrane law = none`): with one that is at ease in the initial
shape the capsule would not become a sphere. They bend in the form `variational`: the forces of `moment-only` along the shell (theory, (16a)) pull the material, which no membrane holds, together at the
rim, until the mesh there is degenerate; the run `ellipsoid_moment_only` shows how far that goes.
"""


STATEMENTS_HEADING = "## What the paper says, and what these runs show\n"


def former(file):
    """What the report says so far: {heading: section} and {(figure, statement): what was seen}."""
    sections = report_parts.former_sections(file)
    rows = report_parts.rows_of(sections.get(STATEMENTS_HEADING, ""))
    return sections, {(row[0], row[1]): row[2] for row in rows if len(row) == 3}


def finer_runs(file, results, figure):
    """Names of the runs of a figure that the file shows at a finer resolution than the results."""
    sections, order = report_parts.former_sections(file), ["not run", *runs.RESOLUTIONS]
    finer = []
    for result in results.of(figure):
        owner, name = result.name.split("/")
        rows = report_parts.rows_of(sections.get(heading(owner), ""))
        before = [cells[0][len(name) + 2:] for cells in rows if cells[0].startswith(f"{name}, ")]
        now = result.resolution if result.state() == "done" else "not run"
        finer += [name] if any(resolution in order and order.index(resolution) > order.index(now) for resolution in before) else []
    return finer


def figures_of(where):
    """Figures that a statement is about: "9, 10", "9–12", "all"."""
    if where == "all":
        return runs.figure_names()
    ranges = [[int(number) for number in part.split("–")] for part in where.split(", ")]
    return [f"fig{number:02d}" for part in ranges for number in range(part[0], part[-1] + 1)]


def write(file, results, figures, figures_folder, keep_others=False):
    """The report of these figures, drawn in `figures_folder` as seen from the file. Sections of other figures, and what was seen of them, stay as they are in
    the file or are left out."""
    sections, seen_before = former(file) if keep_others else ({}, {})
    described = "; ".join(f"`{name}` has {runs.described(settings)}" for name, settings in runs.RESOLUTIONS.items())
    text = [INTRODUCTION.format(resolutions=described)]
    text += [section(figure, results, figures_folder) if figure in figures else sections.get(heading(figure), "") for figure in runs.figure_names()]
    rows = []
    for where, said, look in statements.STATEMENTS:
        seen = look(results) if set(figures_of(where)) & set(figures) else "not computed"
        if (where, said) in seen_before and (seen == "not computed" or not set(figures_of(where)) <= set(figures)):
            seen = seen_before[where, said]
        rows.append((where, said, seen))
    text += [STATEMENTS_HEADING, table(["figure", "in the paper", "here"], rows)]
    file.parent.mkdir(parents=True, exist_ok=True)
    file.write_text("\n".join(part for part in text if part))
    print(f"report: {file}")
