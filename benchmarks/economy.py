#!/usr/bin/env python3
# SPDX-License-Identifier: LGPL-2.1-or-later
# Part of Tanktread: what the program saves by computing only what a scene needs: the same scene with each saving and without it.
"""Run scenes as cheaply as the program can, and the same with the expensive path forced by its parameters; compare seconds and results.

    economy.py [--cells 32,64] [--savings stokes,far_field] [--repeat 3] [--report] [--update-doc]

Runs are on one rank, one after the other, with and without a saving in turn. What has been measured with the same settings is not measured again: delete it, or
raise --repeat. --report runs nothing. The report goes to output/economy/economy.md, with --update-doc to doc/economy.md. Measure on an idle machine.
"""

import argparse
import collections
import json
import math
import os
import pathlib
import statistics
import subprocess
import sys

import python_packages

python_packages.need("numpy", "matplotlib")

import report_parts  # noqa: E402
import run_files  # noqa: E402
import run_scenes  # noqa: E402

PRM = pathlib.Path(__file__).resolve().parent / "economy.prm"
LEVELS = {16: 1, 32: 2, 64: 3, 128: 4}
BENDING, MEMBRANE = "sphere_G0.2_k0.04_variational.csv", "sphere_G0.2_k0.csv"

# cheap, dear: functions of the number of cells that 10 a are divided into; what is read: values at the end, or the limit that the history is extrapolated to
Saving = collections.namedtuple("Saving", "title scene reference common cheap dear dear_in_words read", defaults=("end",))
NO_BENDING = {"Scene/Reduced bending modulus": 0}
LONG = {"Scene/End time": 20}
SAVINGS = {
    "stokes": Saving("no inertia", "between faces, box 20a", BENDING, {"Scene/Boundary": "faces", "Scene/Box side": 20, "Fluid mesh/Coarsest cell": 2.5},
                     lambda n: {"Scene/Reynolds number": 0}, lambda n: {"Scene/Reynolds number": 1e-6}, "Re = 10⁻⁶"),
    "lambda": Saving("one viscosity", "unbounded", BENDING, {}, lambda n: {"Scene/Viscosity ratio": 1}, lambda n: {"Scene/Viscosity ratio": "1.000000001"},
                     "λ = 1 + 10⁻⁹: strain form, cut cells part by part"),
    "bending": Saving("no bending", "unbounded, κ̂ = 0", MEMBRANE, {}, lambda n: NO_BENDING, lambda n: {"Scene/Reduced bending modulus": 1e-9},
                      "κ̂ = 10⁻⁹: second derivatives of the surface"),
    "membrane": Saving("no thickness", "unbounded, κ̂ = 0", MEMBRANE, NO_BENDING, lambda n: {"Capsule/Thickness": 0}, lambda n: {"Capsule/Thickness": 1e-5},
                       "h = 10⁻⁵a: integrals across the shell"),
    "far_field": Saving("small box in unbounded liquid", "unbounded, 7.5a", BENDING, {}, lambda n: {},
                        lambda n: {"Scene/Boundary": "faces", "Scene/Box side": 40, "Fluid mesh/Coarsest cell": 2.5}, "box 40a between faces"),
    "coarse_far_cells": Saving("octree", "unbounded, 7.5a", BENDING, {"Scene/End time": 1}, lambda n: {}, lambda n: {"Fluid mesh/Coarsest cell": 10 / n},
                               "all cells as fine as those at the shell"),
    "enriched": Saving("enriched interface", "unbounded", BENDING, {}, lambda n: {"Solver/Interface": "enriched"},
                       lambda n: {"Solver/Interface": "plain", "Fluid mesh/Finest cell": 5 / n}, "plain interface, cells of half the side"),
    "matrix_free": Saving("matrix-free operators", "unbounded", BENDING, {}, lambda n: {"Solver/Method": "matrix-free"}, lambda n: {"Solver/Method": "assembled"},
                          "assembled matrices, algebraic multigrid"),
    "stop": Saving("stop when steady", "unbounded, to γ̇t = 20", BENDING, LONG, lambda n: {"Time/Steady tolerance": 1e-3}, lambda n: {"Time/Steady tolerance": 0},
                   "to the end time"),
    "limit": Saving("stop when the limit is known", "unbounded, to γ̇t = 20", BENDING, LONG, lambda n: {"Time/Limit tolerance": 1e-3},
                    lambda n: {"Time/Limit tolerance": 0}, "to the end time", "limit"),
}


