#!/usr/bin/env python3
# SPDX-License-Identifier: LGPL-2.1-or-later
# Part of Tanktread: figures of one run, against reference solutions where there are any.
"""Draw a run's folder: deformation.png, contour.png and convergence.png, written into the folder.

    plot_run.py FOLDER [--reference FILE.csv ...]

Reads history.csv, contours.csv and used_parameters.prm; whatever is missing is named and left out. Without --reference the reference is looked
for in benchmarks/reference: the file whose scene (flow, shape, G, khat, membrane law, bending form, reference curvature, viscosity ratio) is the
run's. Another run's history.csv is a reference as well.
"""

import argparse
import csv
import math
import pathlib
import re
import sys

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import matplotlib.ticker
import numpy as np

REFERENCE_FOLDER = pathlib.Path(__file__).resolve().parent / "reference"
RUN, SECOND, REFERENCES = "#0072B2", "#D55E00", ["#222222", "#D55E00", "#009E73", "#CC79A7"]

plt.rcParams.update({
    "font.size": 11, "axes.grid": True, "grid.color": "#e4e4e4", "grid.linewidth": 0.8, "axes.axisbelow": True,
    "axes.spines.top": False, "axes.spines.right": False, "axes.edgecolor": "#666666", "legend.frameon": False,
    "legend.fontsize": 10, "lines.linewidth": 1.8, "figure.constrained_layout.use": True, "savefig.dpi": 150,
})


# ---------------------------------------------------------------------------------------------------------------------- reading
def read_table(file):
    """Columns of a csv file with one header line as {name: array}, and its `# key: value` lines as {key: value}."""
    notes, lines = {}, []
    for line in file.read_text().splitlines():
        if line.startswith("#"):
            key, colon, value = line[1:].partition(":")
            if colon:
                notes[key.strip()] = value.strip()
        elif line.strip():
            lines.append(line)
    rows = list(csv.reader(lines, skipinitialspace=True))
    if not rows:
        return {}, notes
    names = [name.strip() for name in rows[0]]
    body = [row for row in rows[1:] if len(row) == len(names)]  # the last line of a killed run may be cut off
    columns = {name: np.array([number(row[i]) for row in body]) for i, name in enumerate(names)}
    return (columns if body else {}), notes


def number(text):
    try:
        return float(text)
    except ValueError:
        return math.nan


def read_parameters(file):
    """A deal.II parameter file as {"Section/Parameter": value}."""
    parameters, path = {}, []
    for line in file.read_text().splitlines():
        line = line.split("#")[0].strip()
        if line.startswith("subsection "):
            path.append(line[len("subsection "):].strip())
        elif line == "end" and path:
            path.pop()
        elif line.startswith("set ") and "=" in line:
            name, value = line[len("set "):].split("=", 1)
            parameters["/".join(path + [name.strip()])] = value.strip()
    return parameters


def load(folder, name, reader):
    """The file's content, or None with a line that says it is missing."""
    file = folder / name
    if not file.is_file():
        print(f"{name}: missing in {folder}")
        return None
    return reader(file)


# ------------------------------------------------------------------------------------------------------------------- references
SCENE = {  # key in a reference file: (parameter of a run, its value where the run's file does not say)
    "flow": ("Scene/Flow", "shear"),
    "G": ("Scene/Shear number G", "0.05"),
    "khat": ("Scene/Reduced bending modulus", "0"),
    "viscosity ratio": ("Scene/Viscosity ratio", "1"),
    "shape": ("Capsule/Shape", "sphere"),
    "axes": ("Capsule/Axes", "2, 2, 1"),
    "aspect ratio": ("Capsule/Aspect ratio", "0.6"),
    "inclination": ("Capsule/Inclination", "0"),
    "membrane law": ("Capsule/Membrane law", "neo-Hookean"),
    "bending form": ("Capsule/Bending form", "variational"),
    "reference curvature": ("Capsule/Reference curvature", "flat"),
}


def agree(wanted, found):
    """Whether two parameter texts mean the same: word by word, numbers to 1e-4, lists of axes up to a factor."""
    if found is None:
        return False
    a, b = ([number(word) for word in re.split(r"[\s,:]+", text.strip())] for text in (wanted, found))
    if any(map(math.isnan, a + b)):
        return wanted.lower() == found.lower()
    if len(a) > 1:
        a, b = ([value / max(values) for value in values] for values in (a, b))
    return len(a) == len(b) and np.allclose(a, b, rtol=1e-4, atol=1e-12)


