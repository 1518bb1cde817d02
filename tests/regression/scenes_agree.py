#!/usr/bin/env python3
# SPDX-License-Identifier: LGPL-2.1-or-later
# Part of Tanktread: two scenes that are the same thing, told differently, give the same history.
"""Runs a parameter file twice, with the settings of --set and those of --first or --second, and compares columns of the histories row by row:

    --compare history_1.csv=history_2.csv     the first of the first run with the second of the second run; may be repeated
    --columns D_xz,theta,x:-1:2.5             D_xz and theta as they are, x with -1 times the second run's x plus 2.5

Without --second there is one run, whose histories are compared with each other. NaN agrees with NaN only. In settings | stands for a semicolon."""

import argparse
import csv
import math
import pathlib
import sys

from run_regression import run


def arguments():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--program", required=True)
    parser.add_argument("--prm", required=True)
    parser.add_argument("--output", required=True, help="folder for the folders of the runs")
    parser.add_argument("--tolerance", type=float, required=True, help="absolute")
    parser.add_argument("--columns", required=True)
    parser.add_argument("--compare", action="append", default=[], metavar="FILE=FILE")
    parser.add_argument("--ranks", default="1,1", help="of the first and the second run")
    for name in ("set", "first", "second"):
        parser.add_argument(f"--{name}", action="append", default=[], metavar="SECTION/PARAMETER=VALUE")
    return parser.parse_args()


def history(folder, name):
    with open(folder / name, newline="") as file:
        return [{column: float(value) for column, value in row.items()} for row in csv.DictReader(file)]


def largest_difference(first, second, column, factor, shift):
    """NaN where one of the two is not a number, or the numbers of rows differ."""
    if len(first) != len(second) or len(first) < 2:
        return math.nan
    differences = [0.0]
    for a, b in zip(first, second):
        if not (math.isnan(a[column]) and math.isnan(b[column])):
            differences.append(abs(a[column] - factor * b[column] - shift))
    return math.nan if any(map(math.isnan, differences)) else max(differences)


def main():
    args = arguments()
    folders = []
    ranks = [int(n) for n in args.ranks.split(",")]
    for name, settings, n in zip(("first", "second"), (args.first, args.second), ranks):
        if name == "second" and not settings and ranks[0] == ranks[1]:
            folders.append(folders[0])
            continue
        folders.append(pathlib.Path(args.output) / name)
        folders[-1].parent.mkdir(parents=True, exist_ok=True)
        run(argparse.Namespace(program=args.program, prm=args.prm, ranks=n, set=[setting.replace("|", ";") for setting in args.set + settings], output=str(folders[-1])))
    failed = False
    for pair in args.compare or ["history.csv=history.csv"]:
        first, second = (history(folder, name) for folder, name in zip(folders, pair.split("=")))
        for spec in args.columns.split(","):
            column, factor, shift = (spec.split(":") + ["1", "0"][len(spec.split(":")) - 1:])[:3]
            largest = largest_difference(first, second, column, float(factor), float(shift))
            agrees = largest <= args.tolerance
            failed |= not agrees
            print(f"{pair}, {spec}: differ by at most {largest:.2e} {'' if agrees else '  TOO MUCH'}")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
