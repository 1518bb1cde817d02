#!/usr/bin/env python3
# SPDX-License-Identifier: LGPL-2.1-or-later
# Part of Tanktread: what the box costs in accuracy: boxes of several sides in unbounded liquid, and between walls and periodic faces.
"""Measure what the box around a capsule is worth, with Scene/Boundary = unbounded and with faces.

    box_study.py --build build/release [--parts flows,runs,tables] [--output output/box_study] [--nice]

flows   the program interface_study: error of the surface velocity of given forces whose flow in unbounded liquid is known -> a csv file a box
runs    runs of tanktread from a sphere at rest in shear, lambda = 1 and 5, beside the reference solutions
tables  Markdown on the standard output, as in doc/accuracy.md

All runs are on one rank, one after the other. What has been measured is not measured again: delete it to repeat it. Tables take what is there.
"""

import argparse
import collections
import csv
import os
import pathlib
import resource
import subprocess
import sys

import python_packages

python_packages.need("numpy", "matplotlib")

import run_files  # noqa: E402

ROOT = pathlib.Path(__file__).resolve().parent.parent
PARTS = ["flows", "runs", "tables"]

Box = collections.namedtuple("Box", "boundary side")
BOXES = [Box("unbounded", side) for side in (3.75, 5, 7.5, 10, 15)] + [Box("faces", side) for side in (10, 20, 40, 80)]
Case = collections.namedtuple("Case", "title reference cells end settings")
CASES = {
    "G0.2_h32": Case("G = 0.2, h = 10a/32", "sphere_G0.2_k0.04_variational.csv", 32, 8, {}),
    "G0.2_h64": Case("G = 0.2, h = 10a/64", "sphere_G0.2_k0.04_variational.csv", 64, 8, {}),
    "lambda5_h64": Case("G = 0.05, λ = 5, h = 10a/64", "sphere_G0.05_k0.01_moment_only_lambda5.csv", 64, 3, {
        "Scene/Shear number G": 0.05, "Scene/Reduced bending modulus": 0.01, "Scene/Viscosity ratio": 5, "Capsule/Bending form": "moment-only"}),
}


def coarsest_cell(box):
    """The octree meets h = 10a/32 and /64 from cells of 1.25 a (in small boxes), 2.5 a and 5 a."""
    return 1.25 if box.side < 10 else 5 if box.side > 40 else 2.5


def name(box):
    return f"{box.boundary}_{box.side:g}"


def low(args):
    return ["nice", "-n", "10"] if args.nice else []


def environment():
    return {**os.environ, "OMP_NUM_THREADS": "1"}


def measure_flow(args, box):
    target = args.output / f"flow_{name(box)}.csv"
    if target.exists():
        return
    command = [*low(args), str(args.build / "interface_study"), "--scenes", "sphere2,sphere4", "--interfaces", "enriched", "--cells", "32,64", "--repeat", "1", "--grading", "3",
               "--boundary", box.boundary, "--box", f"{box.side:g}", "--coarsest", f"{coarsest_cell(box):g}"]
    print(target.name, flush=True)
    result = subprocess.run(command, check=True, stdout=subprocess.PIPE, text=True, env=environment())
    target.write_text(result.stdout)


def folder(args, case, box):
    return args.output / f"{case}_{name(box)}"


def measure_run(args, case, box):
    path, what = folder(args, case, box), CASES[case]
    if (path / "cpu_seconds.txt").exists():
        return
    settings = {
        "Accuracy/Target error": 0, "Scene/Shear number G": 0.2, "Scene/Reduced bending modulus": 0.04, "Scene/Boundary": box.boundary, "Scene/Box side": box.side, "Scene/End time": what.end,
        "Shell mesh/Level": {32: 2, 64: 3}[what.cells], "Fluid mesh/Finest cell": 10 / what.cells, "Fluid mesh/Coarsest cell": coarsest_cell(box), "Time/Step": 0.1,
        "Time/Steady tolerance": 0, "Output/Field interval": 0, "Output/Directory": path, **what.settings,
    }
    command = [*low(args), str(args.build / "tanktread"), str(ROOT / "prm/sphere_shear.prm")]
    for key, value in settings.items():
        command += ["--set", f"{key}={value}"]
    print(path.name, flush=True)
    before = resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime
    subprocess.run(command, check=True, stdout=subprocess.DEVNULL, env=environment())
    (path / "cpu_seconds.txt").write_text(f"{resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime - before:.2f}\n")


