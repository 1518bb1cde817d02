#!/usr/bin/env python3
# SPDX-License-Identifier: LGPL-2.1-or-later
# Part of Tanktread: accuracy of the two interfaces: flows of given forces, steady capsules in boxes of several sizes, transients.
"""Measure how accurate the plain and the enriched interface are, and draw it.

    interface_study.py --build build/release [--parts flows,steady,transients,figures,tables] [--output output/interface_study] [--nice]

flows       the program interface_study: errors of surface velocity and power, CPU seconds, mesh by mesh -> flows.csv
steady      runs of tanktread until the shape is steady, in boxes of 20 a, 40 a and 80 a and with several time steps
transients  runs of tanktread from the sphere at rest, with two time steps
figures     error against h and against CPU seconds, D(t) and theta(t) beside the references -> the folder figures
            of the output; --figures doc/figures renews those of accuracy.md
tables      Markdown on the standard output, as in doc/accuracy.md

All runs are on one rank, one after the other. A run whose folder has a finished log is not made again: delete the folder to repeat it. Figures and tables
take what is there and name what is missing.
"""

import argparse
import collections
import csv
import os
import pathlib
import subprocess
import sys

import python_packages

python_packages.need("numpy", "matplotlib")

import plot_style  # noqa: E402, F401
import matplotlib.pyplot as plt  # noqa: E402
import matplotlib.ticker  # noqa: E402
import numpy as np  # noqa: E402

from run_files import read_table  # noqa: E402

ROOT = pathlib.Path(__file__).resolve().parent.parent
REFERENCES = ROOT / "benchmarks/reference"
PARTS = ["flows", "steady", "transients", "figures", "tables"]

# Steps of the transients, each half of the one before: the stiffer capsule gets its shape sooner.
Case = collections.namedtuple("Case", "name G khat form end steps")
CASES = [Case("G0.05", 0.05, 0.0375, "moment-only", 4.0, (0.05, 0.025)), Case("G0.2", 0.2, 0.04, "variational", 8.0, (0.1, 0.05))]
Run = collections.namedtuple("Run", "case cells box step steady")


def coarsest_cell(box):
    """Cells far away: 2.5 a, in the largest box 5 a."""
    return 5.0 if box > 40 else 2.5


def steady_runs():
    """All differences from one run, h = 10a/32 in a box of 40 a with steps of 0.1; and the boxes once more with h = 10a/64."""
    for case in CASES:
        for cells, box, step in [(32, 20, 0.1), (32, 40, 0.1), (32, 80, 0.1), (32, 40, 0.2), (32, 40, 0.05), (64, 20, 0.1), (64, 40, 0.1)]:
            yield Run(case, cells, box, step, True)


def transient_runs():
    for case in CASES:
        for step in case.steps:
            yield Run(case, 64, 40, step, False)


def reference(case):
    return read_table(REFERENCES / f"sphere_{case.name}_k{case.khat:g}_{case.form.replace('-', '_')}.csv")[0]


def folder(args, run):
    kind = "steady" if run.steady else "transient"
    return args.output / f"{kind}_{run.case.name}_h{run.cells}_box{run.box}_dt{run.step:g}"


def finished(path):
    """A log that ends with the table of times."""
    log = path / "log.txt"
    if not log.exists():
        return False
    lines = log.read_text().rstrip().splitlines()
    return bool(lines) and lines[-1].startswith("total") and not any("FAILED" in line for line in lines)


def make(args, run):
    path = folder(args, run)
    if finished(path):
        return
    settings = {
        "Accuracy/Target error": 0, "Scene/Shear number G": run.case.G, "Scene/Reduced bending modulus": run.case.khat, "Scene/Box side": run.box, "Scene/Boundary": "faces",
        "Scene/End time": 30 if run.steady else run.case.end, "Capsule/Bending form": run.case.form,
        "Shell mesh/Level": {32: 2, 64: 3, 128: 4}[run.cells], "Fluid mesh/Finest cell": 10 / run.cells,
        "Fluid mesh/Coarsest cell": coarsest_cell(run.box), "Time/Step": run.step, "Time/Steady tolerance": 1e-4 if run.steady else 0,
        "Output/Field interval": 0, "Output/Directory": path,
    }
    command = (["nice", "-n", "10"] if args.nice else []) + [str(args.program or args.build / "tanktread"), str(ROOT / "prm/sphere_shear.prm")]
    for key, value in settings.items():
        command += ["--set", f"{key}={value}"]
    path.parent.mkdir(parents=True, exist_ok=True)
    print(path.name, flush=True)
    subprocess.run(command, check=True, stdout=subprocess.DEVNULL, env={**os.environ, "OMP_NUM_THREADS": "1"})