# ---------------------------------------------------------------------------------------------------------------------- computing
def settings_of(saving, cells, is_cheap):
    mesh = {"Fluid mesh/Finest cell": 10 / cells, "Shell mesh/Level": LEVELS[cells]}
    chosen = (saving.cheap if is_cheap else saving.dear)(cells)
    return {key: str(value) for key, value in {**mesh, **saving.common, **chosen}.items()}


def folder_of(args, name, cells, is_cheap):
    return args.output / f"{name}_{cells}" / ("with" if is_cheap else "without")


def record_of(args, name, cells, is_cheap):
    """What has been measured with these settings, an empty record if nothing."""
    file = folder_of(args, name, cells, is_cheap) / "economy.json"
    key = {"prm": PRM.read_text(), "settings": settings_of(SAVINGS[name], cells, is_cheap)}
    found = json.loads(file.read_text()) if file.is_file() else {}
    return found if found.get("input") == key else {"input": key, "exit_code": 0, "seconds": [], "memory": [], "loads": []}


def measure(args, name, cells, is_cheap):
    """One run more."""
    folder, record = folder_of(args, name, cells, is_cheap), record_of(args, name, cells, is_cheap)
    command = [str(args.program.resolve()), str(PRM), "--set", f"Output/Directory={folder}"]
    for key, value in record["input"]["settings"].items():
        command += ["--set", f"{key}={value}"]
    folder.mkdir(parents=True, exist_ok=True)
    load = os.getloadavg()[0]
    with open(args.output / "screen.txt", "w", encoding="utf-8") as screen:
        process = subprocess.Popen(command, stdout=screen, stderr=subprocess.STDOUT, env={**os.environ, "OMP_NUM_THREADS": "1"})
        _, status, usage = os.wait4(process.pid, 0)
    record["exit_code"] = process.returncode = os.waitstatus_to_exitcode(status)
    record["seconds"].append(round(usage.ru_utime + usage.ru_stime, 2))
    record["memory"].append(round(usage.ru_maxrss / 1024))
    record["loads"].append(round(load, 2))
    folder.mkdir(parents=True, exist_ok=True)  # the program has moved a former run away
    (folder / "economy.json").write_text(json.dumps(record, indent=1) + "\n")
    print(f"{folder.relative_to(args.output)}: {record['seconds'][-1]} CPU s" + (f", exit code {record['exit_code']}" if record["exit_code"] else ""), flush=True)


def measure_all(args):
    for cells in args.cells:
        for name in args.savings:
            for repeat in range(args.repeat):
                for is_cheap in (True, False):
                    record = record_of(args, name, cells, is_cheap)
                    if record["exit_code"] == 0 and len(record["seconds"]) <= repeat:
                        measure(args, name, cells, is_cheap)


