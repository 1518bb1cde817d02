# SPDX-License-Identifier: LGPL-2.1-or-later
# Part of Tanktread: the report of the scenes of Le (2010).
"""write(file, results, ...): what the runs show, figure by figure, and for each statement in the text of Le (2010)."""

import motion
import report_parts
import runs
import statements
import tables
from report_parts import table
from tables import short

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


def not_done(results):
    """Rows for runs without a result, or without error bars."""
    rows = [(short(result), result.state()) for result in results if result.state() != "done"]
    return rows + [(short(result), f"no error bars: {result.record['message']}") for result in results if result.state() == "done" and result.record["exit_code"] != 0]


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
TABLES = {"fig01": tables.relaxation, "fig02": None, "fig03": tables.steady, "fig04": tables.steady, "fig10": None, "fig12": None}


def heading(figure):
    return f"## Fig. {int(figure[3:])}: {TITLES[figure]}\n"


def section(figure, results, figures_folder):
    wanted = results.of(figure)
    text = [heading(figure), f"![{TITLES[figure]}]({figures_folder}/{figure}.png)\n"]
    make = TABLES.get(figure, tables.motion)
    if make:
        text += [make(wanted), tables.resources(wanted)]
    if figure in NOTES:
        text.append(NOTES[figure](wanted))
    missing = not_done(wanted)
    if missing:
        text.append(table(["run without a result or bars", "why"], missing))
    return "\n".join(part for part in text if part)


INTRODUCTION = """# The scenes of Le (2010)

D. V. Le, *Effect of bending stiffness on the deformation of liquid capsules enclosed by thin shells in shear flow*, Phys. Rev. E 82, 016318 (2010), computed with this code.
This page is written by

    benchmarks/le_2010/run.py [--quick | --fair | --full] --update-doc

from the results that it finds. The parameter files, in `benchmarks/le_2010`, hold physics and times; cells, control mesh, steps and tolerances are chosen by the dial (`accuracy.md`) for the largest
relative error of D that is wanted: {resolutions}.
Each run is shown at the finest of them at which it was done. The paper has walls at z = ±5a and is periodic along x and y; here the liquid is unbounded (`theory.md`, section 3.4).

**Error bars** are those of a study (`theory.md`, section 8.4): the difference from a companion of four times the target, for limits also the bar of the limit, and at least what the whole curves of both say, since single numbers may
agree by chance. "Whole run" is the same for the curve of D, at all times and relative to its largest value, and of θ/π, weighted with D over its largest value. Below each table stands how many bars
hold. A membrane that wrinkles converges to nothing: its bars say little. Runs with fixed steps, in fig. 1, have no bars, since a companion could not tell
what the steps do.

In brackets, and as dashed curves, are differences from the boundary-integral solutions of `benchmarks/reference`: of limits from the last row of the solution, of extremes and periods from its own,
of curves the largest at any time. Where there is no bracket there is no such solution. Motion, periods and frequencies are judged by the rule of `theory.md`, section 8.2; means are over whole periods
of D. CPU seconds are of one run with its companion.

In shear, bending has the form `moment-only`, the paper's.

Choices where the paper leaves one: "inclined at 45°" is read as the long axis of the section at 45° to the flow (`Inclination = 0.25`); oblate and biconcave shells bend about their
initial curvature, spheres and relaxing shells about a flat one; Skalak's C is 150 in figs. 9 and 10 and 100 in figs. 11 and 12. In the relaxation scenes the membrane is absent (`Membrane law = none`): with one that is at ease in the initial
shape the capsule would not become a sphere. They bend in the form `variational`, and in the paper's own, `moment-only`, in the runs of that name: its forces along the shell (theory, (16a)) pull the material, which no membrane
holds, together at the rim, so there the control points do not go with the material but stay evenly spread (theory, section 5.4).
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
    described = ", ".join(f"`{name}` {target}" for name, target in runs.RESOLUTIONS.items())
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
