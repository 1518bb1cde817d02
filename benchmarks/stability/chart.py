# SPDX-License-Identifier: LGPL-2.1-or-later
# Part of Tanktread: the chart of outcomes.
"""A panel a map: a field a run, its colour the outcome, its text the difference of D from the run it is compared with, or where it ended."""

import math

import plot_style  # noqa: F401
from matplotlib import pyplot
from matplotlib.patches import Patch

import maps

COLOURS = {"holds": "#8fc08f", "halves": "#c9dc87", "warned": "#f3d27a", "ends": "#e9a15f", "limit": "#b9a7d6", "refused": "#c4c4c4", "wrong": "#d9534f", "nan": "#a01f5e", "hang": "#53308c", "crash": "#111111"}
LETTERS = {"ends": "ends", "limit": "limit", "refused": "refused", "nan": "nan", "hang": "hang", "crash": "crash"}
MEANINGS = {"holds": "done", "halves": "done, steps halved", "warned": "done, warned of", "ends": "ends with a sentence", "limit": "limit of CPU time", "refused": "refused",
            "wrong": "wrong without a warning", "nan": "nan", "hang": "hang", "crash": "crash"}
ROW, HEAD, WIDTH, N_COLUMNS = 0.2, 1.05, 4.4, 3  # inches: of a row, of title and labels of a panel, of a panel


def percent(value):
    return "" if math.isnan(value) else f"{100 * value:.2g} %" if value >= 5e-5 else "0"


def text_of(row):
    if row["outcome"] in LETTERS:
        return LETTERS[row["outcome"]] + (f" t = {row['time']:.2g}" if row["outcome"] in ("ends", "limit") and row["time"] > 0 else "")
    halved = f"½·{row['halved']:.0f} " if row["halved"] > 0 else ""
    return halved + ("! " if row["warnings"] else "") + percent(row["error_D"])


def arrange(heights, n_columns):
    """Panels to columns in their order: [(column, distance of its top from the top)] and the height of the tallest."""
    tops, places = [0.0] * n_columns, []
    for height in heights:
        column = tops.index(min(tops))
        places.append((column, tops[column]))
        tops[column] += height
    return places, max(tops)


def panel(axes, map_, rows):
    of = {(row["row"], row["column"]): row for row in rows}
    columns = [column for column in map_.columns if any((row.label, column.label) in of for row in map_.rows)]
    for i, line in enumerate(map_.rows):
        for j, column in enumerate(columns):
            row = of.get((line.label, column.label))
            if row:
                axes.add_patch(pyplot.Rectangle((j, i), 1, 1, facecolor=COLOURS[row["outcome"]], edgecolor="white", linewidth=1))
                axes.text(j + 0.5, i + 0.5, text_of(row), ha="center", va="center", fontsize=6, color="white" if row["outcome"] in ("wrong", "nan", "hang", "crash") else "#222222")
    axes.set(xlim=(0, len(columns)), ylim=(len(map_.rows), 0))
    axes.set_xticks([j + 0.5 for j in range(len(columns))], [column.label.replace(", ", "\n") for column in columns], fontsize=7 if len(columns[0].label) < 10 else 6)
    axes.set_yticks([i + 0.5 for i in range(len(map_.rows))], [row.label for row in map_.rows], fontsize=7)
    axes.set_xlabel(map_.across, fontsize=7.5, labelpad=1)
    axes.set_title(f"{map_.title} ({map_.down})", fontsize=8.5, pad=3)
    axes.tick_params(length=0, pad=2)
    axes.grid(False)
    axes.spines[:].set_visible(False)


def draw(_, rows, file):
    shown = [map_ for map_ in maps.MAPS if any(row["map"] == map_.name for row in rows)]
    heights = [HEAD + ROW * len(map_.rows) for map_ in shown]
    places, tallest = arrange(heights, N_COLUMNS)
    total, width, legend = tallest + 0.8, WIDTH * N_COLUMNS, 0.55
    figure = pyplot.figure(figsize=(width, total), layout="none")
    for map_, height, (column, top) in zip(shown, heights, places):
        left, bottom = (column * WIDTH + 1.35) / width, 1 - (legend + top + height - 0.6) / total
        axes = figure.add_axes((left, bottom, (WIDTH - 1.5) / width, (height - HEAD) / total))
        panel(axes, map_, [row for row in rows if row["map"] == map_.name])
    present = [name for name in COLOURS if any(row["outcome"] == name for row in rows)]
    figure.legend(handles=[Patch(color=COLOURS[name], label=MEANINGS[name]) for name in present], loc="upper center", ncols=len(present), fontsize=8.5, frameon=False)
    figure.savefig(file, dpi=110)
    pyplot.close(figure)
