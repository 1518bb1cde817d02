#!/usr/bin/env python3
# SPDX-License-Identifier: LGPL-2.1-or-later
# Part of Tanktread: the order of a time scheme, seen in whole runs.
"""Runs a parameter file with steps dt, dt/2 and dt/4 on one fluid mesh and takes the order from the differences of the results at the end: log2(|q(dt) -
q(dt/2)| / |q(dt/2) - q(dt/4)|) for semi-axes and inclination together. Passes when it lies in the range given. The mesh must not change: a run with another
number of cells fails."""

import argparse
import csv
import math
import pathlib
import subprocess
import sys

QUANTITIES = ("L", "B", "W", "theta")


def arguments():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--program", required=True)
    parser.add_argument("--prm", required=True)
    parser.add_argument("--output", required=True)
    parser.add_argument("--step", type=float, required=True, help="the longest step")
    parser.add_argument("--order", required=True, metavar="LOW,HIGH")
    parser.add_argument("--set", action="append", default=[], metavar="SECTION/PARAMETER=VALUE")
    return parser.parse_args()


def result(args, step):
    """Rows of history.csv as numbers."""
    folder = f"{args.output}_{step:g}"
    command = [args.program, args.prm]
    for setting in args.set + [f"Time/Step={step}", f"Output/Directory={folder}"]:
        command += ["--set", setting]
    subprocess.run(command, check=True, stdout=subprocess.DEVNULL)
    with open(pathlib.Path(folder) / "history.csv", newline="") as file:
        return [{name: float(value) for name, value in row.items()} for row in csv.DictReader(file)]


def main():
    args = arguments()
    low, high = (float(number) for number in args.order.split(","))
    runs = [result(args, args.step / 2**i) for i in range(3)]
    cells = {row["cells"] for rows in runs for row in rows}
    lengths = [len(rows) - 1 for rows in runs]
    if len(cells) > 1 or lengths != [lengths[0], 2 * lengths[0], 4 * lengths[0]]:
        print(f"cells {sorted(cells)}, steps {lengths}: not the same mesh with halved steps")
        return 1
    last = [[rows[-1][name] for name in QUANTITIES] for rows in runs]
    first, second = (math.dist(last[i], last[i + 1]) for i in range(2))
    order = math.log2(first / second)
    print(f"differences {first:.3e} and {second:.3e} of {', '.join(QUANTITIES)}: order {order:.3f}, expected {low} to {high}")
    return 0 if low <= order <= high else 1


if __name__ == "__main__":
    sys.exit(main())
