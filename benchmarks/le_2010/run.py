#!/usr/bin/env python3
# SPDX-License-Identifier: LGPL-2.1-or-later
# Part of Tanktread: computes and draws the figures of Le, Phys. Rev. E 82, 016318 (2010).
"""Compute the scenes of Le (2010), draw his figures beside independent solutions, and report.

    run.py [fig05 ...] [--quick | --fair | --full] [--jobs N] [--ranks N] [--resume] [--draw] [--update-doc]

Without names all figures are computed, each run for a target error (Accuracy/Target error) and with a companion that tells its error bars. The parameter files
are in the folders fig01 ... fig12 beside this script, results go to output/le_2010/<resolution>/<figure>/<run>, figures to output/le_2010/figures, the report
to output/le_2010/report.md. A run that fails or that the program refuses does not stop the others; the report says so. The report is made of all runs that are
there, those of earlier calls included, each at the finest resolution at which it was done.

doc/le_2010.md and its figures change with --update-doc only: those figures that are named, or all, whose runs are all there, none of them coarser than
what doc/ shows. What was not computed stays as it is.
"""

import argparse
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
import python_packages  # noqa: E402

python_packages.need("numpy", "matplotlib")

import plot_style  # noqa: E402, F401
import run_scenes  # noqa: E402

import figures  # noqa: E402
import report  # noqa: E402
import runs  # noqa: E402


def arguments():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("names", nargs="*", metavar="FIGURE", help="fig01 ... fig12, or single runs as fig05/G0.05_k0; all figures if none is given")
    size = parser.add_mutually_exclusive_group()
    for name in runs.RESOLUTIONS:
        size.add_argument(f"--{name}", action="store_const", dest="resolution", const=name, default="quick", help=runs.described(name))
    run_scenes.add_arguments(parser)
    args = parser.parse_args()
    unknown = [name for name in args.names if not (runs.HERE / name).is_dir() and not (runs.HERE / f"{name}.prm").is_file()]
    if unknown:
        parser.error(f"no such figure or run: {', '.join(unknown)}; there are {', '.join(runs.figure_names())}")
    run_scenes.check_arguments(parser, args)
    return args


def update_doc(args, results):
    """In doc/ the figures asked for whose runs are all there, none coarser than those shown so far."""
    doc = run_scenes.ROOT / "doc"
    renewed = []
    for name in sorted({name.split("/")[0] for name in args.names}) or runs.figure_names():
        finer = report.finer_runs(doc / "le_2010.md", results, name)
        if not results.are_complete(name):
            print(f"{name}: stays as it is in doc/, not all of its runs are there")
        elif finer:
            print(f"{name}: stays as it is in doc/, which has {', '.join(finer)} at a finer resolution")
        else:
            figures.draw(name, results, doc / "figures/le_2010")
            renewed.append(name)
    report.write(doc / "le_2010.md", results, renewed, "figures/le_2010", keep_others=True)


def main():
    args = arguments()
    if not args.draw:
        run_scenes.compute(args, [(run, args.resolution, runs.settings(run, args.resolution)) for run in runs.find(args.names)])
    results = runs.Results()
    drawn = [name for name in runs.figure_names() if figures.draw(name, results, runs.OUTPUT / "figures")]
    report.write(runs.OUTPUT / "report.md", results, drawn, "figures")
    if args.update_doc:
        update_doc(args, results)
    return 0


if __name__ == "__main__":
    run_scenes.call(main)