# -------------------------------------------------------------------------------------------------------------------------- reading
class Measured:
    """A run and what it has left. D and theta are what it says about the shape: at its end, or in the limit."""

    def __init__(self, args, name, cells, is_cheap):
        saving, folder = SAVINGS[name], folder_of(args, name, cells, is_cheap)
        self.record = record_of(args, name, cells, is_cheap)
        self.is_there = bool(self.record["seconds"]) and self.record["exit_code"] == 0 and (folder / "history.csv").is_file()
        if not self.is_there:
            return
        history, _ = run_files.read_table(folder / "history.csv")
        self.seconds, self.memory = statistics.median(self.record["seconds"]), max(self.record["memory"])
        self.steps, self.cells = len(history["time"]) - 1, history["cells"][-1]
        self.newton, self.linear = history["newton_iterations"][1:].sum(), history["linear_iterations"][1:].sum()
        self.time, self.D, self.theta = history["time"][-1], history["D_xz"][-1], history["theta"][-1]
        if saving.read == "limit" and is_cheap:
            summary = dict(line.split(",", 1) for line in (folder / "summary.csv").read_text().splitlines()[1:])
            self.D, self.theta = (run_files.number(summary.get(key, "nan")) for key in ("D_limit", "theta_limit"))
        reference = run_files.standard_columns(run_files.read_table(run_files.REFERENCE_FOLDER / saving.reference)[0])
        # A run that stops early speaks of the end of the long one.
        self.end = float(self.record["input"]["settings"].get("Scene/End time", self.time))
        wanted = min(self.end, reference["time"][-1])
        self.error = self.D / run_files.interpolated(reference["time"], reference["D"], wanted) - 1


def small(value, unit=""):
    return "–" if math.isnan(value) else "0" if value == 0 else f"{value:.1e}{unit}"


def percent(value):
    return "–" if math.isnan(value) else f"{100 * value:+.3f} %"


def title_of(name):
    return SAVINGS[name].title


def row(name, cheap, dear):
    """Cells of the first table."""
    saving = SAVINGS[name]
    head = [saving.title, saving.scene, saving.dear_in_words]
    if not (cheap.is_there and dear.is_there):
        states = ["" if run.is_there else f"exit code {run.record['exit_code']}" if run.record["exit_code"] else "not measured" for run in (cheap, dear)]
        return head + [*states, *["–"] * 5]
    return head + [f"{cheap.seconds:.1f}", f"{dear.seconds:.1f}", f"{dear.seconds / cheap.seconds:.1f}", small(abs(cheap.D / dear.D - 1)),
                   small(abs(cheap.theta - dear.theta)), percent(cheap.error), percent(dear.error)]


def of_both(cheap, dear, text):
    return " / ".join(text(run) if run.is_there else "–" for run in (cheap, dear))


def tables(args, cells):
    pairs = {name: [Measured(args, name, cells, is_cheap) for is_cheap in (True, False)] for name in SAVINGS}
    pairs = {name: pair for name, pair in pairs.items() if any(run.record["seconds"] for run in pair)}
    if not pairs:
        return ""
    head = ["saving", "scene", "without it", "CPU s with", "CPU s without", "factor", "difference of D", "of θ/π", "error of D with", "without"]
    work = [[title_of(name), of_both(*pair, lambda run: str(run.steps)), of_both(*pair, lambda run: f"{run.newton:.0f}"), of_both(*pair, lambda run: f"{run.linear:.0f}"),
             of_both(*pair, lambda run: f"{run.cells:.0f}"), of_both(*pair, lambda run: str(run.memory)), of_both(*pair, lambda run: str(len(run.record["seconds"])))]
            for name, pair in pairs.items()]
    return (f"## Cells of 10a/{cells} at the shell, {10 * 4 ** LEVELS[cells] + 2} control points\n\n" + report_parts.table(head, [row(name, *pair) for name, pair in pairs.items()])
            + "\nWith / without:\n\n" + report_parts.table(["saving", "steps", "Newton iterations", "linear iterations", "cells at the end", "memory, MiB", "runs"], work))


def processor():
    lines = pathlib.Path("/proc/cpuinfo").read_text().splitlines() if pathlib.Path("/proc/cpuinfo").is_file() else []
    return next((line.split(":", 1)[1].strip() for line in lines if line.startswith("model name")), "a processor without a name")


