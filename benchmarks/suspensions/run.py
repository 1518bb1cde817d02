#!/usr/bin/env python3
# SPDX-License-Identifier: LGPL-2.1-or-later
# Part of Tanktread: computes, draws and reports scenes with several capsules.
"""Compute pairs with inertia, a crossing pair of more viscous capsules and suspensions between walls, beside published figures.

    run.py [SCENE or GROUP ...] [--quick | --full] [--jobs N] [--ranks N] [--resume] [--draw] [--update-doc]

Without names all scenes are computed, which takes hours; groups are inertia, crossing, suspension, red, speed. The parameter files are beside this script, results go to
output/suspensions/<resolution>/<scene>, figures to output/suspensions/figures, the report to output/suspensions/report.md, made of all runs that are there.

doc/suspensions.md and its figures change with --update-doc only: those groups that are named, or that have a scene named, or all, as far as they have results.
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
import results  # noqa: E402
import scenes  # noqa: E402


def arguments():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("names", nargs="*", metavar="SCENE", help="groups: " + ", ".join(report.TITLES) + "; scenes: " + ", ".join(scenes.SCENES))
    size = parser.add_mutually_exclusive_group()
    for name in scenes.RESOLUTIONS:
        size.add_argument(f"--{name}", action="store_const", dest="resolution", const=name, default="quick", help=f"cells of about {scenes.CELLS[name]:g} a in suspensions")
    run_scenes.add_arguments(parser)
    args = parser.parse_args()
    unknown = [name for name in args.names if name not in scenes.SCENES and name not in report.TITLES]
    if unknown:
        parser.error(f"no such scene or group: {', '.join(unknown)}; there are {', '.join([*report.TITLES, *scenes.SCENES])}")
    args.wanted = [name for name, scene in scenes.SCENES.items() if not args.names or name in args.names or scene.group in args.names]
    without = [name for name in args.wanted if name in args.names and not scenes.is_at(name, args.resolution)]
    if without:
        parser.error(f"--{args.resolution}: {', '.join(without)} is for --{scenes.SCENES[without[0]].only}")
    run_scenes.check_arguments(parser, args)
    return args


def draw(group, tried, folder):
    shown = [result for result in tried[group] if result.capsules and result.end() > 0]
    if shown and group in figures.DRAW:
        figures.draw(group, shown, folder)


def main():
    args = arguments()
    if not args.draw:
        names = [name for name in args.wanted if scenes.is_at(name, args.resolution)]
        run_scenes.compute(args, [(scenes.run_of(name), args.resolution, scenes.settings(name, args.resolution)) for name in names])
    found = results.load()
    tried = {group: [result for name, of_scene in found.items() if scenes.SCENES[name].group == group for result in of_scene] for group in report.TITLES}
    groups = [group for group in report.TITLES if tried[group]]
    for group in groups:
        draw(group, tried, scenes.OUTPUT / "figures")
    report.write(scenes.OUTPUT / "report.md", tried, groups, "figures")
    if args.update_doc:
        doc, renewed = run_scenes.ROOT / "doc", [group for group in groups if any(scenes.SCENES[name].group == group for name in args.wanted)]
        for group in renewed:
            draw(group, tried, doc / "figures/suspensions")
        report.write(doc / "suspensions.md", tried, renewed, "figures/suspensions", keep_others=True)
    return 0


if __name__ == "__main__":
    run_scenes.call(main)
