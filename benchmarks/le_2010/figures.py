# SPDX-License-Identifier: LGPL-2.1-or-later
# Part of Tanktread: the figures of Le (2010), drawn from our runs beside the reference solutions.
"""draw(name, results, folder) makes <folder>/<name>.png from what has been computed, or leaves it out and returns False when there is nothing."""

import math
import pathlib

import matplotlib.pyplot as plt
import numpy as np

import snapshots
import values
from run_files import direction, interpolated, without_jumps

COLORS = ["#0072B2", "#D55E00", "#009E73", "#CC79A7", "#E69F00"]
LABELS = {"D_xz": r"$D_{xz}$", "theta": r"$\theta/\pi$", "delta": r"$\delta/\pi$", "area": r"area / initial area"}
GAMMA_T = r"$\dot\gamma t$"


def khat_label(result):
    return rf"$\hat\kappa$ = {result.khat:g}"


def curve(result, column):
    """Times and values between the steps, which may be long, by cubics; the section's angle with gaps where it jumps."""
    series = result.series
    times = np.linspace(0, series["time"][-1], 2001)
    if column in ("D_xz", "theta"):  # smooth together
        section = interpolated(series["time"], direction(series["D"], series["theta"]), times)
        if column == "D_xz":
            return times, np.abs(section)
        return times, without_jumps(np.where(section == 0, math.nan, np.angle(section) / (2 * math.pi)))
    found = interpolated(series["time"], series[column], times)
    return times, found / found[0] if column == "area" else found


def draw_limit(axis, result, column, color):
    """Where the run goes, with its error bar, just after its end."""
    name = {"D_xz": "D", "theta": "theta"}.get(column)
    if name and math.isfinite(result.number(f"{name}_limit")):
        limit = values.limit(result, name, name)
        axis.errorbar(result.series["time"][-1] * 1.04, limit.value, limit.bar, color=color, marker="o", markersize=3, capsize=3, linewidth=1)


def draw_curves(axes, results, columns):
    """One column of axes: curves of the runs over time, references dashed, all in the colour of their bending modulus."""
    for result, color in zip(results, COLORS):
        if not result.series:
            continue
        reference = result.reference()
        for axis, column in zip(axes, columns):
            axis.plot(*curve(result, column), color=color, linewidth=1.6, label=khat_label(result))
            draw_limit(axis, result, column, color)
            name = {"D_xz": "D"}.get(column, column)
            if reference and name in reference[0]:
                draw = without_jumps if column == "theta" else np.asarray
                shown = reference[0]["time"] <= result.series["time"][-1] * 1.02 + 1
                axis.plot(reference[0]["time"][shown], draw(reference[0][name])[shown], "--", color="#222222", linewidth=0.9, zorder=5)
    for axis, column in zip(axes, columns):
        axis.set_ylabel(LABELS[column])
    axes[-1].set_xlabel(GAMMA_T)
    axes[0].legend(fontsize=8, loc="upper left", bbox_to_anchor=(1.0, 1.0))


def time_series(groups, columns):
    """A figure with a column of panels for each (title, results)."""
    figure, axes = plt.subplots(len(columns), len(groups), figsize=(4.6 * max(1.35, len(groups)), 2.1 * len(columns) + 0.5), sharex="col", squeeze=False)
    for column, (title, results) in enumerate(groups):
        draw_curves(axes[:, column], results, columns)
        dashed = "   (dashed: boundary integral, unbounded)" if any(result.series and result.reference() for result in results) else ""
        axes[0, column].set_title(title + dashed, fontsize=8, loc="left")
    return figure


def split_by_G(results):
    """Groups that have something to draw."""
    return [(f"G = {G:g}", [result for result in results if result.G == G]) for G in sorted({result.G for result in results if result.series})]


def relaxation_style(name):
    """Label and style of a run's curve."""
    if "moment_only" in name:
        return "moment-only", {"linewidth": 1.6, "linestyle": ":"}
    if "_step" not in name:
        return "steps by local error", {"linewidth": 1.6}
    step = name.split("_step")[1]
    return f"steps of {step}, backward Euler", {"marker": "o", "markersize": 3 if step == "0.05" else 5, "linewidth": 0.6}


