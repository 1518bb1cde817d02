#!/usr/bin/env python3
# SPDX-License-Identifier: LGPL-2.1-or-later
# Part of Tanktread: whether error bars of studies contain the true values, on all scenes of Le (2010) with a reference solution.
"""Counts bars that hold, from what benchmarks/le_2010/run.py has left.

    error_bars.py [--results output/le_2010] [--missed]

A pair is a number of a run's study.csv and the same number of the boundary-integral solution until the end of the run, judged by the rule of doc/theory.md,
section 8.2: whole curves of D and theta/pi (largest difference, as run_files.largest_differences()), last least and largest D, for capsules that swing least and largest
theta, period and frequency, last D; of spheres the limits of D, theta/pi, L, B and W. Scenes without a study or a reference are left out, as are the two whose membranes
wrinkle. Scenes are counted off in alphabetical order: the factors of the bars were chosen on the first, third, ... and tried on the others.
"""

import argparse
import math
import pathlib
import sys

import python_packages

python_packages.need("numpy")

import numpy as np  # noqa: E402

import report_parts  # noqa: E402
import run_files  # noqa: E402

ROOT = pathlib.Path(__file__).resolve().parent.parent
sys.path.insert(0, str(ROOT / "benchmarks/le_2010"))
import motion  # noqa: E402
import runs  # noqa: E402

UNCERTAIN = ("oblate_G0.05_k0", "oblate_G0.008_k0")  # wrinkle: benchmarks/reference/README.md
KINDS = {"curves": ("curve",), "extremes": ("minimum", "maximum"), "periods, frequencies": ("period", "frequency"), "last values": ("last",), "limits": ("limit",)}


def frequency(times, angle, first):
    """Turns per unit of time from the whole half turns since a row, as the program counts them."""
    turned = np.abs(angle[first:] - angle[first])
    half_turns = math.floor(turned[-1])
    if half_turns < 1:
        return math.nan
    i = int(np.argmax(turned >= half_turns))
    end = times[first + i - 1] + (half_turns - turned[i - 1]) / (turned[i] - turned[i - 1]) * (times[first + i] - times[first + i - 1])
    return 0.5 * half_turns / (end - times[first])


def truth_of_motion(table, end):
    """{name in study.csv: value} of a solution that has no steady state, until `end`."""
    rows = table["t"] <= end * (1 + 1e-9)
    times, D, theta, alpha = (table[name][rows] for name in ("t", "D", "theta_over_pi", "alpha_over_pi"))
    found = motion.summary(times, D, theta, alpha)
    names = ["D_minimum", "D_maximum", "D_period"] + (["theta_minimum", "theta_maximum"] if found["mode"] == "swinging" else [])
    theta, alpha = np.unwrap(theta, period=1), np.unwrap(alpha, period=2)
    first = int(np.argmax(np.abs(alpha - alpha[0]) >= 1))
    turning = ("tumbling_frequency", theta) if found["mode"] == "tumbling" else ("tank_treading_frequency", alpha - theta)
    return {**{name: found[name] for name in names}, turning[0]: frequency(times, turning[1], first), "D_last": run_files.interpolated(times, D, end)}


def pairs(folder, table):
    """[(quantity, error, bar)] of one run; the bar of a limit is that of target and stop."""
    study = runs.read_bars(folder / "study.csv")
    summary = {name: run_files.number(value) for name, value in (line.split(",", 1) for line in (folder / "summary.csv").read_text().splitlines())}
    series = runs.read_series(folder / "history.csv")
    errors = run_files.largest_differences(series, run_files.standard_columns(table))
    found = [("D_curve", errors[0] * np.nanmax(table["D"]), study["D_curve", "target"]), ("theta_curve", errors[1], study["theta_curve", "target"])]
    if "alpha_over_pi" in table:
        truth = truth_of_motion(table, series["time"][-1])
    else:
        truth = {f"{name}_limit": table[column][-1] for name, column in (("D", "D"), ("theta", "theta_over_pi"), ("L", "L"), ("B", "B"), ("W", "W"))}
    for name, value in truth.items():
        bar = sum(study.get((name, cause), math.nan) for cause in (("target", "stop") if "limit" in name else ("target",)))
        found.append((name, abs(summary.get(name, math.nan) - value), bar))
    return [pair for pair in found if math.isfinite(pair[1] + pair[2])]


def certain_references(parameters):
    """Files for this scene if it is one in shear."""
    in_shear = parameters.get("Scene/Flow", "shear") == "shear"
    return [file for file in run_files.find_references(parameters) if in_shear and file.stem not in UNCERTAIN]


def chosen_on():
    """The references of every other scene, whether or not it has been computed."""
    return set(sorted({file.stem for run in runs.find([]) for file in certain_references(run.parameters())})[::2])


def collect(results):
    """[(resolution, reference, viscosity ratio, pairs)]"""
    found = []
    for resolution in runs.RESOLUTIONS:
        for folder in sorted((results / resolution).glob("fig*/*")):
            if not (folder / "study.csv").is_file():
                continue
            parameters = run_files.read_parameters(folder / "used_parameters.prm")
            files = certain_references(parameters)
            if files and ("D_curve", "target") in runs.read_bars(folder / "study.csv"):
                found.append((resolution, files[0].stem, float(parameters.get("Scene/Viscosity ratio", 1)), pairs(folder, run_files.read_table(files[0])[0])))
    return found


def cells(found):
    """Bars that hold, median of bar over error, share of bars below ten errors."""
    if not found:
        return ["–"] * 3
    ratios = [bar / error for _, error, bar in found]
    return [f"{sum(ratio >= 1 for ratio in ratios)} of {len(ratios)}", f"{np.median(ratios):.1f}", f"{100 * np.mean([ratio < 10 for ratio in ratios]):.0f} %"]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--results", type=pathlib.Path, default=ROOT / "output/le_2010")
    parser.add_argument("--missed", action="store_true", help="name the bars that do not hold")
    args = parser.parse_args()
    results = collect(args.results)
    if not results:
        parser.error(f"{args.results} holds no study with curves and a reference solution: run benchmarks/le_2010/run.py, or name its folder with --results")
    scenes, half = {reference for _, reference, _, _ in results}, chosen_on()
    groups = sorted({(resolution, viscosity) for resolution, _, viscosity, _ in results})
    rows = []
    for resolution, viscosity in groups:
        of_group = [pair for r, _, v, found in results if (r, v) == (resolution, viscosity) for pair in found]
        for kind, ends in KINDS.items():
            rows.append([f"{runs.RESOLUTIONS[resolution]}, λ = {viscosity:g}: {kind}", *cells([pair for pair in of_group if pair[0].endswith(ends)])])
    for name, wanted in (("all", scenes), ("half of the scenes on which the factors were chosen", half), ("the other half", scenes - half)):
        rows.append([name, *cells([pair for _, reference, _, found in results if reference in wanted for pair in found])])
    print(report_parts.table(["pairs", "hold", "bar over error, median", "below ten"], [row for row in rows if row[1] != "–"]))
    if args.missed:
        for resolution, reference, _, found in results:
            for name, error, bar in found:
                if bar < error:
                    print(f"{runs.RESOLUTIONS[resolution]} {reference} {name}: bar {bar:.2g}, error {error:.2g}")


if __name__ == "__main__":
    main()