def table(head, rows):
    print("| " + " | ".join(head) + " |\n|" + "---|" * len(head))
    for row in rows:
        print("| " + " | ".join(row) + " |")
    print()


def words(box):
    return "unbounded" if box.boundary == "unbounded" else "faces", f"{box.side:g}a"


def print_flows(args):
    body = []
    for box in BOXES:
        file = args.output / f"flow_{name(box)}.csv"
        if file.exists():
            rows = {(row["scene"], row["cells"]): row for row in csv.DictReader(file.read_text().splitlines())}
            columns = [rows[key] for key in (("sphere2", "32"), ("sphere2", "64"), ("sphere4", "32"), ("sphere4", "64")) if key in rows]
            body.append([*words(box), *(f"{100 * float(row['error']):.3f} %" for row in columns), *(f"{1e4 * float(row['power_error']):+.1f}·10⁻⁴" for row in columns[:2]),
                         ", ".join(row["fluid_cells"] for row in columns[:2]), ", ".join(row["iterations"] for row in columns[:2])])
    table(["boundary", "box", "l = 2, 10a/32", "10a/64", "l = 4, 10a/32", "10a/64", "power, l = 2, 10a/32", "10a/64", "cells", "iterations, l = 2"], body)


def print_runs(args, case):
    wanted = run_files.standard_columns(run_files.read_table(run_files.REFERENCE_FOLDER / CASES[case].reference)[0])
    body = []
    for box in BOXES:
        path = folder(args, case, box)
        if not (path / "cpu_seconds.txt").exists():
            continue
        found, _ = run_files.read_table(path / "history.csv")
        time = found["time"][-1]
        values = [found["D_xz"][-1], found["theta"][-1]]
        errors = [value / run_files.interpolated(wanted["time"], wanted[key], time) - 1 for key, value in zip(("D", "theta"), values)]
        body.append([*words(box), f"{values[0]:.5f}", f"{100 * errors[0]:+.3f} %", f"{values[1]:.5f}", f"{100 * errors[1]:+.3f} %", f"{found['cells'][-1]:.0f}",
                     f"{found['newton_iterations'][1:].mean():.2f}", f"{found['linear_iterations'][1:].mean():.1f}", (path / "cpu_seconds.txt").read_text().strip()])
    print(f"{CASES[case].title}, γ̇t = {CASES[case].end}:\n")
    table(["boundary", "box", "D", "difference", "θ/π", "difference", "cells", "Newton a step", "linear a step", "CPU s"], body)


def arguments():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--build", type=pathlib.Path, default=ROOT / "build/release", help="folder of the programs")
    parser.add_argument("--parts", default=",".join(PARTS))
    parser.add_argument("--output", type=pathlib.Path, default=pathlib.Path("output/box_study"))
    parser.add_argument("--nice", action="store_true", help="with low priority")
    args = parser.parse_args()
    unknown = set(args.parts.split(",")) - set(PARTS)
    if unknown:
        parser.error(f"--parts: got {', '.join(sorted(unknown))}; allowed: {', '.join(PARTS)}")
    args.output = args.output.resolve()
    return args


def main():
    args = arguments()
    parts = args.parts.split(",")
    args.output.mkdir(parents=True, exist_ok=True)
    for box in BOXES if "flows" in parts else []:
        measure_flow(args, box)
    for case in CASES if "runs" in parts else []:
        for box in BOXES:
            measure_run(args, case, box)
    if "tables" in parts:
        print_flows(args)
        for case in CASES:
            print_runs(args, case)
    return 0


if __name__ == "__main__":
    sys.exit(main())