def matches(notes, parameters):
    """Whether a reference file's notes describe the run's scene."""
    if "flow" not in notes:
        return False
    khat = number(notes.get("khat", "nan"))
    for key, (parameter, default) in SCENE.items():
        if key not in notes or notes[key] == "none":
            continue
        if key in ("bending form", "reference curvature") and khat == 0:
            continue
        if key == "khat" and math.isnan(khat):  # relaxation: any modulus, the caller says what that means
            continue
        if not agree(notes[key], parameters.get(parameter, default)):
            return False
    return True


def find_references(parameters):
    if parameters is None:
        print("reference: none chosen, the scene is not known")
        return []
    found = [file for file in sorted(REFERENCE_FOLDER.glob("*.csv")) if matches(read_table(file)[1], parameters)]
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


def standard_columns(table):
    """The columns of a history or reference file under one set of names."""
    aliases = {"time": ("time", "t"), "D": ("D_xz", "D"), "theta": ("theta", "theta_over_pi")}
    return {name: table[word] for name, words in aliases.items() for word in words if word in table}


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
    for name, symbol in (("Scene/Shear number G", "$G$"), ("Scene/Reduced bending modulus", r"$\hat\kappa$"), ("Scene/Viscosity ratio", r"$\lambda$")):
        if name in parameters and not (symbol == "$G$" and parameters.get("Scene/Flow") == "quiescent"):
            words.append(f"{symbol} = {parameters[name]}")
    if number(parameters.get("Scene/Reduced bending modulus", "0")) != 0:
        words.append(parameters.get("Capsule/Bending form", ""))
    return ", ".join(word for word in words if word)


def without_jumps(theta):
    """Angle/pi with a gap wherever it wraps from 1/2 to -1/2, so that no line is drawn across."""
    theta = np.array(theta)
    theta[1:][np.abs(np.diff(theta)) > 0.5] = math.nan
    return theta


def compare(run, reference, name):
    """Prints the run's last values beside the reference, at the same time and in its steady state."""
    end = run["time"][-1]
    print(f"reference: {name}")
    for key, symbol in (("D", "D_xz"), ("theta", "theta/pi")):
        if key not in run or key not in reference:
            continue
        rows = [("last value", reference[key][-1], reference["time"][-1])]
        if end < reference["time"][-1]:
            defined = ~np.isnan(reference[key])
            rows.insert(0, ("at this time", np.interp(end, reference["time"][defined], reference[key][defined]), end))
        print(f"  {symbol:8s} run {run[key][-1]:.6f} at t = {end:g}; largest difference over the run {largest_difference(run, reference, key):.1e}")
        for what, value, time in rows:
            difference = f"{100 * (run[key][-1] / value - 1):+.3f} %" if abs(value) > 1e-4 else f"{run[key][-1] - value:+.1e} (absolute)"
            print(f"           reference's {what} {value:.6f} (t = {time:g}), difference {difference}")


def largest_difference(run, reference, key):
    """Largest |run - reference| at the run's times, where both are defined."""
    defined = ~np.isnan(reference[key])
    expected = np.interp(run["time"], reference["time"][defined], reference[key][defined], left=math.nan, right=math.nan)
    difference = np.abs(run[key] - expected)
    return np.nanmax(difference) if np.isfinite(difference).any() else math.nan