# -------------------------------------------------------------------------------------------------------------------------- flows
SCENES = {"sphere2": "sphere, l = 2", "sphere4": "sphere, l = 4", "ellipsoid": "ellipsoid 2:1:1", "biconcave": "biconcave disk",
          "steady": "sheared sphere, G = 0.2", "periodic": "sphere across the periodic faces"}
# The exact flows are those in unbounded liquid: a large box, and a graded mesh far away. What both are worth is in grading_*.csv.
LARGE = ["--box", "80", "--coarsest", "5"]
FLOWS = {"flows": [*LARGE, "--grading", "3"],
         "finer_shell": [*LARGE, "--grading", "3", "--finer-shell", "1", "--scenes", "sphere2,sphere4", "--cells", "32,64", "--repeat", "1"],
         **{f"grading_{grading}": [*LARGE, "--grading", str(grading), "--scenes", "sphere2", "--interfaces", "enriched", "--repeat", "1"] for grading in (0, 2, 3, 4, 6)},
         "grading_40a": ["--scenes", "sphere2", "--interfaces", "enriched", "--repeat", "1"]}


def measure_flows(args):
    for name, options in FLOWS.items():
        target = args.output / f"{name}.csv"
        if target.exists():
            continue
        print(target.name, flush=True)
        args.output.mkdir(parents=True, exist_ok=True)
        command = (["nice", "-n", "10"] if args.nice else []) + [str(args.build / "interface_study"), *options]
        with open(target.with_suffix(".part"), "w") as file:
            subprocess.run(command, check=True, stdout=file, env={**os.environ, "OMP_NUM_THREADS": "1"})
        target.with_suffix(".part").rename(target)


def flows(args, name="flows"):
    """Rows of a table of interface_study, or none; of one that is being made, what is there."""
    for file in (args.output / f"{name}.csv", args.output / f"{name}.part"):
        if file.exists():
            with open(file, newline="") as stream:
                return [row for row in csv.DictReader(stream) if row["grading"] is not None]
    print(f"{name}.csv is missing", file=sys.stderr)
    return []


def select(rows, scene, interface):
    found = sorted((row for row in rows if row["scene"] == scene and row["interface"] == interface), key=lambda row: int(row["cells"]))
    return {name: np.array([float(row[name]) if row[name] else np.nan for row in found]) for name in rows[0] if name not in ("scene", "interface", "boundary")} if found else None


# ------------------------------------------------------------------------------------------------------------------------ figures
PLAIN, ENRICHED, REFERENCE = "#D55E00", "#0072B2", "#222222"


def draw_errors(args, rows, key, label, file):
    figure, axes = plt.subplots(2, 3, figsize=(9, 5.6), sharex=True, sharey=True)
    for axis, (scene, title) in zip(axes.flat, SCENES.items()):
        for interface, colour, marker in (("plain", PLAIN, "s"), ("enriched", ENRICHED, "o")):
            data = select(rows, scene, interface)
            if data is None:
                continue
            x = 10 / data["cells"] if key == "h" else data[key]
            axis.loglog(x, data["error"], color=colour, marker=marker, markersize=4, label=interface)
            if key == "h" and interface == "enriched":
                axis.loglog(x, data["error"][0] * (x / x[0]) ** 2, color="#999999", linewidth=0.9, linestyle="--", label="h²")
        axis.set_title(title, fontsize=10)
        axis.grid(True, which="major")
        axis.grid(False, which="minor")
        axis.yaxis.set_major_formatter(matplotlib.ticker.FuncFormatter(lambda value, _: f"{100 * value:g} %"))
        if key == "h":
            axis.set_xticks([10 / n for n in (32, 64, 128)], ["10a/32", "10a/64", "10a/128"])
        else:
            axis.xaxis.set_major_formatter(matplotlib.ticker.FuncFormatter(lambda value, _: f"{value:g}"))
            axis.xaxis.set_minor_formatter(matplotlib.ticker.NullFormatter())
        axis.minorticks_off()
    axes[0, 0].legend(fontsize=8)
    figure.supxlabel(label, fontsize=10)
    figure.supylabel("error of the surface velocity", fontsize=10)
    save(args, figure, file)


