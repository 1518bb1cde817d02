# SPDX-License-Identifier: LGPL-2.1-or-later
# Part of Tanktread: the page of outcomes; every number in it comes from outcomes.csv.
"""Markdown: what must not be, then map by map outcomes, costs, what failed with the program's own sentence, and the cheapest run of each kind of trouble."""

import collections
import math

import explicit_limit
import maps
import outcomes
from report_parts import show, table

RIGHT = 0.02  # of D: what explicit and implicit steps are compared at


def percent(value):
    return "" if math.isnan(value) else f" {100 * value:.2g} %"


def text_of(row):
    """"halves 3, warned: gap, 4.1 %"."""
    words = row["outcome"] + (f" {row['halved']:.0f}" if row["outcome"] == "halves" else "")
    if row["outcome"] in ("ends", "limit") and row["time"] >= 0:
        words += f" at {row['time']:.3g}"
    words += f" ({row['warnings'].replace(' ', ', ')})" if row["warnings"] else ""
    return (f"**{words}**" if row["outcome"] in outcomes.BAD else words) + percent(row["error_D"])


def costs_of(row):
    return "–" if math.isnan(row["newton_a_step"]) else f"{row['newton_a_step']:.3g} / {row['linear_a_step']:.3g} / {show(row['cpu_a_unit'], 2)}"


def matrix(map_, found, show_row):
    of = {(row["row"], row["column"]): row for row in found}
    columns = [column.label for column in map_.columns if any(row["column"] == column.label for row in found)]
    body = [[line.label, *(show_row(of[line.label, label]) if (line.label, label) in of else "not made" for label in columns)] for line in map_.rows]
    return table([f"{map_.down} \\ {map_.across}", *columns], body)


def command(row):
    scene = next(map_.scene for map_ in maps.MAPS if map_.name == row["map"])
    return f"tanktread benchmarks/stability/{scene}.prm " + " ".join(f'--set "{setting}"' for setting in row["settings"].split(" | "))


def kinds(found):
    """{what went wrong: rows}: outcomes that are not "holds", and each warning."""
    result = collections.defaultdict(list)
    for row in found:
        if row["outcome"] not in ("holds", "warned"):
            result[row["outcome"]].append(row)
        for warning in row["warnings"].split():
            result["warning " + warning].append(row)
    return result


def cheapest(found):
    """Of each kind of trouble how many runs had it and the run that shows it in the fewest CPU seconds."""
    lines = []
    for kind, rows in sorted(kinds(found).items()):
        row = min(rows, key=lambda row: row["cpu_seconds"])
        said = f" “{row['message']}”" if row["message"] else ""
        lines.append(f"- {kind}: {len(rows)} of {len(found)}; cheapest {row['row']} at {row['column']}, {show(row['cpu_seconds'], 2)} CPU s: `{command(row)}`.{said}")
    return "\n".join(lines) + "\n" if lines else "Nothing failed and nothing was warned of.\n"


def cheapest_right(rows, map_name, khat):
    """Of the runs of a map with this kappa hat whose D is right to RIGHT, the one with the fewest CPU seconds a unit of time; None if there is none."""
    found = [row for row in rows if row["map"] == map_name and row["row"].split("κ̂ ")[-1] == khat and row["outcome"] in outcomes.FINISHED and not row["error_D"] > RIGHT]
    return min(found, key=lambda row: row["cpu_a_unit"], default=None)


def explicit_beside_implicit(rows):
    """Longest steps are the cheapest: what explicit ones cost at their limit, and what implicit ones do."""
    body = []
    for flow, title in (("shear", "shear"), ("relaxation", "relaxation")):
        for khat in map(str, maps.KHAT):
            explicit, implicit = cheapest_right(rows, f"explicit_{flow}", khat), cheapest_right(rows, f"schemes_{flow}", khat)
            texts = [f"{show(row['cpu_a_unit'], 2)} ({row['row'].split(',')[0] + ', ' if kind else ''}{row['column']})" if row else "none" for kind, row in enumerate((explicit, implicit))]
            body.append([title, khat, *texts, show(explicit["cpu_a_unit"] / implicit["cpu_a_unit"], 2) if explicit and implicit else "–"])
    return table(["flow", "κ̂", "explicit (step)", "implicit (scheme, step)", "ratio"], body)


def forbidden(rows):
    bad = [row for row in rows if row["outcome"] in outcomes.BAD]
    if not bad:
        return "None.\n"
    titles = {map_.name: map_.title for map_ in maps.MAPS}
    return table(["map", "row", "column", "outcome", "said", "command"], [[titles[row["map"]], row["row"], row["column"], row["outcome"], row["message"] or "–", f"`{command(row)}`"] for row in bad])


def overview(rows):
    names = [name for name in (*outcomes.GOOD, *outcomes.BAD) if any(row["outcome"] == name for row in rows)]
    body = []
    for map_ in maps.MAPS:
        found = [row for row in rows if row["map"] == map_.name]
        count = collections.Counter(row["outcome"] for row in found)
        n_all = len(maps.cells_of(map_, False))
        body.append([map_.title, *(count[name] or "" for name in names), n_all - len(found) or "", f"{sum(row['cpu_seconds'] for row in found):.0f}"])
    return table(["map", *names, "not made", "CPU s"], body)


