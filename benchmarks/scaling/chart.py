# SPDX-License-Identifier: LGPL-2.1-or-later
# Part of Tanktread: the figure of scaling.
"""Work a capsule, efficiency on several ranks, memory of a rank, and the model's parts of a step beyond."""

import plot_style  # noqa: F401
from matplotlib import pyplot
from matplotlib.ticker import ScalarFormatter

import model
import report

COLOURS = ["#1f5a91", "#d1762a", "#4d9351", "#a34a58", "#7d6bb0", "#8a8a8a"]


def plain(axes):
    """Ranks and capsules double from one case to the next."""
    axes.set_xscale("log", base=2)
    axes.xaxis.set_major_formatter(ScalarFormatter())


def of_work(axes, rows):
    rows = report.cases_of(rows, "proportion")
    axes.plot([row["capsules"] for row in rows], [row["cpu_slowest"] / row["capsules"] for row in rows], "o-", color=COLOURS[0], label="one rank")
    plain(axes)
    axes.set(xlabel="capsules", ylabel="CPU s a step and capsule", ylim=(0, None))


def of_efficiency(axes, rows):
    for i, (label, chosen, law) in enumerate(report.efficiencies(rows)):
        axes.plot([row["ranks"] for row in chosen], law, "o-", color=COLOURS[i], label=label)
    plain(axes)
    axes.set(xlabel="ranks", ylabel="efficiency of the work", ylim=(0, 1.1))


def of_memory(axes, rows):
    rows = report.cases_of(rows, "memory")
    axes.plot([row["ranks"] for row in rows], [row["memory_largest"] for row in rows], "o-", color=COLOURS[0], label="largest rank")
    plain(axes)
    axes.set(xlabel="ranks", ylabel="memory of a rank, MiB")
    axes.set_ylim(0, 1.1 * max((row["memory_largest"] for row in rows), default=1))


def of_model(axes, rows, fraction, cores):
    law = model.of_rows(rows, fraction, cores)
    if law is None:
        return
    parts = [law.parts(report.A_RANK * n, n) for n in report.RANKS_OF_MODEL]
    for colour, name in zip(COLOURS, parts[0]):
        axes.plot(report.RANKS_OF_MODEL, [part[name] for part in parts], "--", color=colour, label=name)
    plain(axes)
    axes.set(yscale="log", xlabel="ranks", ylabel=f"model: s a step, {report.A_RANK} capsules a rank")


def draw(notes, rows, figure):
    """The four panels."""
    picture, panels = pyplot.subplots(2, 2, figsize=(11, 8))
    of_work(panels[0][0], rows)
    of_efficiency(panels[0][1], rows)
    of_memory(panels[1][0], rows)
    of_model(panels[1][1], rows, float(notes["fraction"]), float(notes["cores"]))
    for axes in panels.flat:
        if axes.get_legend_handles_labels()[0]:
            axes.legend(fontsize=8)
    picture.savefig(figure)
    pyplot.close(picture)