def draw_transients(args):
    """D, theta and the difference of D from the reference, one column a case."""
    figure, axes = plt.subplots(3, 2, figsize=(9, 7), sharex="col", height_ratios=(2, 2, 1.4))
    for column, case in enumerate(CASES):
        wanted = reference(case)
        for axis, name, label in zip(axes[:, column], ("D", "theta_over_pi"), ("D", "θ/π")):
            axis.plot(wanted["t"], wanted[name], color=REFERENCE, linewidth=4, alpha=0.3, label="reference")
            axis.set_ylabel(label)
        for step, (times, D, theta, wanted_D, _) in transients(args, case):
            style = {"color": "#009E73", "linestyle": "-"} if step.startswith("0,") else {"color": ENRICHED, "linestyle": "-" if step.startswith(f"{case.steps[1]:g}") else "--"}
            label = "extrapolated to Δt = 0" if step.startswith("0,") else f"Δt = {step.split(',')[0]}/γ̇"
            for axis, values in zip(axes[:, column], (D, theta, 100 * (D - wanted_D) / wanted["D"].max())):
                axis.plot(times, values, linewidth=1.2, label=label, **style)
        axes[2, column].axhspan(-0.5, 0.5, color="#eeeeee")
        axes[2, column].set_ylabel("ΔD / max D, %")
        axes[0, column].set_title(f"G = {case.G:g}, κ̂ = {case.khat:g}, {case.form}", fontsize=10)
        axes[0, column].legend(fontsize=8)
        axes[2, column].set_xlim(0, case.end)
        axes[2, column].set_xlabel("γ̇t")
    save(args, figure, "transients.png")


def save(args, figure, name):
    args.figures.mkdir(parents=True, exist_ok=True)
    figure.savefig(args.figures / name, dpi=90)
    plt.close(figure)
    print(args.figures / name, file=sys.stderr)


# ------------------------------------------------------------------------------------------------------------------------- tables
def percent(value):
    return "–" if not np.isfinite(value) else f"{100 * value:.3g} %" if abs(value) < 0.1 else f"{100 * value:.1f} %"


def number(value):
    return "–" if not np.isfinite(value) else f"{value:.2f}"


def padded(values):
    """With what is missing of the three meshes."""
    return np.append(values, np.full(max(0, 3 - len(values)), np.nan))


def table(head, rows):
    print("| " + " | ".join(head) + " |\n|" + "---|" * len(head))
    for row in rows:
        print("| " + " | ".join(row) + " |")
    print()


def print_flows(rows, shell_rows):
    body = []
    for scene, title in SCENES.items():
        for interface in ("plain", "enriched"):
            data = select(rows, scene, interface)
            if data is None:
                continue
            errors, cells, power = (padded(data[key]) for key in ("error", "cells", "power_error"))
            orders = np.log(errors[:-1] / errors[1:]) / np.log(cells[1:] / cells[:-1])
            total = np.log(errors[0] / errors[-1]) / np.log(cells[-1] / cells[0])
            shell = select(shell_rows, scene, interface) if shell_rows else None
            finer = [] if shell is None else [percent(value) for value in shell["error"]]
            body.append([title, interface, *map(percent, errors), *map(number, orders), number(total), *map(percent, power),
                         percent(data["reference_error"][-1]) if data["reference_error"][-1] > 0 else "exact", ", ".join(finer) or "–"])
    table(["", "interface", "10a/32", "10a/64", "10a/128", "order", "order", "overall", "power 10a/32", "10a/64", "10a/128", "finest mesh against reference",
           "control mesh finer by one level, 10a/32, 10a/64"], body)
    body = []
    for scene, title in SCENES.items():
        data = select(rows, scene, "shell")
        if data is not None:
            body.append([title, *map(percent, padded(data["error"])[:2])])
    if body:
        table(["control mesh alone", "162 points", "642 points"], body)


