# SPDX-License-Identifier: LGPL-2.1-or-later
# Part of Tanktread: the report of the scenes of several capsules and other flows.
"""write(file, results, ...): measured against wanted, scene by scene."""

import numpy as np

import figures
import report_parts
import scenes
from report_parts import difference, show, table

SYMBOLS = {"z_moved": "z − z₀", "theta": "θ/π"}
INTRODUCTION = """# Several capsules, extension, parabola, wall

Scenes beside one capsule in shear, against the boundary-integral solutions of `benchmarks/reference`. This page is written by

    benchmarks/flows/run.py [--quick | --wide | --full | --unbounded | --unbounded-full] --update-doc

from the results that it finds; the parameter files are in `benchmarks/flows`. {resolutions}.
Neo-Hookean spheres with prestress, viscosity ratio 1, no bending; lengths in a, times in 1/rate. In brackets the difference from the reference at the same
time, by cubics through the rows of both; the reference has no box, so that the box is part of it: quick and wide differ by the box alone, between faces; unbounded is quick, and unbounded-full is
full, in a small box in unbounded liquid (`Scene/Boundary = unbounded`). Dashed in the figures: the reference.
"""


def values_table(name, results, wanted):
    """Quantities at the times of the scene, then the largest differences over the runs."""
    scene, rows = scenes.SCENES[name], []
    for quantity in scene.quantities:
        symbol = SYMBOLS.get(quantity, quantity)
        for time in scene.times:
            value = scenes.run_files.interpolated(wanted["time"], wanted[quantity], time)
            rows.append([f"{symbol} at {time:g}", show(value), *(difference(result.at(time, quantity), value, 1e-4) for result in results)])
        scale = np.nanmax(np.abs(wanted[quantity][wanted["time"] <= scene.times[-1]]))
        differences = [result.largest_difference(quantity, wanted) for result in results]
        shares = [f"{100 * value / scale:.3g} % at {time:.3g}" for value, time in differences]
        rows.append([f"{symbol}: largest difference", f"of at most {show(float(scale), 4)}", *shares])
    return table(["", "reference", *(result.resolution for result in results)], rows)


def pair_table(results, wanted):
    """What is said of a crossing: the offset over the diameter, how near they come; beside the published curve."""
    x, z = wanted["x"], wanted["z"]
    at_peak = scenes.peak(x, z)
    offsets = [result.offset() for result in results]
    peaks = [scenes.peak(*offset) for offset in offsets]
    rows = [["offset at first", show(float(z[0])), *(show(float(dz[0])) for _, dz in offsets)],
            ["largest offset", show(at_peak[1]), *(difference(peak[1], at_peak[1]) for peak in peaks)],
            ["where Δx/2a is", show(at_peak[0]), *(difference(peak[0], at_peak[0]) for peak in peaks)],
            ["offset at the end", show(float(z[-1])), *(f"{difference(float(dz[-1]), float(z[-1]))}, Δx/2a = {dx[-1]:.3g}" for dx, dz in offsets)]]
    gap = -scenes.peak(wanted["time"], -wanted["gap"])[1]
    gaps = [result.smallest_gap() for result in results]
    rows.append(["smallest gap", show(gap), *(difference(value, gap) for value in gaps)])
    (_, first), (where, largest), (_, last) = figures.PUBLISHED.values()
    published = [f"{first:.3f}", f"{largest:.3f}", f"{where:.2f}", f"{last:.3f}", "–"]
    head = ["", "published, ± 2 %", "reference", *(result.resolution for result in results)]
    return table(head, [[row[0], said, *row[1:]] for row, said in zip(rows, published)])


def heading(name):
    return f"## {scenes.SCENES[name].title}\n"


def spent(record):
    """Time of a run; of earlier ones the seconds that went by alone."""
    return f"{record['seconds']:.0f} s" + (f" ({record['cpu_seconds']:.0f} CPU s)" if "cpu_seconds" in record else "")


def section(name, results, figures_folder):
    """Results of the scene at all resolutions."""
    scene, shown = scenes.SCENES[name], [result for result in results if result.capsules]
    if not shown:
        states = "; ".join(f"{result.resolution}: {result.state()}" for result in results if result.record)
        return "\n".join([heading(name), scene.about + "\n", f"No results: {states}.\n"])
    wanted, notes = scenes.reference(name)
    text = [heading(name), scene.about + "\n", f"![{scene.title}]({figures_folder}/{name}.png)\n"]
    if name == "crossing_pair":
        text.append(pair_table([result for result in shown if len(result.capsules) > 1], wanted))
    text.append(values_table(name, shown, wanted))
    records = [(result, result.record) for result in results if result.record]
    runs = [f"{result.resolution} {spent(record)} on {record['ranks']} rank(s), {result.state()}" for result, record in records]
    errors = next(value for key, value in notes.items() if key.startswith("estimated errors"))
    text.append(f"Runs: {'; '.join(runs)}. Estimated errors of the reference: {errors}.\n")
    return "\n".join(text)


def resolutions_in(section_text):
    """Resolutions that a section shows."""
    heads = [cells for cells in report_parts.rows_of(section_text) if "reference" in cells]
    return {cell for cells in heads for cell in cells if cell in scenes.RESOLUTIONS}


def write(file, results, names, figures_folder, keep_others=False):
    """The report of these scenes, drawn in `figures_folder` as seen from the file; other sections stay as they are in the file or are left out. `results`:
    {name: [Result]}."""
    sections = report_parts.former_sections(file) if keep_others else {}
    resolutions = "; ".join(f"`{name}`: {scenes.described(name)}" for name in scenes.RESOLUTIONS)
    text = [INTRODUCTION.format(resolutions=resolutions)]
    text += [section(name, results[name], figures_folder) if name in names else sections.get(heading(name), "") for name in scenes.SCENES]
    file.parent.mkdir(parents=True, exist_ok=True)
    file.write_text("\n".join(part for part in text if part))
    print(f"report: {file}")
