#!/usr/bin/env python3
# SPDX-License-Identifier: LGPL-2.1-or-later
# Part of Tanktread: a run that is resumed gives what one gives that was not interrupted.
"""Runs a scene without checkpoints, with them, and resumed from the middle:

    test_restart.py PROGRAM SCENE.prm --end T [--ranks 2] [--resume-ranks 3] [--set Section/Name=value ...] --output FOLDER

All tables have to agree to the last digit, but for the times of the clock, on as many ranks; to 1e-9 of the largest value of a column, at least one, on others. A run whose shells keep LU factors gives these up when it writes a
checkpoint: with --factors the runs with and without are not compared.
"""

import argparse
import csv
import pathlib
import shutil
import subprocess
import sys

CLOCK = {"wall_time"}


def run(arguments, folder, ranks, *more, code=0):
    command = ["mpirun", "--oversubscribe", "-np", str(ranks), arguments.program, arguments.prm, "--set", f"Output/Directory={folder}", "--set", f"Scene/End time={arguments.end}"]
    for setting in arguments.set:
        command += ["--set", setting]
    done = subprocess.run([*command, *more], stdout=subprocess.PIPE, stderr=subprocess.STDOUT, universal_newlines=True, timeout=1200)
    if done.returncode != code:
        sys.exit(f"{' '.join(command)}\nexit code {done.returncode}, expected {code}\n{done.stdout}")
    return done.stdout


def tables(folder):
    """{file: (columns, rows)} of all tables of a run."""
    result = {}
    for file in sorted(folder.glob("*.csv")):
        if file.name != "summary.csv":
            with open(file, newline="") as lines:
                rows = list(csv.reader(lines))
            result[file.name] = rows[0], rows[1:]
    return result


def differences(one, other, relative):
    """What differs between the tables of two folders; relative: to the largest value of a column, 0: every digit counts."""
    a, b = tables(one), tables(other)
    if list(a) != list(b):
        return [f"{one} has {list(a)}, {other} {list(b)}"]
    result = []
    for name in a:
        if relative and name.startswith("contours"):
            continue  # of cuts that run along the surface, where rounding counts for more
        columns, rows = a[name]
        others = b[name][1]
        if len(rows) != len(others):
            result.append(f"{name}: {len(rows)} and {len(others)} rows")
            continue
        for i, column in enumerate(columns):
            if column in CLOCK or (relative and column.endswith("iterations")):
                continue
            scale = max([1., *(abs(float(row[i])) for row in rows if float(row[i]) == float(row[i]) and abs(float(row[i])) != float("inf"))])
            for x, y in zip(rows, others):
                if x[i] != y[i] and not (relative and abs(float(x[i]) - float(y[i])) <= relative * scale):
                    result.append(f"{name}: {column} is {x[i]} and {y[i]} at time {x[0]}")
                    break
    return result


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program")
    parser.add_argument("prm")
    parser.add_argument("--end", required=True)
    parser.add_argument("--ranks", type=int, default=1)
    parser.add_argument("--resume-ranks", type=int)
    parser.add_argument("--relative", type=float, default=1e-9, help="on other numbers of ranks")
    parser.add_argument("--factors", action="store_true")
    parser.add_argument("--set", action="append", default=[])
    parser.add_argument("--output", required=True, type=pathlib.Path)
    arguments = parser.parse_args()
    half = ["--set", f"Output/Checkpoint interval={float(arguments.end) / 2:.15g}"]
    shutil.rmtree(arguments.output, ignore_errors=True)
    whole, halves = arguments.output / "whole", arguments.output / "halves"
    errors = []

    def compare(what, one, other, relative=0.):
        errors.extend(f"{what}: {difference}" for difference in differences(one, other, relative))

    if not arguments.factors:
        run(arguments, whole, arguments.ranks)
    run(arguments, halves, arguments.ranks, *half)
    if arguments.factors:
        shutil.copytree(halves, whole)
    compare("with checkpoints", whole, halves)
    checkpoints = sorted((halves / "checkpoints").iterdir())
    if len(checkpoints) != 2:
        errors.append(f"checkpoints: {[path.name for path in checkpoints]}, expected two")
    shutil.rmtree(checkpoints[-1])
    ranks = arguments.resume_ranks or arguments.ranks
    said = run(arguments, halves, ranks, *half, "--resume")
    if "Resumed at time" not in said:
        errors.append("resumed: the log does not say so:\n" + said)
    compare("resumed", whole, halves, 0. if ranks == arguments.ranks else arguments.relative)
    run(arguments, halves, ranks, *half, "--resume")
    compare("resumed at the end", whole, halves, 0. if ranks == arguments.ranks else arguments.relative)
    if errors:
        sys.exit("\n".join(errors))


if __name__ == "__main__":
    main()
