#!/usr/bin/env python3
# SPDX-License-Identifier: LGPL-2.1-or-later
# Part of Tanktread: how time, messages and memory grow with capsules and ranks.
"""Compute scenes of 1, 2, 4, ... capsules on 1, 2, 4, ... ranks and report how the program scales, with a model of what is beyond.

    run.py [proportion weak strong messages memory] [--full] [--ranks 1,2,4] [--resume] [--draw] [--update-doc]

Each capsule brings its own liquid: 10 % of the box are capsules, or --fraction. Runs are one after the other; count_mpi.c, compiled with mpicc and loaded before the program, says what the ranks
send and how much processor time they have outside of MPI, which more ranks than cores or a busy machine change little. Results go to output/scaling/<case>, table, page and figure to
output/scaling; doc/scaling.md and its figure change with --update-doc alone. On a cluster: scaling.slurm.
"""

import argparse
import os
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
import python_packages  # noqa: E402

python_packages.need("numpy", "matplotlib")

import run_scenes  # noqa: E402
import run_table  # noqa: E402

import cases  # noqa: E402
import chart  # noqa: E402
import points  # noqa: E402
import report  # noqa: E402


def numbers(text):
    return sorted({int(word) for word in text.split(",")})


def arguments():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("names", nargs="*", metavar="SERIES", help="; ".join(f"{name}: {about}" for name, about in cases.SERIES.items()) + "; all if none is given")
    parser.add_argument("--full", action="store_true", help="8 capsules a rank in place of 2, 16 steps in place of 8")
    parser.add_argument("--ranks", type=numbers, help="numbers of ranks (default: 1,2,4; memory to 8, messages to 16)")
    parser.add_argument("--fraction", type=float, default=0.1, help="volume of the capsules over that of the box (default 0.1; the scene of 16 on several ranks has twice that)")
    parser.add_argument("--launcher", default=cases.LAUNCHER, help=f"starts the program on {{ranks}} ranks (default: {cases.LAUNCHER})")
    parser.add_argument("--resume", action="store_true", help="leave out runs that are finished with the same parameters")
    parser.add_argument("--draw", action="store_true", help="compute nothing: report what is there")
    parser.add_argument("--update-doc", action="store_true", help="write doc/scaling.md and its figure")
    parser.add_argument("--program", type=pathlib.Path, default=run_scenes.ROOT / "build/release/tanktread", help="default: build/release/tanktread")
    parser.add_argument("--output", type=pathlib.Path, default=run_scenes.ROOT / "output/scaling")
    args = parser.parse_args()
    unknown = [name for name in args.names if name not in cases.SERIES]
    if unknown:
        parser.error(f"no such series: {', '.join(unknown)}; there are {', '.join(cases.SERIES)}")
    if args.ranks is not None and args.ranks[0] < 1:
        parser.error(f"--ranks {args.ranks[0]}; allowed: numbers >= 1")
    if not 0 < args.fraction <= 0.15:
        parser.error(f"--fraction {args.fraction:g}; allowed: above 0, at most 0.15 (the densest scene has twice that on a lattice)")
    if not args.draw and not args.program.is_file():
        parser.error(f"{args.program} is missing: build it (cmake --preset release && cmake --build --preset release) or name it with --program")
    args.program, args.output, args.doc = args.program.resolve(), args.output.resolve(), args.update_doc
    return args


def measure(args, series):
    """Makes the runs; both tables, of what is there when they are interrupted."""
    names = args.names or list(cases.SERIES)
    try:
        cases.compute(args, list(dict.fromkeys(case for name in names for case in series[name])))
    finally:
        points.write(args, series)


def main():
    args = arguments()
    series, here = cases.series(args.full, args.ranks, args.fraction), pathlib.Path(__file__).resolve().parent
    run_table.renew(args, here, args.output / "points.csv", points.NUMBERS, lambda: measure(args, series), chart.draw,
                    lambda notes, rows, link: report.page(notes, rows, link, report.read_places(args)))
    if args.update_doc and (args.output / "places.csv").is_file():
        (here / "places.csv").write_bytes((args.output / "places.csv").read_bytes())
    return 0


if __name__ == "__main__":
    os.environ.setdefault("OMP_NUM_THREADS", "1")
    run_scenes.call(main)