def print_costs(rows):
    body = []
    for scene, title in SCENES.items():
        plain, enriched = select(rows, scene, "plain"), select(rows, scene, "enriched")
        if plain is None or enriched is None:
            continue
        for i, cells in enumerate(enriched["cells"]):
            if i < len(plain["cells"]):
                body.append([title if i == 0 else "", f"10a/{cells:.0f}", f"{enriched['fluid_cells'][i]:.0f}", f"{plain['iterations'][i]:.0f}, {plain['solve_cpu'][i]:.3g}",
                             f"{enriched['iterations'][i]:.0f}, {enriched['solve_cpu'][i]:.3g}", f"{enriched['solve_cpu'][i] / plain['solve_cpu'][i]:.2f}",
                             f"{enriched['stokes_cpu'][i]:.3g}", f"{enriched['geometry_cpu'][i]:.3g}", f"{enriched['geometry_cpu'][i] / enriched['stokes_cpu'][i]:.2f}"])
    table(["", "h", "cells", "plain: iterations, s", "enriched: iterations, s", "ratio", "Stokes solve, s", "geometry, s", "geometry / Stokes solve"], body)


def print_grading(args):
    body = []
    for name in (name for name in FLOWS if name.startswith("grading")):
        rows = flows(args, name)
        data = select(rows, "sphere2", "enriched") if rows else None
        if data is not None and len(data["cells"]) > 1:
            total = np.log(data["error"][0] / data["error"][-1]) / np.log(data["cells"][-1] / data["cells"][0])
            body.append([f"{data['box'][0]:g}a", f"{data['grading'][0]:g}", *map(percent, data["error"]), f"{total:.2f}", *(f"{n:.0f}" for n in data["fluid_cells"])])
    table(["box", "Grading", "10a/32", "10a/64", "10a/128", "order overall", "cells 10a/32", "10a/64", "10a/128"], body)


def last_values(args, run):
    path = folder(args, run)
    if not finished(path):
        return None
    data = read_table(path / "history.csv")[0]
    return np.array([data["D_xz"][-1], data["theta"][-1]])


def print_steady(args):
    body = []
    for case in CASES:
        wanted = np.array([reference(case)[name][-1] for name in ("D", "theta_over_pi")])
        values = {(run.cells, run.box, run.step): last_values(args, run) for run in steady_runs() if run.case == case}
        for key, value in values.items():
            if value is not None:
                deviation = value / wanted - 1
                body.append([case.name, f"10a/{key[0]}", f"{key[1]}a", f"{key[2]:g}", f"{value[0]:.5f}", f"{100 * deviation[0]:+.3f} %", f"{value[1]:.5f}", f"{100 * deviation[1]:+.3f} %"])

        def difference(a, b, factor):
            if values.get(a) is None or values.get(b) is None:
                return None
            return factor * (values[a] - values[b]) / wanted
        # What is left of a box of 40 a if its part falls like the third power of the side; of a step of 0.1 if like the second.
        for title, part in (("box of 40a by 20a and 40a, h = 10a/32", difference((32, 40, 0.1), (32, 20, 0.1), -1 / 7)),
                            ("box of 40a by 20a and 40a, h = 10a/64", difference((64, 40, 0.1), (64, 20, 0.1), -1 / 7)),
                            ("box of 40a by 40a and 80a", difference((32, 40, 0.1), (32, 80, 0.1), 8 / 7)),
                            ("step of 0.1 by 0.1 and 0.2", difference((32, 40, 0.2), (32, 40, 0.1), 1 / 3)),
                            ("step of 0.1 by 0.05 and 0.1", difference((32, 40, 0.1), (32, 40, 0.05), 4 / 3)),
                            ("h = 10a/64 by 10a/32 and 10a/64", difference((32, 40, 0.1), (64, 40, 0.1), 1 / 3))):
            if part is not None:
                body.append([case.name, title, "", "", "", f"{100 * part[0]:+.3f} %", "", f"{100 * part[1]:+.3f} %"])
    table(["", "h, or part of the difference", "box", "γ̇Δt", "D", "difference", "θ/π", "difference"], body)


