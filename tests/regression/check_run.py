#!/usr/bin/env python3
# SPDX-License-Identifier: LGPL-2.1-or-later
# Part of Tanktread: runs a parameter file and checks how it ends.
"""The last row of history.csv is compared with values from an independent solution (--expect D_xz=0.38,0.05: within 5 %), the volume error of every row with
--volume-error; or the run has to fail with a given exit code and message (--exit-code 2 --message TEXT) and leave its last good state."""

import argparse
import csv
import math
import pathlib
import subprocess
import sys


def arguments():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--program", required=True)
    parser.add_argument("--prm", required=True)
    parser.add_argument("--output", required=True)
    parser.add_argument("--ranks", type=int, default=1)
    parser.add_argument("--set", action="append", default=[], metavar="SECTION/PARAMETER=VALUE")
    parser.add_argument("--expect", action="append", default=[], metavar="COLUMN=VALUE,RELATIVE")
    parser.add_argument("--volume-error", type=float, default=1e-8)
    parser.add_argument("--time", type=float, help="time that the run has to reach")
    parser.add_argument("--steps", type=int, help="number of steps that the run has to take: none of them halved")
    parser.add_argument("--keeps", action="append", default=[], metavar="COLUMN=RELATIVE", help="column that must stay within this of its first value")
    parser.add_argument("--varies", action="append", default=[], metavar="COLUMN", help="column that must not be the same in all rows")
    parser.add_argument("--contours", metavar="TIMES", help="times of the cuts in contours.csv, by commas")
    parser.add_argument("--exit-code", type=int, default=0)
    parser.add_argument("--message", default="", help="what the run has to say")
    parser.add_argument("--without", default="", help="what it must not say")
    return parser.parse_args()


def run(args):
    command = ["mpirun", "--oversubscribe", "-np", str(args.ranks), args.program, args.prm]
    for setting in args.set + [f"Output/Directory={args.output}"]:
        command += ["--set", setting]
    print(" ".join(command), flush=True)
    result = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
    print(result.stdout)
    return result.returncode, result.stdout


def largest_of(values):
    """The largest, or NaN if one is NaN: max() passes over those that are not first."""
    values = list(values)
    return math.nan if any(map(math.isnan, values)) else max(values)


def failures_of_history(args):
    with open(pathlib.Path(args.output) / "history.csv", newline="") as file:
        rows = [{name: float(value) for name, value in row.items()} for row in csv.DictReader(file)]
    largest = largest_of(abs(row["volume_error"]) for row in rows)
    print(f"volume error of {len(rows)} rows: at most {largest:.1e}")
    if not largest <= args.volume_error:
        yield f"volume error {largest}, allowed {args.volume_error}"
    if args.time is not None and not rows[-1]["time"] >= args.time * (1 - 1e-9):
        yield f"ended at time {rows[-1]['time']}, expected {args.time}"
    if args.steps is not None and len(rows) != args.steps + 1:
        yield f"{len(rows) - 1} steps, expected {args.steps}"
    for column in args.varies:
        if not largest_of(row[column] for row in rows) > min(row[column] for row in rows):
            yield f"{column} is {rows[0][column]} in all rows, or not a number in some"
    for kept in args.keeps:
        column, _, allowed = kept.partition("=")
        change = largest_of(abs(row[column] / rows[0][column] - 1) for row in rows)
        print(f"{column}: changes by at most {change:.1e}")
        if not change <= float(allowed):
            yield f"{column} changes by {change}, allowed {allowed}"
    if args.contours:
        with open(pathlib.Path(args.output) / "contours.csv", newline="") as file:
            times = [float(row["time"]) for row in csv.DictReader(file)]
        found = [time for i, time in enumerate(times) if i == 0 or time != times[i - 1]]
        if found != [float(time) for time in args.contours.split(",")]:
            yield f"contours at {found}, expected at {args.contours}"
    for expectation in args.expect:
        column, _, numbers = expectation.partition("=")
        value, relative = (float(number) for number in numbers.split(","))
        difference = rows[-1][column] / value - 1
        print(f"{column}: {rows[-1][column]:.6f}, reference {value:.6f}, difference {100 * difference:+.2f} %")
        if not abs(difference) <= relative:
            yield f"{column} differs by {100 * difference:+.2f} %, allowed {100 * relative} %"


def main():
    args = arguments()
    code, said = run(args)
    failures = []
    if code != args.exit_code:
        failures.append(f"exit code {code}, expected {args.exit_code}")
    elif code == 0:
        failures += failures_of_history(args)
    elif not (pathlib.Path(args.output) / "failed_shell.vtu").exists():
        failures.append("failed_shell.vtu was not written")
    if args.message not in said:
        failures.append(f"not said: {args.message}")
    if args.without and args.without in said:
        failures.append(f"said: {args.without}")
    print("\n".join(failures) if failures else "passed")
    return 1 if failures else 0


if __name__ == "__main__":
    sys.exit(main())
