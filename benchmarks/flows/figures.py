# SPDX-License-Identifier: LGPL-2.1-or-later
# Part of Tanktread: figures of the scenes of several capsules and other flows.
"""draw(name, results, folder) makes <folder>/<name>.png: the runs of a scene, coarse to fine, and the reference dashed."""

import matplotlib.pyplot as plt

import scenes
from run_files import without_jumps

COLORS = {"quick": "#E69F00", "wide": "#56B4E9", "full": "#0072B2", "unbounded": "#D55E00", "unbounded-full": "#009E73"}
REFERENCE = {"color": "#222222", "linestyle": "--", "linewidth": 1.1, "zorder": 5, "label": "boundary integral"}
LABELS = {"z_moved": "$(z - z_0)/a$", "u_z": r"$u_z$", "D": "$D$", "theta": r"$\theta/\pi$", "L": "$L/a$", "B": "$B/a$", "W": "$W/a$"}
SHAPE, WAY = ("D", "L", "B", "W"), ("z_moved", "u_z", "D", "theta")
PANELS = {"planar_extension": SHAPE, "uniaxial_extension": SHAPE, "parabola": WAY, "wall": WAY}

# Points of the published curve (Lac, Morel, Barthes-Biesel 2007), within 2 %: distance along the flow and offset, both over the diameter.
PUBLISHED = {"at first": (-4, 0.252), "largest": (0.43, 0.720), "at the end": (5.7, 0.546)}


def draw_over_time(axis, quantity, results, wanted):
    draw = without_jumps if quantity == "theta" else lambda values: values
    for result in results:
        axis.plot(result.capsules[0]["time"], draw(result.capsules[0][quantity]), color=COLORS[result.resolution], linewidth=1.5, label=result.resolution)
    shown = wanted["time"] <= max(result.capsules[0]["time"][-1] for result in results) * 1.02
    axis.plot(wanted["time"][shown], draw(wanted[quantity][shown]), **REFERENCE)
    axis.set(xlabel="time", ylabel=LABELS[quantity])


def draw_offset(axis, results, wanted):
    for result in results:
        axis.plot(*result.offset(), color=COLORS[result.resolution], linewidth=1.5, label=result.resolution)
    axis.plot(wanted["x"], wanted["z"], **REFERENCE)  # the second is the image of the first, so that x and z over a are the offsets over 2a
    axis.plot(*zip(*PUBLISHED.values()), "D", color="#D55E00", markersize=5, zorder=6, label="published")
    axis.set(xlabel=r"$\Delta x/2a$", ylabel=r"$\Delta z/2a$")


def draw_gap(axis, results, wanted):
    for result in results:
        if "smallest_gap" in result.suspension:
            axis.plot(result.suspension["time"], result.suspension["smallest_gap"], color=COLORS[result.resolution], linewidth=1.5)
    axis.plot(wanted["time"], wanted["gap"], **REFERENCE)
    axis.set(xlabel="time", ylabel="smallest gap $/a$", yscale="log")


def draw(name, results, folder):
    """Results are those that have series."""
    wanted, _ = scenes.reference(name)
    figure, axes = plt.subplots(2, 2, figsize=(9, 5.4))
    if name == "crossing_pair":
        draw_offset(axes[0, 0], results, wanted)
        draw_gap(axes[0, 1], results, wanted)
        panels = {"D": axes[1, 0], "theta": axes[1, 1]}
    else:
        panels = dict(zip(PANELS[name], axes.flat))
    for quantity, axis in panels.items():
        draw_over_time(axis, quantity, results, wanted)
    axes[0, 0].legend(fontsize=8)
    file = folder / f"{name}.png"
    file.parent.mkdir(parents=True, exist_ok=True)
    figure.savefig(file, dpi=90)
    plt.close(figure)
    print(f"{name}: {file}")