def at_common_times(run, wanted):
    """Rows of a run and of the reference at the times that both have, but zero: (times, D, theta/pi, wanted D, wanted theta/pi)."""
    ours = {round(t, 6): i for i, t in enumerate(run["time"])}
    pairs = [(ours[round(t, 6)], j) for j, t in enumerate(wanted["t"]) if t > 0 and round(t, 6) in ours]
    i, j = np.array(pairs).T
    return wanted["t"][j], run["D_xz"][i], run["theta"][i], wanted["D"][j], wanted["theta_over_pi"][j]


def transients(args, case):
    """(step, at_common_times()) of the runs there are, and of their extrapolation to steps of length zero."""
    runs = [run for run in transient_runs() if run.case == case and (folder(args, run) / "history.csv").exists()]
    results = []
    for run in runs:
        step = f"{run.step:g}" + ("" if finished(folder(args, run)) else ", not finished")
        results.append((step, at_common_times(read_table(folder(args, run) / "history.csv")[0], reference(case))))
    if len(results) == 2:
        (times, D, theta, *wanted), fine = results[0][1], results[1][1]
        keep = np.isin(np.round(fine[0], 6), np.round(times, 6))
        n = keep.sum()
        results.append(("0, extrapolated", (times[:n], (4 * fine[1][keep] - D[:n]) / 3, (4 * fine[2][keep] - theta[:n]) / 3, *(column[:n] for column in wanted))))
    return results


def print_transients(args):
    body = []
    for case in CASES:
        for step, (times, D, theta, wanted_D, wanted_theta) in transients(args, case):
            by_D, by_theta = (D - wanted_D) / reference(case)["D"].max(), theta - wanted_theta
            i, j = np.argmax(abs(by_D)), np.argmax(abs(by_theta))
            body.append([case.name, step, f"{times[-1]:g}", f"{100 * by_D[i]:+.2f} % at {times[i]:.2f}", f"{by_theta[j]:+.5f} at {times[j]:.2f}"])
    table(["", "γ̇Δt", "until γ̇t", "largest difference of D, of its maximum", "largest difference of θ/π"], body)


def arguments():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--build", type=pathlib.Path, default=ROOT / "build/release", help="folder of the programs")
    parser.add_argument("--program", type=pathlib.Path, help="tanktread, if not that of the build")
    parser.add_argument("--parts", default=",".join(PARTS))
    parser.add_argument("--output", type=pathlib.Path, default=pathlib.Path("output/interface_study"))
    parser.add_argument("--figures", type=pathlib.Path, help="folder of the figures, if not that of the output")
    parser.add_argument("--nice", action="store_true", help="with low priority")
    args = parser.parse_args()
    unknown = set(args.parts.split(",")) - set(PARTS)
    if unknown:
        parser.error(f"--parts: got {', '.join(sorted(unknown))}; allowed: {', '.join(PARTS)}")
    args.output = args.output.resolve()
    args.figures = args.figures or args.output / "figures"
    return args


def main():
    args = arguments()
    parts = args.parts.split(",")
    if "flows" in parts:
        measure_flows(args)
    for part, runs in (("steady", steady_runs()), ("transients", transient_runs())):
        if part in parts:
            for run in runs:
                make(args, run)
    rows = flows(args) if "figures" in parts or "tables" in parts else []
    if "figures" in parts:
        if rows:
            draw_errors(args, rows, "h", "size of the finest cells", "error_mesh.png")
            draw_errors(args, rows, "solve_cpu", "CPU seconds of the solve", "error_cost.png")
        draw_transients(args)
    if "tables" in parts:
        if rows:
            print_flows(rows, flows(args, "finer_shell"))
            print_costs(rows)
        print_grading(args)
        print_steady(args)
        print_transients(args)
    return 0


if __name__ == "__main__":
    sys.exit(main())
