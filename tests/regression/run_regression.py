#!/usr/bin/env python3
# SPDX-License-Identifier: LGPL-2.1-or-later
# Part of Tanktread: runs a parameter file and compares its history.csv with a stored one.
"""Columns of history.csv are compared by numdiff: a number passes when its relative or its absolute error is within the tolerance. The stored file holds the
compared columns only; counts of iterations and times differ between machines and library versions and are never compared.

A reference may come from a finer mesh: then the tolerance is the error of the run, measured before.

A reference is written, or renewed after a change that is meant, with --update.
"""

import argparse
import csv
import math
import os
import pathlib
import subprocess
import sys

NEVER = ("newton_iterations", "linear_iterations", "wall_time")
ANGLES = ("theta", "theta_continuous", "alpha", "delta")  # of a section that is nearly round: not a number
UNKNOWN = ("local_error", "energy_rise")  # of first steps, in flows: not a number
COLUMNS = "time,D_xz,theta,L,B,W,volume,area,membrane_energy,bending_energy"


def arguments():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--program", required=True)
    parser.add_argument("--prm", required=True)
    parser.add_argument("--reference", required=True, help="stored CSV file")
    parser.add_argument("--output", required=True, help="folder of the run")
    parser.add_argument("--ranks", type=int, default=1)
    parser.add_argument("--relative", default="1e-6")
    parser.add_argument("--absolute", default="1e-10")
    parser.add_argument("--columns", default=COLUMNS, help="names separated by commas")
    parser.add_argument("--history", default="history.csv", help="file of the run's folder; of one capsule of several: history_1.csv")
    parser.add_argument("--set", action="append", default=[], metavar="SECTION/PARAMETER=VALUE")
    parser.add_argument("--update", action="store_true", help="store the columns of this run as the reference")
    return parser.parse_args()


def run(args):
    command = ["mpirun", "--oversubscribe", "-np", str(args.ranks), args.program, args.prm]
    for setting in args.set + [f"Output/Directory={args.output}"]:
        command += ["--set", setting]
    environment = dict(os.environ, OMPI_ALLOW_RUN_AS_ROOT="1", OMPI_ALLOW_RUN_AS_ROOT_CONFIRM="1", OMPI_MCA_mpi_yield_when_idle="1")
    print(" ".join(command), flush=True)
    code = subprocess.run(command, env=environment).returncode
    if code != 0:
        sys.exit(f"the program ended with exit code {code}")


def select_columns(history, names, target):
    with open(history, newline="") as file:
        rows = list(csv.DictReader(file))
    missing = [name for name in names if not rows or name not in rows[0]]
    if missing:
        sys.exit(f"{history}: no rows, or no column {', '.join(missing)}")
    for row in rows:
        wrong = [name for name in names if math.isnan(float(row[name])) and name not in UNKNOWN and not (name in ANGLES and float(row.get("D_xz", 1)) < 1e-3)]
        if wrong:
            sys.exit(f"{history}: at time {row.get('time')} not a number: {', '.join(wrong)}")  # two runs that are equally wrong would agree
        if "theta" in row and abs(float(row.get("D_xz", 1))) < 1e-8:
            row["theta"] = "nan"  # a round section has no direction
    with open(target, "w", newline="") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(names)
        writer.writerows([row[name] for name in names] for row in rows)


def main():
    args = arguments()
    names = args.columns.split(",")
    if set(names) & set(NEVER):
        sys.exit(f"these columns are not compared: {', '.join(NEVER)}")
    run(args)
    folder = pathlib.Path(args.output)
    compared = folder / "compared.csv"
    select_columns(folder / args.history, names, compared)
    if args.update:
        pathlib.Path(args.reference).write_text(compared.read_text())
        return 0
    return subprocess.run(["numdiff", "-r", args.relative, "-a", args.absolute, "-s", ", \\n", args.reference, str(compared)]).returncode


if __name__ == "__main__":
    sys.exit(main())
