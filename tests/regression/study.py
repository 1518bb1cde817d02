#!/usr/bin/env python3
# SPDX-License-Identifier: LGPL-2.1-or-later
# Part of Tanktread: a study makes its companions once, and goes on where it was interrupted.
"""Runs a parameter file with companions for mesh and step, then the same again (nothing may be computed), then with the result of one companion removed
(that one alone may be computed), and compares the three tables."""

import argparse
import csv
import pathlib
import shutil
import subprocess
import sys

COMPANIONS = ["mesh-1", "mesh-1_step-1"]


def arguments():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--program", required=True)
    parser.add_argument("--prm", required=True)
    parser.add_argument("--output", required=True)
    parser.add_argument("--set", action="append", default=[], metavar="SECTION/PARAMETER=VALUE")
    return parser.parse_args()


def study(args, folder):
    settings = [f"Output/Directory={folder}", "Study/Vary=mesh, step", *args.set]
    words = [args.program, args.prm] + [word for setting in settings for word in ("--set", setting)]
    done = subprocess.run(words, capture_output=True, text=True, check=False)
    if done.returncode:
        sys.exit(f"exit code {done.returncode}\n{done.stdout}\n{done.stderr}")
    return done.stdout.count("is not computed again"), (folder / "study.csv").read_text()


def last_D(folder):
    with open(folder / "history.csv", newline="", encoding="utf-8") as file:
        return float(list(csv.DictReader(file))[-1]["D_xz"])


def expect(condition, message):
    if not condition:
        sys.exit(message)


def main():
    args = arguments()
    folder = pathlib.Path(args.output).resolve()
    shutil.rmtree(folder, ignore_errors=True)
    again, table = study(args, folder)
    expect(again == 0, "The first study has found results.")
    for name in COMPANIONS:
        expect((folder / "study" / name / "summary.csv").is_file(), f"No companion {name}.")
    again, second = study(args, folder)
    expect(again == 3 and second == table, f"{again} of 3 runs were there already; the table has {'not ' * (second == table)}changed.")
    (folder / "study" / COMPANIONS[1] / "summary.csv").unlink()
    again, third = study(args, folder)
    expect(again == 2 and third == table, f"{again} of 2 runs were there already; the table has {'not ' * (third == table)}changed.")
    rows = {(row["quantity"], row["cause"]): row for row in csv.DictReader(table.splitlines())}
    mesh, whole = rows["D_last", "mesh"], rows["D_last", "all"]
    difference = abs(last_D(folder) - last_D(folder / "study" / "mesh-1"))
    expect(difference > 0 and float(mesh["error"]) > 0, "The companion on the coarser mesh is no coarser.")
    expect(abs(float(whole["error"]) - float(mesh["error"]) - float(rows["D_last", "step"]["error"])) < 1e-9, "The bars do not add up.")
    print(f"D = {whole['value']} +- {whole['error']}, of that mesh {mesh['error']}; the coarser mesh is {difference:.3g} away")


if __name__ == "__main__":
    main()
