# SPDX-License-Identifier: LGPL-2.1-or-later
# Part of Tanktread: figures of the scenes with several capsules.
"""draw(group, results, folder) makes <folder>/<group>.png."""

import matplotlib.pyplot as plt
import numpy as np

import averages
import results as published

COLORS = ("#0072B2", "#D55E00", "#009E73", "#CC79A7", "#E69F00", "#56B4E9", "#666666")
RE_COLORS = {3: COLORS[0], 10: COLORS[1], 50: COLORS[2]}
OTHERS = {"shear": "--", "radius": "-.", "cells": ":", "steps": "-."}  # readings and resolutions beside the three runs


def reynolds_of(name):
    """On the diameter, as published."""
    return int(name.split("_")[1])


def draw_inertia(results, axes):
    """Left the three runs; right those that read the numbers otherwise, or are coarser, beside the run and the points that they belong to."""
    others = [result for result in results if result.name.count("_") > 1]
    beside = {reynolds_of(result.name) for result in others}
    for axis, shown, numbers in ((axes[0], [result for result in results if result not in others], published.PUBLISHED_INERTIA), (axes[1], others, beside)):
        for reynolds in numbers:
            axis.plot(*published.PUBLISHED_INERTIA[reynolds], "D", color=RE_COLORS[reynolds], markersize=5)
        for result in shown + [result for result in results if axis is axes[1] and result not in others and reynolds_of(result.name) in beside]:
            style = OTHERS.get(result.name.split("_")[-1], "-" if result.resolution == "quick" else (0, (6, 1)))
            axis.plot(result.capsules[0]["time"], result.capsules[0]["z"] / 2, color=RE_COLORS[reynolds_of(result.name)], linestyle=style, label=result.label)
        axis.axhline(0, color="#666666", linewidth=0.6)
        axis.set(xlabel=r"$\dot\gamma t$", ylabel="height $/D$")
        axis.legend(fontsize=8)


def draw_crossing(results, axes):
    for color, result in zip(COLORS, results):
        axes[0].plot(*result.offset(), color=color, label=result.label)
        axes[1].plot(result.capsules[0]["time"], result.capsules[0]["D"], color=color)
    axes[0].plot(*zip((-4, 0.252), (0.43, 0.720), (5.7, 0.546)), "D", color="#222222", markersize=5, label="published, λ = 1")
    axes[0].set(xlabel=r"$\Delta x/2a$", ylabel=r"$\Delta z/2a$")
    axes[1].set(xlabel=r"$\dot\gamma t$", ylabel="$D$")
    axes[0].legend(fontsize=8)


def fraction_of(result):
    return float(result.suspension["volume_fraction"][0])


def draw_suspension(results, axes):
    shades = plt.get_cmap("viridis")
    for result in results:
        time, viscosity = result.suspension["time"], result.suspension["relative_viscosity"]
        style = ":" if float(result.setting("Scene/Reynolds number", "0")) else "-"
        axes[0].plot(time, viscosity, linestyle=style, color=shades(fraction_of(result) / 0.35), linewidth=1.2)
    axes[0].axvline(averages.START, color="#666666", linewidth=0.6)
    axes[0].set(xlabel=r"$\dot\gamma t$", ylabel="relative viscosity")
    kinds = {"8, Stokes": (COLORS[0], "o"), "27, Stokes": (COLORS[1], "s"), "64, Stokes": (COLORS[2], "^"), "8, Re = 10": (COLORS[3], "v")}
    seen = set()
    for result in results:
        kind = f"{len(result.capsules)}, " + ("Re = 10" if float(result.setting("Scene/Reynolds number", "0")) else "Stokes")
        viscosity = result.averages["relative_viscosity"]
        color, marker = kinds[kind]
        axes[1].errorbar(100 * fraction_of(result), viscosity.mean, viscosity.error, color=color, marker=marker, linestyle="", capsize=3, label=None if kind in seen else kind)
        seen.add(kind)
    axes[1].plot([100 * fraction for fraction in published.PUBLISHED_VISCOSITY], list(published.PUBLISHED_VISCOSITY.values()), "D--", color="#222222", markersize=5,
                 linewidth=0.8, label="50, Re = 10 (Huet, Wachs)")
    axes[1].set(xlabel="volume fraction, %", ylabel="relative viscosity", ylim=(1, None))
    axes[1].legend(fontsize=8)


DRAW = {"inertia": draw_inertia, "crossing": draw_crossing, "suspension": draw_suspension}


def draw(group, results, folder):
    """Results: those of the group that have series."""
    figure, axes = plt.subplots(1, 2, figsize=(10, 3.8))
    DRAW[group](results, np.ravel(axes))
    file = folder / f"{group}.png"
    file.parent.mkdir(parents=True, exist_ok=True)
    figure.savefig(file, dpi=90)
    plt.close(figure)
    print(f"{group}: {file}")
