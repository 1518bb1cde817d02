#!/usr/bin/env python3
# SPDX-License-Identifier: LGPL-2.1-or-later
# Part of Tanktread: figures of one run, against reference solutions where there are any.
"""Draw deformation.png, contour.png, convergence.png, where capsules move trajectory.png, of several suspension.png, into a run's folder.

    plot_run.py FOLDER [--reference FILE.csv ...]

Reads history.csv, or history_1.csv, history_2.csv, ... of several capsules, contours.csv in the same way, suspension.csv and used_parameters.prm; whatever
is missing is named and left out. Without --reference the reference is looked for in benchmarks/reference: the file whose scene (flow, shape, G, khat,
membrane law, ...) is the run's. Another run's history.csv is a reference as well. Of several capsules the first is compared.
"""

import argparse
import math
import pathlib
import sys

import python_packages

python_packages.need("numpy", "matplotlib")

import plot_style  # noqa: E402, F401
import matplotlib.pyplot as plt  # noqa: E402
import matplotlib.ticker  # noqa: E402
import numpy as np  # noqa: E402

from run_files import contours_by_time, find_references, interpolated, number, tables_of_capsules  # noqa: E402
from run_files import read_parameters, read_table, standard_columns, without_jumps  # noqa: E402

RUN, SECOND, REFERENCES = "#0072B2", "#D55E00", ["#222222", "#D55E00", "#009E73", "#CC79A7"]

# ---------------------------------------------------------------------------------------------------------------------- reading
def load(folder, name, reader):
    """The file's content, or None with a line that says it is missing."""
    file = folder / name
    if not file.is_file():
        print(f"{name}: missing in {folder}")
        return None
    return reader(file)


def load_capsules(folder, stem, needed):
    """Tables of all capsules in their order; those without the columns needed are named and left out."""
    tables = tables_of_capsules(folder, stem)
    if not tables:
        print(f"{stem}.csv: missing in {folder}")
    for file, table in tables:
        if not all(name in table for name in needed):
            print(f"{file}: has no rows or no columns {', '.join(needed)}, left out")
    return [table for _, table in tables if all(name in table for name in needed)]


# ------------------------------------------------------------------------------------------------------------------- references
def chosen_references(parameters):
    if parameters is None:
        print("reference: none chosen, the scene is not known")
        return []
    found = find_references(parameters)
    if not found:
        print("reference: no file in benchmarks/reference has this scene")
    for file in found:
        if file.name.startswith("relaxation") and parameters.get("Capsule/Membrane law") != "none":
            print("reference: the shell only bends there (E h = 0); a finite reduced bending modulus keeps membrane tension")
    return found


def reference_label(file, notes):
    """Name of a curve in the legend: the method for the shipped solutions, the folder for another run's history."""
    if "flow" in notes:
        form = notes.get("bending form", "none")
        return "boundary integral, unbounded" + ("" if form == "none" else f", {form}")
    return file.resolve().parent.name if file.stem == "history" else file.stem


# -------------------------------------------------------------------------------------------------------------------- the plots
def time_label(parameters):
    quiescent = (parameters or {}).get("Scene/Flow", "shear") == "quiescent"
    return r"time  $t\,\kappa_B/(\mu a^3)$" if quiescent else r"time  $\dot\gamma t$"


def unit_of_energy(parameters):
    return r"\kappa_B" if (parameters or {}).get("Scene/Flow", "shear") == "quiescent" else r"\mu\dot\gamma a^3"


def title(parameters):
    """One line that says the scene."""
    if not parameters:
        return ""
    words = [parameters.get("Capsule/Shape", "capsule")]
    if parameters.get("Scene/Flow", "shear") not in ("shear", "quiescent"):
        words.append(parameters["Scene/Flow"])
    number_of_flow = "Ca" if parameters.get("Scene/Scale modulus") == "shear" else "$G$"
    for name, symbol in (("Scene/Shear number G", number_of_flow), ("Scene/Reduced bending modulus", r"$\hat\kappa$"), ("Scene/Viscosity ratio", r"$\lambda$")):
        if name in parameters and not (symbol == number_of_flow and parameters.get("Scene/Flow") == "quiescent"):
            words.append(f"{symbol} = {parameters[name]}")
    if number(parameters.get("Scene/Reduced bending modulus", "0")) != 0:
        words.append(parameters.get("Capsule/Bending form", ""))
    return ", ".join(word for word in words if word)


