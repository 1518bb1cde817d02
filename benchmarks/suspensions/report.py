# SPDX-License-Identifier: LGPL-2.1-or-later
# Part of Tanktread: the report of the scenes with several capsules.
"""write(file, results, groups, ...): what was measured beside what was published, group by group."""

import math

import numpy as np

import averages
import figures
import report_parts
import results as published
import run_files
from report_parts import Value, show, table

INTRODUCTION = f"""# Several capsules: pairs with inertia, suspensions

This page is written by

    benchmarks/suspensions/run.py [--quick | --full] --update-doc

from the results that it finds; the parameter files are in `benchmarks/suspensions`, what a run sets beside them is in its `run.json`. quick: cells of 0.29 to 0.43 a at
the shells and 162 control points; full: half of that and 642. Lengths in a, times in 1/γ̇.
"""

TITLES = {"inertia": "Pairs with inertia", "crossing": "A crossing pair of more viscous capsules", "suspension": "Suspensions between walls", "red": "Red cells",
          "speed": "Capsule-strains a second"}
ABOUT = {
    "inertia": "Doddi and Bagchi (2008): neo-Hookean, no prestress, centres at (∓2D, ±0.1D), a cube of 6.25D, walls across z. The numbers are on the diameter: μγ̇D/(E h) = 0.05 and "
    "Re = ργ̇D²/μ, which is `Shear number G` = 0.025 and `Reynolds number` = Re/4 here, on the radius. This reading is the one that agrees; runs named so read "
    "the modulus as G_s = E h/3, with which the capsules are slower to turn and at Re = 3 do not turn back at all, and Re on the radius. Two runs are coarser, for an error bar. Height of the first capsule over D; published: digitised, ± 0.003. What is asked for: reversal as "
    "published and positions within 0.05 D.",
    "crossing": "Lac, Morel and Barthès-Biesel (2007): Ca = 0.45, prestress 0.05, centres (∓4, 0, ±0.25), in a box of 30 × 15 × 20, periodic along x and y, or in unbounded "
    "liquid, as the published pair is, in a box of 20 × 10 × 10. λ = 1 in larger boxes and beside an independent solution: `flows.md`. For λ = 5 there are no numbers to compare with; Singh and Sarkar (Eur. Biophys. J. 2015) say, in the abstract, that a "
    "higher viscosity ratio leaves a smaller offset after the crossing.",
    "suspension": "Neo-Hookean spheres at random places in a cube, Ca = 0.1, λ = 1, walls across z. Means over time from γ̇t = "
    f"{averages.START} (shapes grow within one or two strains; the vertical line) to the end, ± the standard error of {averages.N_BLOCKS} blocks of that time: their standard deviation over the root of their number. It "
    "knows nothing of changes that are slower than a block, nor of the box and of the seed: runs with other seeds show these. Σ_xz with inertia has −Re⟨u_x u_z⟩ with it (`theory.md`, section 8.3). "
    "Published: 50 capsules in a cube, Re = 10 on the radius, stress of the walls (Huet and Wachs 2023, recorded runs of their open case; their walls differ by up to 5 %), with which runs without inertia need not agree. In Stokes flow Matsunaga et al. "
    "(J. Fluid Mech. 786, 110 (2016), from the abstract, not its figures): for Ca ≥ 0.1 terms of third order in the volume fraction make 8 % of the viscosity above one at 40 %; D grows with the fraction, θ falls. Films between shells become thinner than the cells; "
    "runs in which shells touch end there (the table has their averages until then). With `Fluid mesh/Finest cell in gaps` cells follow the films.",
    "red": "Biconcave disks of Skalak's law with C = 10, Ca = μγ̇a/G_s = 0.5, κ_B/(a² G_s) = 0.005 about the initial shape, λ = 5, at random places and orientations between walls. No published numbers of this scene are known to us.",
    "speed": "16 spheres at 20 %, as above: capsules times γ̇t over the CPU seconds of all ranks, and over wall seconds times ranks, on two cores that other programs used at the same time, so that CPU seconds are the better measure. "
    "The setting is judged by the mean D of the capsules and the relative viscosity at γ̇t = 1 in runs of other cells, control points and steps.",
}


