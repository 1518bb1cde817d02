#!/usr/bin/env python3
# SPDX-License-Identifier: LGPL-2.1-or-later
# Part of Tanktread: error against CPU seconds for four capsules.
"""Compute four capsules with many settings, one cause of error at a time, and show error against CPU seconds.

    benchmarks/work_precision/run.py --build build/release [--quick] [--scenes sphere,oblate] [--jobs N] [--draw] [--doc]

Errors are those beside the solutions of benchmarks/reference, or beside what the finest runs tend to where there is none. Runs and results go to output/work_precision: points.csv (all
points), work_precision.png, work_precision.md. A run that is there with the same scene and settings is not made again, also one that failed; delete its folder to repeat it. With --doc
doc/work_precision.md, doc/figures/work_precision.png and benchmarks/work_precision/points.csv are renewed.

One run at a time on one rank unless --jobs says otherwise: CPU seconds are longer beside neighbours. With --quick it takes a quarter of an hour, else some three hours (by estimate).
"""

import argparse
import pathlib
import subprocess
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
import python_packages  # noqa: E402

python_packages.need("numpy", "matplotlib")

import run_scenes  # noqa: E402
import run_table  # noqa: E402

import chart  # noqa: E402
import points  # noqa: E402
import report  # noqa: E402
import sweeps  # noqa: E402


def arguments():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--build", type=pathlib.Path, default=run_scenes.ROOT / "build/release", help="folder of the program (default: build/release)")
    parser.add_argument("--quick", action="store_true", help="coarse settings only")
    parser.add_argument("--scenes", default=",".join(scene.name for scene in sweeps.SCENES), help="scenes to compute (default: all); the table has all that are there")
    parser.add_argument("--jobs", type=int, default=1, help="runs at a time (default 1)")
    parser.add_argument("--draw", action="store_true", help="compute nothing: chart and tables of points.csv, of output/work_precision or else of the repository")
    parser.add_argument("--doc", action="store_true", help="renew the page, the figure and the table of points in the repository")
    args = parser.parse_args()
    unknown = set(args.scenes.split(",")) - {scene.name for scene in sweeps.SCENES}
    if unknown:
        parser.error(f"--scenes: got {', '.join(sorted(unknown))}; allowed: {', '.join(scene.name for scene in sweeps.SCENES)}")
    if args.jobs < 1:
        parser.error(f"--jobs {args.jobs}; allowed: a number >= 1")
    args.program = args.build / "tanktread"
    if not args.draw and not args.program.is_file():
        parser.error(f"{args.program} is missing: build it (cmake --preset release && cmake --build --preset release) or name its folder with --build")
    args.ranks, args.resume = 1, False
    return args


def measure(args):
    """Makes the runs that are missing; the table of all points."""
    printed = subprocess.run([args.program, "--print-parameters"], check=True, stdout=subprocess.PIPE, text=True).stdout
    schemes, has_dial = sweeps.schemes_and_dial(printed)
    of = {scene.name: sweeps.sweeps(scene, not args.quick, schemes, has_dial) for scene in sweeps.SCENES}
    wanted = {}
    for scene in (scene for scene in sweeps.SCENES if scene.name in args.scenes.split(",")):
        for point in of[scene.name]:
            if points.record_of(scene, point.choice) is None:
                wanted[scene.name, sweeps.name(point.choice)] = (points.run_of(scene), sweeps.name(point.choice), sweeps.parameters(point.choice))
    run_scenes.compute(args, list(wanted.values()))
    return points.collect(of, "quick" if args.quick else "full", args.jobs)


def main():
    args = arguments()
    file = points.OUTPUT / "points.csv"
    run_table.renew(args, pathlib.Path(__file__).resolve().parent, file, points.NUMBERS, lambda: points.write(file, *measure(args)), chart.draw, report.page)
    return 0


if __name__ == "__main__":
    run_scenes.call(main)
