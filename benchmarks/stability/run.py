#!/usr/bin/env python3
# SPDX-License-Identifier: LGPL-2.1-or-later
# Part of Tanktread: what the program does where scenes, meshes and steps become too hard.
"""Compute maps of small runs across the limits of steps, meshes and materials, and show how each run ends.

    benchmarks/stability/run.py --build build/release [--quick] [--maps inertia,gaps] [--jobs N] [--draw] [--doc]

A run holds, is warned of, halves its steps, ends with a sentence or is refused; what must not be is a crash, a hang, a NaN, or a result that is wrong without a warning. Runs and results go to output/stability:
outcomes.csv (all runs), stability.png, stability.md. A run that is there with the same scene and settings is not made again, however it ended; delete its folder to repeat it. With --doc
doc/stability.md, doc/figures/stability.png and benchmarks/stability/outcomes.csv are renewed.

Each run has one rank and at most --limit CPU seconds.
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

import explicit_limit  # noqa: E402
import maps  # noqa: E402
import outcomes  # noqa: E402


def arguments():
    names = [map_.name for map_ in maps.MAPS]
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--build", type=pathlib.Path, default=run_scenes.ROOT / "build/release", help="folder of the program (default: build/release)")
    parser.add_argument("--quick", action="store_true", help="without the finest meshes and the smallest steps")
    parser.add_argument("--maps", default=",".join(names), help="maps to compute (default: all); the table has all that are there")
    parser.add_argument("--jobs", type=int, default=1, help="runs at a time (default 1)")
    parser.add_argument("--limit", type=int, help="CPU seconds of a run (default: 200, with --quick 100)")
    parser.add_argument("--draw", action="store_true", help="compute nothing: chart and page of outcomes.csv, of output/stability or else of the repository")
    parser.add_argument("--doc", action="store_true", help="renew the page, the figure and the table of outcomes in the repository")
    parser.add_argument("--explicit-limit", action="store_true", help="the longest stable explicit step on a fine mesh, beside implicit steps (an hour): renews explicit_limit.csv first")
    parser.add_argument("--validate", action="store_true", help="compute nothing: whether the program takes the settings of all rows, in their last column")
    args = parser.parse_args()
    unknown = set(args.maps.split(",")) - set(names)
    if unknown:
        parser.error(f"--maps: got {', '.join(sorted(unknown))}; allowed: {', '.join(names)}")
    for name in ("jobs", "limit"):
        if getattr(args, name) is not None and getattr(args, name) < 1:
            parser.error(f"--{name} {getattr(args, name)}; allowed: a number >= 1")
    args.program = args.build / "tanktread"
    if not args.draw and not args.program.is_file():
        parser.error(f"{args.program} is missing: build it (cmake --preset release && cmake --build --preset release) or name its folder with --build")
    args.ranks, args.resume, args.cpu_limit = 1, False, args.limit or (100 if args.quick else 200)
    return args


def wanted_cells(args):
    return [cell for map_ in maps.MAPS if map_.name in args.maps.split(",") for cell in maps.cells_of(map_, args.quick)]


def measure(args):
    """Makes the runs that are missing; the table of all."""
    left = [cell for cell in wanted_cells(args) if outcomes.record_of(cell) is None]
    run_scenes.compute(args, [(outcomes.run_of(cell), maps.name(cell), maps.settings(cell)) for cell in left])
    return outcomes.collect(args.quick, args.jobs)


def validate(args):
    """Exit code 1 and what the program says where it does not take a setting."""
    refused = 0
    for cell in wanted_cells(args):
        if cell.column is not maps.cells_of(cell.map, args.quick)[-1].column:
            continue
        words = [word for name, value in maps.settings(cell).items() for word in ("--set", f"{name}={value}")]
        said = subprocess.run([args.program, "--validate", outcomes.run_of(cell).prm, *words], stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, check=False)
        if said.returncode != 0:
            refused += 1
            print(f"{maps.name(cell)}: {said.stdout.strip()}")
    print(f"{refused} refused")
    return 1 if refused else 0


def main():
    args = arguments()
    if args.validate:
        return validate(args)
    import chart  # not before: matplotlib takes a second
    import report
    if args.explicit_limit:
        args.cpu_limit = None
        explicit_limit.measure(args)
        args.draw = True
    file = outcomes.OUTPUT / "outcomes.csv"
    run_table.renew(args, pathlib.Path(__file__).resolve().parent, file, outcomes.NUMBERS, lambda: outcomes.write(file, *measure(args)), chart.draw, report.page)
    return 0


if __name__ == "__main__":
    run_scenes.call(main)