def plot_deformation(history, references, parameters, file):
    run = standard_columns(history)
    if "time" not in run or not ("D" in run or "theta" in run):
        print("deformation.png: not drawn, history.csv has no columns time with D_xz or theta")
        return
    keys = [key for key in ("D", "theta") if key in run]
    figure, axes = plt.subplots(len(keys), 1, figsize=(7, 3.2 * len(keys)), sharex=True, squeeze=False)
    labels = {"D": r"Taylor parameter  $D_{xz}$", "theta": r"inclination  $\theta/\pi$"}
    for axis, key in zip(axes[:, 0], keys):
        draw = without_jumps if key == "theta" else np.asarray
        axis.plot(run["time"], draw(run[key]), color=RUN, label="this run", marker="o" if len(run["time"]) < 60 else "", markersize=3.5)
        for color, (name, reference) in zip(REFERENCES, references):
            if key in reference:
                axis.plot(reference["time"], draw(reference[key]), "--", color=color, linewidth=1.4, label=name)
        axis.set_ylabel(labels[key])
        low, high = axis.get_ylim()
        if high - low < 0.02:  # do not blow rounding up to the height of the figure
            axis.set_ylim((low + high) / 2 - 0.01, (low + high) / 2 + 0.01)
    end = run["time"][-1]
    axes[-1, 0].set_xlim(-0.02 * end, 1.02 * end)
    axes[-1, 0].set_xlabel(time_label(parameters))
    axes[0, 0].set_title(title(parameters), fontsize=11, loc="left")
    axes[0, 0].legend(loc="best")
    figure.savefig(file)
    plt.close(figure)
    print(f"deformation.png: {len(run['time'])} rows to t = {end:g}, {len(references)} reference curve(s)")


def contours_by_time(table):
    """[(time, x, z)] of consecutive rows with one time, each polyline closed."""
    starts = np.flatnonzero(np.diff(table["time"], prepend=math.nan) != 0)
    parts = zip(np.split(table["time"], starts[1:]), np.split(table["x"], starts[1:]), np.split(table["z"], starts[1:]))
    return [(time[0], np.append(x, x[0]), np.append(z, z[0])) for time, x, z in parts]


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


def plot_contours(table, parameters, file):
    if not all(name in table for name in ("time", "x", "z")):
        print("contour.png: not drawn, contours.csv has no rows or no columns time, x, z")
        return
    contours = contours_by_time(table)
    shown = highlighted(contours)
    figure, axis = plt.subplots(figsize=(7.4, 5.6))
    for index, (_, x, z) in enumerate(contours):
        if index not in shown:
            axis.plot(x, z, color="#dddddd", linewidth=0.6, zorder=1)
    symbol = time_label(parameters).split("  ")[1]
    for rank, index in enumerate(shown):
        time, x, z = contours[index]
        first, last = rank == 0, rank == len(shown) - 1
        style = {"color": "#222222", "linestyle": "--"} if first and not last else {"color": plt.cm.YlGnBu(0.35 + 0.6 * rank / max(1, len(shown) - 1))}
        axis.plot(x, z, linewidth=2.6 if last else 1.4, label=f"{symbol} = {time:.4g}", zorder=4 if last else 3, **style)
    extent = max(np.abs(table["x"]).max(), np.abs(table["z"]).max())
    reach = 1.3 * extent
    if (parameters or {}).get("Scene/Flow", "shear") != "quiescent":
        draw_flow(axis, reach)
    axis.set(aspect="equal", xlim=(-reach * 1.04, reach * 1.04), ylim=(-reach * 1.04, reach * 1.04), xlabel="$x/a$", ylabel="$z/a$")
    axis.set_title(title(parameters), fontsize=11, loc="left")
    axis.legend(loc="center left", bbox_to_anchor=(1.0, 0.5))
    figure.savefig(file)
    plt.close(figure)
    print(f"contour.png: {len(contours)} contours, {len(shown)} highlighted")


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
    shown = panels(history, parameters) if "time" in history else []
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
    figure.savefig(file)
    plt.close(figure)
    print(f"convergence.png: {', '.join(name for name, *_ in shown)}")


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
    history = load(folder, "history.csv", read_table)
    contours = load(folder, "contours.csv", read_table)
    if history:
        files = arguments.reference or find_references(parameters)
        tables = [(file, *read_table(file)) for file in files]
        references = [(reference_label(file, notes), standard_columns(table)) for file, table, notes in tables]
        usable = [(name, columns) for name, columns in references if "time" in columns]
        for name in sorted({name for name, _ in references} - {name for name, _ in usable}):
            print(f"reference: {name} has no column t or time, left out")
        run = standard_columns(history[0])
        for name, columns in usable if "time" in run else []:
            compare(run, columns, name)
        plot_deformation(history[0], usable, parameters, folder / "deformation.png")
        plot_convergence(history[0], parameters, folder / "convergence.png")
    if contours:
        plot_contours(contours[0], parameters, folder / "contour.png")


if __name__ == "__main__":
    main()