def heading(group):
    return f"## {TITLES[group]}\n"


def inertia_table(results):
    rows = []
    for result in results:
        reynolds = figures.reynolds_of(result.name)
        times, heights = map(np.array, published.PUBLISHED_INERTIA[reynolds])
        shown = times <= result.end() + 1e-9
        differences = result.height_over_diameter(times[shown]) - heights[shown]
        worst = int(np.nanargmax(np.abs(differences)))
        series = result.capsules[0]
        inner = series["time"] <= times[-1] + 1e-9
        lowest = int(np.argmin(series["z"][inner]))
        said = int(np.argmin(heights))
        x = series["x"]  # the first capsule comes from x < 0: it turns back when it moves away again without having got past the second
        turned = x.max() < 0 and x[-1] < x.max() - 0.5
        rows.append([result.label, "yes" if turned else "no", f"{heights[said]:.3f} at {times[said]:g}", f"{series['z'][lowest] / 2:.4f} at {series['time'][lowest]:.3g}",
                     f"{differences[worst]:+.3f} at {times[shown][worst]:g}", "yes" if abs(differences[worst]) <= published.BAR else "no"])
    return table(["", "turns back", "lowest, published", "lowest", "largest difference of height / D", f"within {published.BAR:g}"], rows)


def crossing_table(results):
    rows = [["published, λ = 1, ± 2 %", "0.252", "0.720", "0.43", "0.546", "–"]]
    for result in results:
        x, z = result.offset()
        top = int(np.argmax(z))
        rows.append([result.label, f"{z[0]:.3f}", f"{z[top]:.4f}", f"{x[top]:.3f}", f"{z[-1]:.4f} (Δx/2a = {x[-1]:.2f})", show(result.smallest_gap(), 3)])
    return table(["", "offset at first", "largest offset", "at Δx/2a", "offset at the end", "smallest gap"], rows)


def with_bar(average):
    return str(Value(average.mean, average.error))


def red_table(results):
    return suspension_rows(results, lambda result: math.nan)


def suspension_table(results):
    return suspension_rows(results, lambda result: published.PUBLISHED_VISCOSITY.get(round(figures.fraction_of(result), 2))) + "\n" + seeds_text(results)


def suspension_rows(results, said_of):
    head = ["capsules", "relative viscosity", "published", "N₁/μγ̇", "N₂/μγ̇", "mean D", "mean θ/π", "smallest gap", "γ̇t", "h", "CPU s"]
    rows = []
    for result in results:
        values = [with_bar(result.averages[name]) for name in ("relative_viscosity", "N1", "N2", "D", "theta")]
        rows.append([result.label, values[0], show(said_of(result), 3), *values[1:], show(result.smallest_gap(), 2), f"{result.end():g}", f"{float(result.setting('Fluid mesh/Finest cell')):.2g}",
                     f"{result.cpu_seconds():.0f}"])
    return table(head, rows)


