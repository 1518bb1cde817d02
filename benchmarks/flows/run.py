#!/usr/bin/env python3
# SPDX-License-Identifier: LGPL-2.1-or-later
# Part of Tanktread: computes, draws and reports scenes of several capsules and of flows other than shear alone.
"""Compute a pair that passes in shear, planar and uniaxial extension, plane Poiseuille flow and a capsule above a wall, and compare them with independent
solutions.

    run.py [wall ...] [--quick | --wide | --full | --unbounded | --unbounded-full] [--jobs N] [--ranks N] [--resume] [--draw] [--update-doc]

Without names all scenes are computed. The parameter files are beside this script, results go to output/flows/<resolution>/<scene>, figures to
output/flows/figures, the report to output/flows/report.md. A run that fails or that the program refuses does not stop the others; the report says so. The
report is made of all runs that are there, at all resolutions, those of earlier calls included.

doc/flows.md and its figures change with --update-doc only: those scenes that are named, or all, that have results at every resolution that doc/ shows. What
was not computed stays as it is.
"""

import argparse
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
import python_packages  # noqa: E402

python_packages.need("numpy", "matplotlib")

import plot_style  # noqa: E402, F401
import report_parts  # noqa: E402
import run_scenes  # noqa: E402

import figures  # noqa: E402
import report  # noqa: E402
import scenes  # noqa: E402


def arguments():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("names", nargs="*", metavar="SCENE", help=", ".join(scenes.SCENES) + "; all if none is given")
    size = parser.add_mutually_exclusive_group()
    for name in scenes.RESOLUTIONS:
        size.add_argument(f"--{name}", action="store_const", dest="resolution", const=name, default="quick", help=scenes.described(name))
    run_scenes.add_arguments(parser)
    args = parser.parse_args()
    unknown = [name for name in args.names if name not in scenes.SCENES]
    if unknown:
        parser.error(f"no such scene: {', '.join(unknown)}; there are {', '.join(scenes.SCENES)}")
    without = [name for name in args.names if not scenes.is_at(name, args.resolution)]
    if without:
        parser.error(f"--{args.resolution}: {', '.join(without)} has walls, which are not in unbounded liquid")
    run_scenes.check_arguments(parser, args)
    return args


def update_doc(args, results, drawn):
    """In doc/ the scenes asked for that have results at every resolution shown so far."""
    doc, renewed = run_scenes.ROOT / "doc", []
    sections = report_parts.former_sections(doc / "flows.md")
    for name in args.names or scenes.SCENES:
        missing = report.resolutions_in(sections.get(report.heading(name), "")) - {result.resolution for result in results[name] if result.capsules}
        if name not in drawn:
            print(f"{name}: stays as it is in doc/, it has no results")
        elif missing:
            print(f"{name}: stays as it is in doc/, which has it at {', '.join(sorted(missing))}")
        else:
            draw(name, results, doc / "figures/flows")
            renewed.append(name)
    report.write(doc / "flows.md", results, renewed, "figures/flows", keep_others=True)


def draw(name, results, folder):
    figures.draw(name, [result for result in results[name] if result.capsules], folder)


def main():
    args = arguments()
    if not args.draw:
        names = args.names or [name for name in scenes.SCENES if scenes.is_at(name, args.resolution)]
        run_scenes.compute(args, [(scenes.run_of(name), args.resolution, scenes.settings(name, args.resolution)) for name in names])
    results = {name: [scenes.Result(name, resolution) for resolution in scenes.RESOLUTIONS] for name in scenes.SCENES}
    tried = [name for name in scenes.SCENES if any(result.record for result in results[name])]
    drawn = [name for name in tried if any(result.capsules for result in results[name])]
    for name in drawn:
        draw(name, results, scenes.OUTPUT / "figures")
    report.write(scenes.OUTPUT / "report.md", results, tried, "figures")
    if args.update_doc:
        update_doc(args, results, drawn)
    return 0


if __name__ == "__main__":
    run_scenes.call(main)