def conditions(args, all_cells):
    """A sentence about the machine: whether anything else was computed meanwhile."""
    records = [record_of(args, name, cells, is_cheap) for cells in all_cells for name in SAVINGS for is_cheap in (True, False)]
    loads = [load for record in records for load in record["loads"]]
    highest = max(loads, default=0)
    busy = " **The machine was busy: the seconds are rough, iterations and results are not touched by it.**" if highest > 1.5 else ""
    return f"Largest load average before a run: {highest:.1f}; these runs alone make 1.{busy}"


INTRODUCTION = """# What is saved

Made by `benchmarks/economy.py`. The program computes what a scene needs and no more. Here the same scene is computed with each saving and without it: parameters next to the value at which
the program leaves something out force the expensive way, or a larger box, finer cells and a longer run take the place of what the saving makes unnecessary.

A neo-Hookean sphere in shear, G = 0.2, κ̂ = 0.04 (or 0), steps of 0.1, from rest to γ̇t = 2 (all cells equally fine: 1) or as said. One rank; CPU seconds of whole runs, starting and
writing included, the median of the runs. Differences are between the two runs at their ends: of D relative, of θ/π absolute; where they are equivalent nothing but the tolerance of Newton's
method (10⁻⁴) and the parameter's small value is between them (with tight tolerances the histories agree to 10⁻⁷: tests `run/savings_agree` and its kin). Errors of D are against the boundary-integral solutions for unbounded liquid (`benchmarks/reference`), at the end; between faces
they include the box. The stop by the limit reports what the history is extrapolated to, other runs their last values.
"""


def report(args):
    all_cells = sorted({int(folder.name.rsplit("_", 1)[1]) for folder in args.output.glob("*_*") if folder.is_dir()} & set(LEVELS))
    parts = [part for part in (tables(args, cells) for cells in all_cells) if part]
    machine = f"Measured on {processor()}. {conditions(args, all_cells)}\n"
    return "\n".join([INTRODUCTION, machine, *parts])


# ------------------------------------------------------------------------------------------------------------------------- calling
def arguments():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--cells", type=lambda text: [int(word) for word in text.split(",")], default=[32, 64], help="cells at the shell have sides of 10 a over this")
    parser.add_argument("--savings", type=lambda text: text.split(","), default=list(SAVINGS), help=f"default: {','.join(SAVINGS)}")
    parser.add_argument("--repeat", type=int, default=1, help="runs of each kind, of which the median counts")
    parser.add_argument("--report", action="store_true", help="run nothing: report what is there")
    parser.add_argument("--update-doc", action="store_true", help="write doc/economy.md")
    parser.add_argument("--program", type=pathlib.Path, default=run_scenes.ROOT / "build/release/tanktread", help="default: build/release/tanktread")
    parser.add_argument("--output", type=pathlib.Path, default=run_scenes.ROOT / "output/economy")
    args = parser.parse_args()
    for name, allowed in (("cells", LEVELS), ("savings", SAVINGS)):
        unknown = [str(value) for value in getattr(args, name) if value not in allowed]
        if unknown:
            parser.error(f"--{name}: got {', '.join(unknown)}; allowed: {', '.join(map(str, allowed))}")
    if args.repeat < 1:
        parser.error(f"--repeat {args.repeat}; allowed: a number >= 1")
    if not args.report and not args.program.is_file():
        parser.error(f"{args.program} is missing: build it (cmake --preset release && cmake --build --preset release) or name it with --program")
    args.output = args.output.resolve()
    return args


def main():
    args = arguments()
    args.output.mkdir(parents=True, exist_ok=True)
    if not args.report:
        measure_all(args)
    text = report(args)
    files = [args.output / "economy.md"] + ([run_scenes.ROOT / "doc/economy.md"] if args.update_doc else [])
    for file in files:
        file.write_text(text, encoding="utf-8")
        print(file)
    return 0


if __name__ == "__main__":
    run_scenes.call(main)
