#!/usr/bin/env python3
# SPDX-License-Identifier: LGPL-2.1-or-later
# Part of Tanktread: computes and draws the figures of Le, Phys. Rev. E 82, 016318 (2010).
"""Compute the scenes of Le (2010), draw his figures beside independent solutions, and write the report doc/le_2010.md.

    run.py [fig05 ...] [--quick | --full] [--ranks N] [--resume] [--draw]

Without names all figures are computed. The parameter files are in the folders fig01 ... fig12 beside this script, results go to output/le_2010/<resolution>/<figure>/<run>. A run
that fails or that the program refuses does not stop the others; the report says so. The report is made of all runs that are there, those of earlier calls included, each at the
finest resolution at which it was done.
"""

import argparse
import json
import os
import pathlib
import re
import subprocess
import sys
import time

import figures
import report
import runs

def arguments():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("names", nargs="*", metavar="FIGURE", help="fig01 ... fig12, or single runs as fig05/G0.05_k0; all figures if none is given")
    size = parser.add_mutually_exclusive_group()
    size.add_argument("--quick", action="store_const", dest="resolution", const="quick", default="quick", help="h = 10a/32, 162 control points, box 20a (default)")
    size.add_argument("--full", action="store_const", dest="resolution", const="full", help="h = 10a/64, 642 control points, box 40a")
    parser.add_argument("--ranks", type=int, default=1, help="MPI ranks of a run (default 1)")
    parser.add_argument("--resume", action="store_true", help="leave out runs that are finished with the same parameters")
    parser.add_argument("--draw", action="store_true", help="compute nothing: draw and report what is there")
    parser.add_argument("--program", type=pathlib.Path, default=runs.ROOT / "build/release/tanktread", help="default: build/release/tanktread")
    args = parser.parse_args()
    unknown = [name for name in args.names if not (runs.HERE / name).is_dir() and not (runs.HERE / f"{name}.prm").is_file()]
    if unknown:
        parser.error(f"no such figure or run: {', '.join(unknown)}; there are {', '.join(runs.figure_names())}")
    if not args.draw and not args.program.is_file():
        parser.error(f"{args.program} is missing: build it (cmake --preset release && cmake --build --preset release) or name it with --program")
    return args


def command(args, run, settings):
    words = [str(args.program), str(run.prm)]
    for name, value in {**settings, "Output/Directory": str(run.folder(args.resolution))}.items():
        words += ["--set", f"{name}={value}"]
    return words if args.ranks == 1 else ["mpirun", "-np", str(args.ranks)] + words


def show(text, last=False):
    """The state of a run: one line that changes on a terminal, few lines in a file."""
    if sys.stdout.isatty():
        print(f"\r\033[K{text}", end="\n" if last else "", flush=True)
    elif last:
        print(text, flush=True)


def compute(args, run, title):
    """Runs the program; returns what is recorded in run.json."""
    settings = runs.RESOLUTIONS[args.resolution]
    folder = run.folder(args.resolution)
    end = run.end_time()
    start, tail = time.time(), []
    environment = {"OMP_NUM_THREADS": "1", **os.environ}
    process = subprocess.Popen(command(args, run, settings), stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, env=environment, cwd=runs.ROOT)
    try:
        for line in process.stdout:
            tail = tail[-7:] + [line.strip()]
            words = line.split()
            if len(words) == 9 and re.fullmatch(r"\d+", words[0]):
                show(f"{title}: t = {words[1]} of {end}, D = {words[5]}, remaining {words[8]}")
        code = process.wait()
    except KeyboardInterrupt:
        process.terminate()
        process.wait()
        raise
    message = "" if code == 0 else next((text for text in tail if "not available" in text or "FAILED" in text), " ".join(tail[-1:]))
    record = {"input": run.key(settings), "exit_code": code, "message": message, "seconds": round(time.time() - start, 1), "ranks": args.ranks, "settings": settings}
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "run.json").write_text(json.dumps(record, indent=1) + "\n")
    outcome = "done" if code == 0 else f"exit code {code}: {message}"
    show(f"{title}: {outcome}, {record['seconds']:.0f} s", last=True)
    return record


def main():
    args = arguments()
    wanted = runs.find(args.names)
    if not args.draw:
        for i, run in enumerate(wanted):
            title = f"[{i + 1}/{len(wanted)}] {args.resolution} {run.name}"
            if args.resume and run.is_finished(args.resolution, runs.RESOLUTIONS[args.resolution]):
                show(f"{title}: finished before", last=True)
            else:
                compute(args, run, title)
    results = runs.Results()
    for name in runs.figure_names():
        figures.draw(name, results, runs.ROOT / "doc/figures/le_2010")
    report.write(runs.ROOT / "doc/le_2010.md", results)
    return 0


if __name__ == "__main__":
    try:
        sys.exit(main())
    except KeyboardInterrupt:
        print("\nstopped; --resume goes on with the runs that are left")
        sys.exit(130)