def seeds_text(results):
    """Means over the seeds of the runs that differ by nothing else, and what the flow's momentum carries."""
    groups = {}
    for result in results:
        if not float(result.setting("Scene/Reynolds number", "0")):
            groups.setdefault((len(result.capsules), round(figures.fraction_of(result), 3), result.resolution, result.setting("Fluid mesh/Finest cell in gaps", "0")), []).append(result)
    parts = []
    for (number, fraction, *_), members in groups.items():
        if len(members) > 1:
            mean, error = averages.over_runs([member.averages["relative_viscosity"].mean for member in members])
            parts.append(f"{number} at {100 * fraction:.3g} %: {Value(mean, error)} of {len(members)} seeds")
    fluxes = [f"{result.label}: {with_bar(result.averages['momentum_flux_xz'])}" for result in results
              if float(result.setting("Scene/Reynolds number", "0")) and "momentum_flux_xz" in result.averages]
    stokes = [result for result in results if not float(result.setting("Scene/Reynolds number", "0")) and math.isfinite(result.averages["relative_viscosity"].mean)]
    fit = fit_text([figures.fraction_of(result) for result in stokes], [result.averages["relative_viscosity"].mean for result in stokes])
    text = f"Relative viscosity over seeds, with the standard error of their means: {'; '.join(parts)}.\n" if parts else ""
    text += f"\n{fit}" if fit else ""
    return text + (f"\nOf the relative viscosity −Re⟨u_x u_z⟩: {'; '.join(fluxes)}.\n" if fluxes else "")


def fit_text(fractions, viscosities):
    """What a polynomial of second order says of runs at three fractions or more."""
    phi, above = np.array(fractions), np.array(viscosities) - 1
    if len(set(np.round(phi, 3))) < 3:
        return ""
    matrix = np.stack([phi, phi**2], axis=1)
    a, b = np.linalg.lstsq(matrix, above, rcond=None)[0]
    off = np.abs(matrix @ [a, b] - above).max()
    return f"All runs in Stokes flow by least squares: 1 + {a:.3g} φ + {b:.3g} φ², off by at most {off:.2g}.\n"


def speed_table(results):
    rows = []
    for result in results:
        wall = result.record["seconds"] * result.record["ranks"]
        values = [float(run_files.interpolated(*series, 1.0)) for series in
                  (averages.mean_of_capsules(result.capsules, "D"), (result.suspension["time"], result.suspension["relative_viscosity"]))]
        step = result.setting("Time/Step")
        rows.append([result.label, f"{float(result.setting('Fluid mesh/Finest cell')):.3g}", result.setting("Shell mesh/Level"), step, f"{values[0]:.5f}", f"{values[1]:.4f}", f"{result.end():g}",
                     f"{result.cpu_seconds():.0f}", f"{result.strains() / result.cpu_seconds():.3g}", f"{result.strains() / wall:.2g}" if wall > 0. else "–"])  # runs of less than the record's digits
    return table(["", "h", "level", "Δt", "mean D at 1", "viscosity at 1", "γ̇t", "CPU s", "strains a CPU s", "strains a wall s and rank"], rows)


TABLES = {"inertia": inertia_table, "crossing": crossing_table, "suspension": suspension_table, "red": red_table, "speed": speed_table}


def spent(result):
    record, cpu = result.record, result.cpu_seconds()
    return f"{result.label} {record['seconds']:.0f} s" + ("" if math.isnan(cpu) else f" ({cpu:.0f} CPU s)") + f" on {record['ranks']} rank(s), {result.state()}"


def section(group, tried, figures_folder):
    """Results of the group that have been tried."""
    shown = [result for result in tried if result.capsules and result.end() > 0]
    text = [heading(group), ABOUT[group] + "\n"]
    if shown and group in figures.DRAW:
        text.append(f"![{TITLES[group]}]({figures_folder}/{group}.png)\n")
    text.append(TABLES[group](shown) if shown else "No results.\n")
    text.append(f"Runs: {'; '.join(map(spent, tried))}.\n")
    return "\n".join(text)


def write(file, tried, groups, figures_folder, keep_others=False):
    """The report of these groups; sections of others stay as they are in the file or are left out. `tried`: {group: [Result]}."""
    former = report_parts.former_sections(file) if keep_others else {}
    text = [INTRODUCTION] + [section(group, tried[group], figures_folder) if group in groups else former.get(heading(group), "") for group in TITLES]
    file.parent.mkdir(parents=True, exist_ok=True)
    file.write_text("\n".join(part for part in text if part))
    print(f"report: {file}")