def at_the_limit(rows):
    """The longest stable explicit step on a fine mesh, and what a run with it would cost; nothing if it has not been made."""
    found = explicit_limit.figures(rows)
    if not found:
        return ""
    body = [[row["coupling"], row["scheme"], show(row["step"], 3), show(row["steps"], 3), row["outcome"], show(row["D"], 5), show(row["cpu_a_step"], 3)] for row in rows]
    cheapest, truth = found["cheapest"], found["truth"]
    steps, seconds = found["implicit_step"] / found["explicit_step"], found["explicit_seconds"] / cheapest["cpu_seconds"]
    return f"""
## Explicit steps on a fine mesh

`sphere.prm` with G = 0.05, κ̂ = 0.0375, finest cells of 10a/128, 2562 control points, in unbounded liquid (box 7.5a). Explicit trials of {explicit_limit.STEPS} steps, halved until stable; implicit runs to γ̇t = {explicit_limit.END:g}.
Made by `benchmarks/stability/run.py --explicit-limit`.

- Longest stable steps: explicit {found["explicit_step"]:.3g}, implicit {found["implicit_step"]:g}: a ratio of {steps:.0f} (wanted: 300).
- To γ̇t = {explicit_limit.END:g} with D right to {100 * explicit_limit.RIGHT:g} %: explicit steps would take {found["explicit_seconds"]:.0f} CPU seconds (steps counted, the seconds of one measured), {cheapest["scheme"]} with steps of {cheapest["step"]:g} took
  {cheapest["cpu_seconds"]:.0f}, D within {100 * abs(cheapest["D"] / truth["D"] - 1):.2g} % of {truth["scheme"]} with {truth["step"]:g}, which took {truth["cpu_seconds"]:.0f}: 1/{seconds:.0f} of it (wanted: 1/50). The first flow is in the implicit runs' seconds.

""" + table(["coupling", "scheme", "γ̇Δt", "steps", "outcome", "D at the end", "CPU s a step"], body)


HEAD = """# Stability

How runs end where steps, meshes, materials and neighbours become too hard: maps of short runs on coarse meshes, one rank each. Made by

    benchmarks/stability/run.py --build build/release --doc{quick}

on {machine}, {date}, runs at a time: {jobs}; {program}; {runs} runs, {seconds} CPU seconds. CPU seconds are longer where neighbours compute: compare them within a map only.

- **holds**: done. **warned**: done, and the program has warned; which figure stands in brackets, without `worst_`: `limits.md` says what each means and what helps. **halves**: done, after so many attempts at a step that was halved. **ends**: exit code 2 with a
  sentence, results up to then kept. **refused**: exit code 1, nothing computed. **limit**: stopped by this script at its limit of CPU seconds while still making steps.
- Must not be: **wrong** (no warning, though D at the end is off by more than 10 % of its largest value, or energy rises in a liquid at rest by more than 10⁻⁶ of it), **nan**, **hang** (the limit without a step in the last half of the time), **crash** (a signal, or no sentence).
- Per cent: the difference of D at the end, over its largest value, from the last finished run of the group (the finest: the rightmost of a row; with several schemes the last scheme's).
  It is an error only as far as that run is right.

![outcomes](FIGURE)

“!”: warned; “½·n”: attempts that were halved.
"""


def page(notes, rows, figure):
    text = HEAD.format(quick=" --quick" if notes.get("mode") == "quick" else "", machine=notes.get("machine", ""), date=notes.get("date", ""), jobs=notes.get("runs at a time", ""),
                       program=notes.get("program", ""), runs=notes.get("runs", len(rows)), seconds=notes.get("CPU seconds", "?")).replace("FIGURE", figure)
    text += "\n## What must not be\n\n" + forbidden(rows)
    text += "\n## All maps\n\n“Not made”: runs of the full mode that are not in the table.\n\n" + overview(rows)
    text += ("\n## Explicit beside implicit steps\n\nCPU seconds a unit of time of the cheapest runs whose D is within "
             f"{100 * RIGHT:g} % of that of the finest steps; explicit runs are shorter, and compared among themselves.\n\n" + explicit_beside_implicit(rows))
    text += at_the_limit(explicit_limit.read())
    for map_ in maps.MAPS:
        found = [row for row in rows if row["map"] == map_.name]
        if not found:
            text += f"\n## {map_.title}\n\nNot made.\n"
            continue
        common = ", ".join(f"`{name} = {value}`" for name, value in map_.settings.items())
        text += f"\n## {map_.title}\n\n`{map_.scene}.prm`{', ' + common if common else ''}. {map_.note}\n\n" + matrix(map_, found, text_of)
        text += "\nNewton iterations a step / linear ones a step / CPU seconds a unit of time:\n\n" + matrix(map_, found, costs_of) + "\n" + cheapest(found)
    return text
