# SPDX-License-Identifier: LGPL-2.1-or-later
# Part of Tanktread: the chart of error against CPU seconds.
"""A panel a scene for the largest error of D over all times, one more for the error at the end of each steady scene."""

import math

import plot_style  # noqa: F401
from matplotlib import pyplot
from matplotlib.lines import Line2D
from matplotlib.ticker import FuncFormatter, LogLocator, NullFormatter

import norms
import sweeps

# CPU seconds, error of D: octree front tracking (explicit, lambda = 1, no bending) of another code on the same kind of machine, for gamma t = 1 of a sphere; the last as its middle, 1-5 %.
PEER = [("a/4, loosened tolerances", 26, 0.12), ("a/16, its default", 5000, 0.025)]
PEER_UNKNOWN = [("a/8, its default tolerances", 835)]  # no error known
COLOURS = ["#1f5a91", "#d1762a", "#4d9351", "#a34a58", "#7d6bb0", "#8a8a8a", "#b8a13c", "#2a9d9d", "#c2559d", "#6b4423", "#000000", "#5b8def", "#9acd32", "#e0567a", "#777700", "#004d40"]
MARKERS = "osD^v<>pPX*hd8H"


def styles(rows):
    """{cause: (colour, marker)}, the same in all panels."""
    causes = list(dict.fromkeys(row["cause"] for row in rows))
    return {cause: (COLOURS[i % len(COLOURS)], MARKERS[i % len(MARKERS)]) for i, cause in enumerate(causes)}


def series_of(rows, cause, column):
    """Rows of a sweep that have this error, from coarse to fine."""
    return [row for row in rows if row["cause"] == cause and row["outcome"] == "done" and 0 < row[column] < math.inf]


def dependable(notes, rows, scene, column):
    """[(CPU seconds, error, run)] of each run of a scene once, the error guarded against cancellation."""
    rows = [row for row in rows if row["scene"] == scene.name]
    sequences, base = {}, sweeps.name(sweeps.base(scene, notes.get("mode") == "full"))
    for cause in {row["cause"]: None for row in rows}:
        sequences[cause] = [(row["run"], row[column]) for row in series_of(rows, cause, column)]
    at_base = [point for sequence in sequences.values() for point in sequence if point[0] == base][:1]
    guard = norms.guarded([sequence + (at_base if cause in sweeps.BELOW_BASE else []) for cause, sequence in sequences.items()])
    seconds = {row["run"]: row["cpu_seconds"] for row in rows}
    return [(seconds[run], error, run) for run, error in guard.items()]


def panel(axes, notes, rows, scene, column, style):
    rows = [row for row in rows if row["scene"] == scene.name]
    for cause, (colour, marker) in style.items():
        series = series_of(rows, cause, column)
        axes.plot([row["cpu_seconds"] for row in series], [row[column] for row in series], color=colour, marker=marker, markersize=4.5, linewidth=2.2 if cause == "joint" else 0.9, alpha=0.9)
    all_points = dependable(notes, rows, scene, column)
    front = norms.pareto([point[0] for point in all_points], [point[1] for point in all_points])
    axes.plot([all_points[i][0] for i in front], [all_points[i][1] for i in front], color="#bbbbbb", linewidth=7, alpha=0.45, zorder=0, solid_capstyle="round")
    axes.set_xscale("log")
    axes.set_yscale("log")
    if scene.name == "sphere" and column == "error_D":
        add_peer(axes)
    doubt, low = float(notes.get(f"doubt of {scene.name} D", "nan")), axes.get_ylim()[0]
    if doubt > low:
        axes.axhspan(low / 100, doubt, color="#f3e3d3", zorder=-1)
        axes.set_ylim(bottom=low)
    axes.set_xlabel("CPU seconds")
    axes.yaxis.set_major_formatter(FuncFormatter(lambda value, _: f"{100 * value:g} %"))
    axes.xaxis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))
    for axis in (axes.xaxis, axes.yaxis):
        low, high = axis.get_view_interval()
        axis.set_major_locator(LogLocator(subs=(1, 2, 5) if high < 200 * low else (1,)))
        axis.set_minor_formatter(NullFormatter())


def add_peer(axes):
    axes.plot([cost for _, cost, _ in PEER], [error for _, _, error in PEER], color="#444444", marker="x", markersize=7, linestyle="none")
    axes.vlines(PEER[-1][1], 0.01, 0.05, color="#444444", linewidth=1)
    for name, cost in PEER_UNKNOWN:
        axes.axvline(cost, color="#888888", linewidth=0.8, linestyle=":")
        axes.annotate(name, (cost, axes.get_ylim()[1]), fontsize=7, rotation=90, va="top", ha="right", color="#666666")
    for name, cost, error in PEER:
        axes.annotate(name, (cost, error), fontsize=7, xytext=(-4, 5), textcoords="offset points", color="#444444", ha="right" if cost > 1000 else "left")


def draw(notes, rows, file):
    scenes = [scene for scene in sweeps.SCENES if any(row["scene"] == scene.name for row in rows)]
    panels = [(scene, "error_D", f"{scene.title}: D at all times") for scene in scenes] + [(scene, "end_error_D", f"{scene.title}: D at the end") for scene in scenes if scene.steady]
    lines = math.ceil(len(panels) / 2)
    figure = pyplot.figure(figsize=(11, 4.1 * lines + 1.2))
    grid, style = figure.add_gridspec(lines + 1, 2, height_ratios=[4.1] * lines + [1.2]), styles(rows)
    for i, (scene, column, title) in enumerate(panels):
        axis = figure.add_subplot(grid[i // 2, i % 2])
        panel(axis, notes, rows, scene, column, style)
        axis.set_title(title, fontsize=10)
    figure.supylabel("error of D, relative (at all times: to the largest D)", fontsize=10)
    handles = [Line2D([], [], color=colour, marker=marker, markersize=5, linewidth=2.2 if cause == "joint" else 0.9, label=cause) for cause, (colour, marker) in style.items()]
    handles += [Line2D([], [], color="#bbbbbb", linewidth=7, alpha=0.45, label="Pareto front"), Line2D([], [], color="#444444", marker="x", linestyle="none", label="front tracking on an octree, γ̇t = 1")]
    below = figure.add_subplot(grid[lines, :])
    below.set_axis_off()
    below.legend(handles=handles, loc="center", ncols=5, fontsize=8.5)
    figure.savefig(file, dpi=110)
    pyplot.close(figure)