def compare(run, reference, name):
    """Prints the run's last values beside the reference, at the same time and in its steady state."""
    end = run["time"][-1]
    print(f"reference: {name}")
    for key, symbol in (("D", "D_xz"), ("theta", "theta/pi")):
        if key not in run or key not in reference:
            continue
        rows = [("last value", reference[key][-1], reference["time"][-1])]
        if end < reference["time"][-1]:
            rows.insert(0, ("at this time", interpolated(reference["time"], reference[key], end), end))
        print(f"  {symbol:8s} run {run[key][-1]:.6f} at t = {end:g}; largest difference over the run {largest_difference(run, reference, key):.1e}")
        for what, value, time in rows:
            difference = f"{100 * (run[key][-1] / value - 1):+.3f} %" if abs(value) > 1e-4 else f"{run[key][-1] - value:+.1e} (absolute)"
            print(f"           reference's {what} {value:.6f} (t = {time:g}), difference {difference}")


def largest_difference(run, reference, key):
    """Largest |run - reference| at the run's times, where both are defined."""
    difference = np.abs(run[key] - interpolated(reference["time"], reference[key], run["time"]))
    return np.nanmax(difference) if np.isfinite(difference).any() else math.nan


def capsule_styles(n):
    """(colour, label) of each capsule's curve; of many only the first and the last have a label."""
    if n == 1:
        return [(RUN, "this run")]
    return [(plt.cm.viridis(0.9 * i / (n - 1)), f"capsule {i + 1}" if n <= 6 or i in (0, n - 1) else None) for i in range(n)]


def plot_deformation(runs, references, parameters, file):
    """D and theta of all capsules (standard columns) beside the references."""
    keys = [key for key in ("D", "theta") if all(key in run for run in runs)]
    if not keys:
        print("deformation.png: not drawn, no columns D_xz or theta")
        return
    figure, axes = plt.subplots(len(keys), 1, figsize=(7, 3.2 * len(keys)), sharex=True, squeeze=False)
    labels = {"D": r"Taylor parameter  $D_{xz}$", "theta": r"inclination  $\theta/\pi$"}
    for axis, key in zip(axes[:, 0], keys):
        draw = without_jumps if key == "theta" else np.asarray
        for run, (color, label) in zip(runs, capsule_styles(len(runs))):
            axis.plot(run["time"], draw(run[key]), color=color, label=label, marker="o" if len(run["time"]) < 60 else "", markersize=3.5)
        for color, (name, reference) in zip(REFERENCES, references):
            if key in reference:
                axis.plot(reference["time"], draw(reference[key]), "--", color=color, linewidth=1.4, label=name)
        axis.set_ylabel(labels[key])
        low, high = axis.get_ylim()
        if high - low < 0.02:  # do not blow rounding up to the height of the figure
            axis.set_ylim((low + high) / 2 - 0.01, (low + high) / 2 + 0.01)
    end = runs[0]["time"][-1]
    axes[-1, 0].set_xlim(-0.02 * end, 1.02 * end)
    axes[-1, 0].set_xlabel(time_label(parameters))
    axes[0, 0].set_title(title(parameters), fontsize=11, loc="left")
    axes[0, 0].legend(loc="best")
    save(figure, file, f"{len(runs)} capsule(s), {len(runs[0]['time'])} rows to t = {end:g}, {len(references)} reference curve(s)")


def plot_trajectory(runs, parameters, file):
    """Where the centroids go: z over time and the paths in the plane of the flow. Not drawn when nothing moves."""
    runs = [run for run in runs if all(key in run for key in ("x", "y", "z"))]
    moved = max((np.ptp(run[key]) for run in runs for key in ("x", "y", "z")), default=0)
    if moved < 0.05:
        return
    figure, axes = plt.subplots(1, 2, figsize=(10, 3.6))
    for run, (color, label) in zip(runs, capsule_styles(len(runs))):
        axes[0].plot(run["time"], run["z"], color=color, label=label)
        axes[1].plot(run["x"], run["z"], color=color)
        axes[1].plot(run["x"][0], run["z"][0], "o", color=color, markersize=4)
    axes[0].set(xlabel=time_label(parameters), ylabel="$z/a$ of the centroid")
    axes[1].set(xlabel="$x/a$ of the centroid (dot: at the start)", ylabel="$z/a$")
    axes[0].set_title(title(parameters), fontsize=11, loc="left")
    axes[0].legend(loc="best")
    save(figure, file, f"{len(runs)} capsule(s), moved by up to {moved:.3g} a")


def plot_suspension(table, parameters, file):
    """What suspension.csv says of all capsules together, without what it does not have."""
    groups = [("relative viscosity", {"": "relative_viscosity"}), ("normal stress differences", {"$N_1$": "N1", "$N_2$": "N2"}),
              ("smallest gap $/a$", {"between capsules": "smallest_gap", "to a wall": "wall_gap"})]
    shown = [(label, {name: table[column] for name, column in curves.items() if np.isfinite(table.get(column, math.nan)).any()}) for label, curves in groups]
    shown = [(label, curves) for label, curves in shown if curves]
    if "time" not in table or not shown:
        print("suspension.png: not drawn, suspension.csv has none of its columns")
        return
    figure, axes = plt.subplots(1, len(shown), figsize=(4.2 * len(shown), 3.2), squeeze=False)
    for axis, (label, curves) in zip(axes[0], shown):
        for color, (name, values) in zip((RUN, SECOND), curves.items()):
            axis.plot(table["time"], values, color=color, label=name or None)
        axis.set(xlabel=time_label(parameters), ylabel=label)
        if any(curves):
            axis.legend(loc="best")
    save(figure, file, ", ".join(label for label, _ in shown))


