#!/usr/bin/env python3
# SPDX-License-Identifier: LGPL-2.1-or-later
# Part of Tanktread: what a scene leaves out changes nothing.
"""Runs a parameter file, and once more for each --almost: a parameter next to the value at which the program leaves some physics out, so that it is computed
after all. All columns of history.csv, but iterations, times and those of --without, have to be the same within the tolerance."""

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
    parser.add_argument("--tolerance", required=True, help="relative or absolute")
    parser.add_argument("--almost", action="append", required=True, metavar="SECTION/PARAMETER=VALUE")
    parser.add_argument("--without", default="", help="columns that are not compared, separated by commas")
    parser.add_argument("--set", action="append", default=[], metavar="SECTION/PARAMETER=VALUE")
    return parser.parse_args()


def compared_file(args, name, settings):
    folder = pathlib.Path(args.output) / name
    run(argparse.Namespace(program=args.program, prm=args.prm, ranks=1, set=args.set + settings, output=str(folder)))
    with open(folder / "history.csv", newline="") as file:
        names = [column for column in next(csv.reader(file)) if column not in NEVER and column not in args.without.split(",")]
    select_columns(folder / "history.csv", names, folder / "compared.csv")
    return folder / "compared.csv"


def main():
    args = arguments()
    pathlib.Path(args.output).mkdir(parents=True, exist_ok=True)
    first = compared_file(args, "left_out", [])
    failed = 0
    for i, setting in enumerate(args.almost):
        other = compared_file(args, f"computed_{i}", [setting])
        print(f"{setting}:", flush=True)
        failed |= subprocess.run(["numdiff", "-r", args.tolerance, "-a", args.tolerance, "-s", ", \\n", str(first), str(other)]).returncode
    return failed


if __name__ == "__main__":
    sys.exit(main())
