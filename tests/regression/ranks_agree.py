#!/usr/bin/env python3
# SPDX-License-Identifier: LGPL-2.1-or-later
# Part of Tanktread: a run gives the same histories on any number of ranks.
"""Runs a parameter file once for each number of ranks and compares all columns of history.csv, but iterations and times, with those of the first run; with several capsules those of
history_1.csv, history_2.csv, ... and suspension.csv. What the solvers' tolerances leave open differs between numbers of ranks: they have to be tight. In settings | stands for a semicolon."""

import argparse
import csv
import math
import pathlib
import sys

from run_regression import NEVER, run, select_columns


def arguments():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--program", required=True)
    parser.add_argument("--prm", required=True)
    parser.add_argument("--output", required=True, help="folder for the folders of the runs")
    parser.add_argument("--ranks", required=True, help="numbers separated by commas")
    parser.add_argument("--tolerance", type=float, default=1e-9, help="relative or absolute")
    parser.add_argument("--without", default="", help="further columns that are not compared, separated by commas")
    parser.add_argument("--set", action="append", default=[], metavar="SECTION/PARAMETER=VALUE")
    return parser.parse_args()


def histories(folder):
    """history.csv of a single capsule; else history_1.csv, ... and suspension.csv."""
    return [folder / "history.csv"] if (folder / "history.csv").is_file() else sorted([*folder.glob("history_*.csv"), *folder.glob("suspension.csv")])


def compared_files(args, ranks):
    """The run's histories as {name: file with the columns that are compared}."""
    folder = pathlib.Path(args.output) / f"{ranks}_ranks"
    run(argparse.Namespace(program=args.program, prm=args.prm, ranks=ranks, set=[setting.replace("|", ";") for setting in args.set], output=str(folder)))
    result = {}
    for file in histories(folder):
        with open(file, newline="") as stream:
            names = [name for name in next(csv.reader(stream)) if name not in NEVER and name not in args.without.split(",")]
        result[file.name] = folder / f"compared_{file.name}"
        select_columns(file, names, result[file.name])
    return result


def rows_of(file):
    with open(file, newline="") as stream:
        return [{name: float(value) for name, value in row.items()} for row in csv.DictReader(stream)]


def largest_difference(first, second):
    """(difference, column, number of the row): relative or absolute, whichever is smaller. Infinite where one of two numbers is none, and (infinite, None, None) where the tables have other rows or columns."""
    if len(first) != len(second) or not first or first[0].keys() != second[0].keys():
        return math.inf, None, None
    worst = (0., None, None)
    for i, (a, b) in enumerate(zip(first, second)):
        for name in a:
            if a[name] == b[name] or math.isnan(a[name]) and math.isnan(b[name]):
                continue  # infinite gaps too
            difference = abs(a[name] - b[name]) / max(1., abs(a[name]), abs(b[name]))
            worst = max(worst, (math.inf if math.isnan(difference) else difference, name, i), key=lambda entry: entry[0])
    return worst


def main():
    args = arguments()
    pathlib.Path(args.output).mkdir(parents=True, exist_ok=True)
    ranks = [int(n) for n in args.ranks.split(",")]
    if len(ranks) < 2:
        sys.exit(f"--ranks {args.ranks}: nothing to compare with")
    first, *others = (compared_files(args, n) for n in ranks)
    failed = not first
    for n, other in zip(ranks[1:], others):
        failed |= first.keys() != other.keys()
        for name in sorted(first.keys() & other.keys()):
            difference, column, row = largest_difference(rows_of(first[name]), rows_of(other[name]))
            agrees = difference <= args.tolerance
            failed |= not agrees
            print(f"{ranks[0]} and {n} ranks, {name}: differ by at most {difference:.2e} ({column}, row {row})" + ("" if agrees else "  TOO MUCH"), flush=True)
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