def draw_relaxation(results):
    """Contours of the finest runs above; semi-axes of all runs below."""
    shapes = [("ellipsoid 2:2:1", [r for r in results if "ellipsoid" in r.name]), ("biconcave disk", [r for r in results if "biconcave" in r.name])]
    figure, axes = plt.subplots(2, 2, figsize=(8.4, 7))
    for column, (title, group) in enumerate(shapes):
        for result in group[:1]:
            for (time, x, z), shade in zip(result.contours, np.linspace(0.15, 0.95, max(1, len(result.contours)))):
                axes[0, column].plot(x, z, color=plt.cm.viridis(shade), linewidth=1.4, label=f"t = {time:.3g}")
            reference = result.reference()
            if reference:
                for name in ("L", "B"):
                    axes[1, column].plot(reference[0]["time"], reference[0][name], "--", color="#222222", linewidth=0.9, zorder=5)
        axes[0, column].set(aspect="equal", xlabel="$x/a$", ylabel="$z/a$")
        axes[0, column].set_title(title, fontsize=9, loc="left")
        axes[0, column].set_ylim(-1.15, 1.45)
        if group[0].contours:
            axes[0, column].legend(fontsize=8, ncol=3, loc="upper center")
        for result, color in zip(group, COLORS):
            if not result.series:
                continue
            label, style = relaxation_style(result.name)
            for name in ("L", "B"):
                points = (result.series["time"], result.series[name]) if "_step" in result.name else curve(result, name)
                axes[1, column].plot(*points, color=color, label=label if name == "L" else None, **style)
        axes[1, column].set(xlabel=r"$t\,\kappa_B/(\mu a^3)$", ylabel="semi-axes $L/a$, $B/a$", xlim=(-0.1, 5.2))
        if any(result.series for result in group):
            axes[1, column].legend(fontsize=8)
    return figure


def draw_contours(results):
    """The last cut of each run with the shear plane."""
    groups = split_by_G(results)
    figure, axes = plt.subplots(1, len(groups), figsize=(4.2 * len(groups), 3.2), squeeze=False, sharex=True, sharey=True)
    for axis, (title, group) in zip(axes[0], groups):
        for result, color in zip(group, COLORS):
            if result.contours:
                time, x, z = result.contours[-1]
                axis.plot(x, z, color=color, linewidth=1.5, label=khat_label(result))
        axis.plot(np.cos(np.linspace(0, 2 * math.pi)), np.sin(np.linspace(0, 2 * math.pi)), ":", color="#888888", linewidth=0.9)
        axis.set(aspect="equal", xlabel="$x/a$", ylabel="$z/a$")
        axis.set_title(title + "   (dotted: at rest)", fontsize=9, loc="left")
        axis.legend(fontsize=8)
    return figure


DRAWN = {
    "fig01": draw_relaxation,
    "fig02": draw_contours,
    "fig03": lambda results: time_series(split_by_G(results), ["D_xz", "theta"]),
    "fig04": lambda results: time_series([(r"G = 0.05, $\lambda$ = 5", results)], ["D_xz", "theta"]),
    "fig05": lambda results: time_series([("G = 0.05", results)], ["D_xz", "theta", "delta"]),
    "fig06": lambda results: time_series([("G = 0.005", results)], ["D_xz", "theta", "delta"]),
    "fig07": lambda results: time_series([("G = 0.008", results)], ["D_xz", "theta", "delta"]),
    "fig08": lambda results: time_series([(r"G = 0.05, $\lambda$ = 5", results)], ["D_xz", "theta", "delta"]),
    "fig09": lambda results: time_series([(r"G = 0.5, $\lambda$ = 2", results)], ["D_xz", "theta", "delta", "area"]),
    "fig10": snapshots.draw,
    "fig11": lambda results: time_series([(r"G = 0.1, $\lambda$ = 4", results)], ["D_xz", "theta", "delta", "area"]),
    "fig12": snapshots.draw,
}


def draw(name, results, folder):
    """Whether there was anything to draw; else what is there stays."""
    file = pathlib.Path(folder) / f"{name}.png"
    wanted = results.of(name)
    if not any(result.series for result in wanted):
        if any(result.record for result in wanted):
            print(f"{name}: nothing to draw ({', '.join(sorted({result.state() for result in wanted}))})")
        return False
    figure = DRAWN[name](wanted)
    if figure is None:
        return False
    file.parent.mkdir(parents=True, exist_ok=True)
    figure.savefig(file, dpi=90)
    plt.close(figure)
    print(f"{name}: {file}")
    return True