def save(figure, file, contents):
    figure.savefig(file)
    plt.close(figure)
    print(f"{file.name}: {contents}")


def highlighted(contours, wanted=6):
    """Indices of the first, the last and some contours between, at equal parts of the way the second moments of the shape go."""
    moments = np.array([[np.mean(x[1:] * x[1:]), np.mean(x[1:] * z[1:]), np.mean(z[1:] * z[1:])] for _, x, z in contours])
    way = np.concatenate([[0], np.cumsum(np.linalg.norm(np.diff(moments, axis=0), axis=1))])
    return sorted({int(np.argmin(np.abs(way - part))) for part in np.linspace(0, way[-1], wanted)[:-1]} | {len(contours) - 1})


def draw_flow(axis, reach):
    """Arrows of the undisturbed flow above and below the capsule."""
    for sign in (1, -1):
        for height, length in ((0.86, 0.62), (0.98, 0.72)):
            axis.annotate("", xy=(sign * reach * length / 2, sign * reach * height), xytext=(-sign * reach * length / 2, sign * reach * height),
                          arrowprops={"arrowstyle": "-|>", "color": "#999999", "linewidth": 1.2})


def moved_back(capsules):
    """The contours of all capsules, at each time less the x of their common middle where that travels far: and whether it does."""
    middles = [np.mean([x[1:].mean() for _, x, _ in at_a_time]) for at_a_time in zip(*capsules)]
    if np.ptp(middles) < 2:
        return capsules, False
    return [[(time, x - middle, z) for (time, x, z), middle in zip(contours, middles)] for contours in capsules], True


def plot_contours(tables, parameters, file):
    """Cuts of all capsules with the plane y = 0, some of them highlighted: those chosen for the first."""
    capsules, travels = moved_back([contours_by_time(table) for table in tables])
    shown = [index for index in highlighted(capsules[0]) if all(index < len(contours) for contours in capsules)]
    figure, axis = plt.subplots(figsize=(7.4, 5.6))
    symbol = time_label(parameters).split("  ")[1]
    for number_of_capsule, contours in enumerate(capsules):
        for index, (_, x, z) in enumerate(contours):
            if index not in shown:
                axis.plot(x, z, color="#dddddd", linewidth=0.6, zorder=1)
        for rank, index in enumerate(shown):
            time, x, z = contours[index]
            at_start, at_end = rank == 0, rank == len(shown) - 1
            style = {"color": "#222222", "linestyle": "--"} if at_start and not at_end else {"color": plt.cm.YlGnBu(0.35 + 0.6 * rank / max(1, len(shown) - 1))}
            label = f"{symbol} = {time:.4g}" if number_of_capsule == 0 else None
            axis.plot(x, z, linewidth=2.6 if at_end else 1.4, label=label, zorder=4 if at_end else 3, **style)
    if len(capsules) == 1 and not travels and abs(np.mean(tables[0]["z"])) < 0.5:
        reach = 1.3 * max(np.abs(tables[0]["x"]).max(), np.abs(tables[0]["z"]).max())
        if (parameters or {}).get("Scene/Flow", "shear") == "shear":
            draw_flow(axis, reach)
        axis.set(xlim=(-reach * 1.04, reach * 1.04), ylim=(-reach * 1.04, reach * 1.04))
    axis.set(aspect="equal", xlabel="$x/a$" + (" from the middle" if travels else ""), ylabel="$z/a$")
    axis.set_title(title(parameters), fontsize=11, loc="left")
    axis.legend(loc="center left", bbox_to_anchor=(1.0, 0.5))
    save(figure, file, f"{len(tables)} capsule(s), {len(capsules[0])} contours, {len(shown)} highlighted")


def of_all(histories):
    """One table of all capsules: energies added, the largest volume error; steps and iterations are those of the run."""
    rows = min(len(history["time"]) for history in histories)
    common = {name: column[:rows] for name, column in histories[0].items()}
    for name, together in (("membrane_energy", np.sum), ("bending_energy", np.sum), ("volume_error", lambda columns, axis: np.max(np.abs(columns), axis=axis))):
        if all(name in history for history in histories):
            common[name] = together([history[name][:rows] for history in histories], axis=0)
    return common


