#!/usr/bin/env python3
# SPDX-License-Identifier: LGPL-2.1-or-later
# Part of Tanktread: a run gives the same history.csv on any number of ranks.
"""Runs a parameter file once for each number of ranks and compares all columns of history.csv, but iterations and times, with those of the first run. What
the solvers' tolerances leave open differs between numbers of ranks: they have to be tight."""

import argparse
import csv
import pathlib
import subprocess
import sys

from run_regression import NEVER, run, select_columns


def arguments():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--program", required=True)
    parser.add_argument("--prm", required=True)
    parser.add_argument("--output", required=True, help="folder for the folders of the runs")
    parser.add_argument("--ranks", required=True, help="numbers separated by commas")
    parser.add_argument("--tolerance", default="1e-9", help="relative or absolute")
    parser.add_argument("--without", default="", help="further columns that are not compared, separated by commas")
    parser.add_argument("--set", action="append", default=[], metavar="SECTION/PARAMETER=VALUE")
    return parser.parse_args()


def compared_file(args, ranks):
    folder = pathlib.Path(args.output) / f"{ranks}_ranks"
    run(argparse.Namespace(program=args.program, prm=args.prm, ranks=ranks, set=args.set, output=str(folder)))
    with open(folder / "history.csv", newline="") as file:
        names = [name for name in next(csv.reader(file)) if name not in NEVER and name not in args.without.split(",")]
    target = folder / "compared.csv"
    select_columns(folder / "history.csv", names, target)
    return target


def main():
    args = arguments()
    pathlib.Path(args.output).mkdir(parents=True, exist_ok=True)
    ranks = [int(n) for n in args.ranks.split(",")]
    if len(ranks) < 2:
        sys.exit(f"--ranks {args.ranks}: nothing to compare with")
    first, *others = (compared_file(args, n) for n in ranks)
    failed = 0
    for other in others:
        print(f"{first} and {other}:", flush=True)
        failed |= subprocess.run(["numdiff", "-r", args.tolerance, "-a", args.tolerance, "-s", ", \\n", str(first), str(other)]).returncode
    return failed


if __name__ == "__main__":
    sys.exit(main())
