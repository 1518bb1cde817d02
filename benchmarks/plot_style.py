# SPDX-License-Identifier: LGPL-2.1-or-later
# Part of Tanktread: how all figures look.
"""Chooses matplotlib's backend without a screen and sets the style; to be imported before pyplot."""

import matplotlib

matplotlib.use("Agg")

matplotlib.rcParams.update({
    "font.size": 11, "axes.grid": True, "grid.color": "#e4e4e4", "grid.linewidth": 0.8, "axes.axisbelow": True,
    "axes.spines.top": False, "axes.spines.right": False, "axes.edgecolor": "#666666", "legend.frameon": False,
    "legend.fontsize": 10, "lines.linewidth": 1.8, "figure.constrained_layout.use": True, "savefig.dpi": 150,
})