def panels(history, parameters):
    """What convergence.png shows: (title, label, logarithmic, [(name, values)]), without what history.csv does not have."""
    energy = {name: history[column] for name, column in (("membrane", "membrane_energy"), ("bending", "bending_energy")) if column in history}
    if len(energy) == 2:
        energy["sum"] = energy["membrane"] + energy["bending"]
    iterations = {name: history[column] for name, column in (("Newton", "newton_iterations"), ("linear", "linear_iterations")) if column in history}
    volume = {"": np.abs(history["volume_error"])} if "volume_error" in history else {}
    step = {"": np.append(math.nan, np.diff(history["time"]))} if len(history["time"]) > 1 else {}
    unit = r"$t\,\kappa_B/(\mu a^3)$" if "kappa" in unit_of_energy(parameters) else r"$\dot\gamma t$"
    candidates = [("step size", f"step  ({unit})", True, step), ("iterations per step", "iterations", True, iterations),
                  ("volume error", r"$|V - V_0|/V_0$", True, volume), ("elastic energy", f"energy / ${unit_of_energy(parameters)}$", False, energy)]
    for name, _, _, curves in candidates:
        if not curves:
            print(f"convergence.png: no data for {name}")
    return [candidate for candidate in candidates if candidate[3]]


def logarithmic_axis(axis, plain):
    """Logarithmic ordinate of at least a factor 4; with plain numbers where they are no powers of ten."""
    values = np.concatenate([line.get_ydata() for line in axis.lines])
    if not np.isfinite(values).any():
        return
    axis.set_yscale("log")
    low, high = np.nanmin(values) / 1.3, np.nanmax(values) * 1.3
    widen = max(1, math.sqrt(4 * low / high))
    axis.set_ylim(low / widen, high * widen)
    if plain:
        axis.yaxis.set_major_locator(matplotlib.ticker.LogLocator(subs=(1, 2, 5) if high < 100 * low else (1,)))
        axis.yaxis.set_major_formatter(matplotlib.ticker.FuncFormatter(lambda value, _: f"{value:g}"))
        axis.yaxis.set_minor_formatter(matplotlib.ticker.NullFormatter())


def plot_convergence(history, parameters, file):
    shown = panels(history, parameters)
    if not shown:
        print("convergence.png: not drawn, history.csv has none of its columns")
        return
    rows = (len(shown) + 1) // 2
    figure, axes = plt.subplots(rows, 2, figsize=(10, 3.1 * rows), squeeze=False)
    for axis in axes.flat[len(shown):]:
        axis.axis("off")
    for axis, (name, label, logarithmic, curves) in zip(axes.flat, shown):
        for color, (curve, values) in zip((RUN, SECOND, "#222222"), curves.items()):
            drawn = np.where(values > 0, values, math.nan) if logarithmic else values
            markers = "o" if np.isfinite(drawn).sum() < 60 else ""
            axis.plot(history["time"], drawn, color=color, label=curve or None, linewidth=1.4, marker=markers, markersize=3)
        if logarithmic:
            logarithmic_axis(axis, plain=name != "volume error")
        axis.set_title(name, fontsize=11, loc="left")
        axis.set_ylabel(label)
        axis.set_xlabel(time_label(parameters))
        if any(curves):
            axis.legend(loc="best")
    save(figure, file, ", ".join(name for name, *_ in shown))


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", type=pathlib.Path, help="a run's output folder")
    parser.add_argument("--reference", type=pathlib.Path, nargs="+", metavar="FILE.csv", help="curves to compare with, instead of the automatic choice")
    arguments = parser.parse_args()
    folder = arguments.folder
    missing = [str(file) for file in [folder, *(arguments.reference or [])] if not file.exists()]
    if missing:
        sys.exit(f"plot_run.py: not found: {', '.join(missing)}")

    parameters = load(folder, "used_parameters.prm", read_parameters)
    histories = load_capsules(folder, "history", ["time"])
    contours = load_capsules(folder, "contours", ["time", "x", "z"])
    if histories:
        runs = [standard_columns(history) for history in histories]
        tables = [(file, *read_table(file)) for file in arguments.reference or chosen_references(parameters)]
        references = [(reference_label(file, notes), standard_columns(table)) for file, table, notes in tables]
        usable = [(name, columns) for name, columns in references if "time" in columns]
        for name in sorted({name for name, _ in references} - {name for name, _ in usable}):
            print(f"reference: {name} has no column t or time, left out")
        for name, columns in usable:
            compare(runs[0], columns, name)
        plot_deformation(runs, usable, parameters, folder / "deformation.png")
        plot_trajectory(runs, parameters, folder / "trajectory.png")
        plot_convergence(of_all(histories), parameters, folder / "convergence.png")
    if contours:
        plot_contours(contours, parameters, folder / "contour.png")
    if (folder / "suspension.csv").is_file():
        plot_suspension(read_table(folder / "suspension.csv")[0], parameters, folder / "suspension.png")


if __name__ == "__main__":
    main()
