#!/usr/bin/env python3
# SPDX-License-Identifier: LGPL-2.1-or-later
# Part of Tanktread: the error bars of a study, as a figure.
"""Draws study.csv of one or several folders: for each quantity the relative error bar, cause above cause. The figure is study.png in the first folder."""

import argparse
import csv
import math
import pathlib
import sys

from python_packages import need

COLOURS = ["#1f5a91", "#d1762a", "#4d9351", "#a34a58", "#7d6bb0", "#8a8a8a", "#b8a13c"]


def read_study(folder):
    """{quantity: (value, {cause: error})}, without what a cause says nothing about."""
    path = folder / "study.csv"
    if not path.is_file():
        sys.exit(f"plot_study.py: {path} is missing; it is written at the end of a run with a section Study")
    result = {}
    with open(path, newline="", encoding="utf-8") as file:
        for row in csv.DictReader(file):
            value, bars = result.setdefault(row["quantity"], (float(row["value"]), {}))
            if row["cause"] != "all" and math.isfinite(float(row["error"])) and value != 0.0:
                bars[row["cause"]] = float(row["error"]) / abs(value)
    return result


def draw(axes, study, title):
    quantities = [quantity for quantity, (_, bars) in study.items() if bars]
    causes = list(dict.fromkeys(cause for _, bars in study.values() for cause in bars))
    left = [0.0] * len(quantities)
    for colour, cause in zip(COLOURS, causes):
        widths = [100 * study[quantity][1].get(cause, 0.0) for quantity in quantities]
        axes.barh(quantities, widths, left=left, color=colour, height=0.6, label=cause)
        left = [a + b for a, b in zip(left, widths)]
    for quantity, total in zip(quantities, left):
        axes.text(total, quantity, f"  {study[quantity][0]:.5g} ± {total:.2g} %", va="center", fontsize=9)
    axes.invert_yaxis()
    axes.set_xlim(0, 1.45 * max(left, default=1.0))
    axes.set_xlabel("error bar, % of the value")
    axes.set_title(title, fontsize=11)
    axes.legend(loc="lower right")


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("folders", nargs="*", type=pathlib.Path, default=[pathlib.Path("output/sphere_shear")], help="default: output/sphere_shear")
    args = parser.parse_args()
    need("numpy", "matplotlib")
    import plot_style  # noqa: F401  pylint: disable=import-outside-toplevel,unused-import
    from matplotlib import pyplot  # pylint: disable=import-outside-toplevel

    studies = [(folder, read_study(folder)) for folder in args.folders]
    rows = [max(2, sum(1 for _, bars in study.values() if bars)) for _, study in studies]
    figure, axes = pyplot.subplots(len(studies), 1, figsize=(9, 1.2 * len(studies) + 0.45 * sum(rows)), squeeze=False, height_ratios=rows)
    for panel, (folder, study) in zip(axes[:, 0], studies):
        draw(panel, study, folder.name)
    target = args.folders[0] / "study.png"
    figure.savefig(target)
    print(target)


if __name__ == "__main__":
    main()
