# SPDX-License-Identifier: LGPL-2.1-or-later
# Part of Tanktread: the runs behind the figures of Le (2010), and what they have left in their folders.
"""Which runs a figure needs, where their results are, and their series, with those of the reference solutions."""

import json
import math
import pathlib
import sys

import numpy as np

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parents[1]
sys.path.insert(0, str(HERE.parent))
import plot_run  # noqa: E402

import motion  # noqa: E402

# From coarse to fine. The names are those of the parameter files, which hold physics and times; this says how fine, and in which box.
RESOLUTIONS = {
    "quick": {"Fluid mesh/Finest cell": "0.3125", "Shell mesh/Level": "2", "Scene/Box side": "20"},
    "full": {"Fluid mesh/Finest cell": "0.15625", "Shell mesh/Level": "3", "Scene/Box side": "40"},
}


def described(settings):
    """A resolution in words."""
    points = 10 * 4 ** int(settings["Shell mesh/Level"]) + 2
    return f"cells of {settings['Fluid mesh/Finest cell']} a at the shell, {points} control points, a box of {settings['Scene/Box side']} a"


def figure_names():
    return sorted(folder.name for folder in HERE.glob("fig*") if folder.is_dir())


class Run:
    """A parameter file: name is "fig05/G0.05_k0"."""

    def __init__(self, name):
        self.name = name
        self.prm = HERE / f"{name}.prm"

    def folder(self, resolution):
        return ROOT / "output/le_2010" / resolution / self.name

    def key(self, settings):
        """What decides the result; a run with another key has to be done again."""
        return {"prm": self.prm.read_text(), "settings": settings}

    def is_finished(self, resolution, settings):
        file = self.folder(resolution) / "run.json"
        if not file.is_file():
            return False
        record = json.loads(file.read_text())
        return record["exit_code"] == 0 and record["input"] == self.key(settings)

    def parameters(self):
        return plot_run.read_parameters(self.prm)

    def order(self):
        """By G and bending modulus, then by name."""
        parameters = self.parameters()
        return [float(parameters.get(f"Scene/{name}", 0)) for name in ("Shear number G", "Reduced bending modulus")] + [self.name]

    def end_time(self):
        return float(self.parameters().get("Scene/End time", 10))


def runs_of(figure):
    """The runs that a figure shows: its own parameter files, or those that its runs.txt names."""
    borrowed = HERE / figure / "runs.txt"
    if borrowed.is_file():
        return [Run(line.strip()) for line in borrowed.read_text().splitlines() if line.strip() and not line.startswith("#")]
    return sorted((Run(f"{figure}/{file.stem}") for file in (HERE / figure).glob("*.prm")), key=Run.order)


def find(names):
    """Runs for figures and single runs, each once; all for no names."""
    found = {}
    for name in names or figure_names():
        for run in [Run(name)] if "/" in name else runs_of(name):
            found[run.name] = run
    return [found[name] for name in sorted(found)]


class Result:
    """The folder of a run at the finest resolution at which it has been done. `series` is {} when there is nothing."""

    def __init__(self, run):
        self.name, self.parameters = run.name, run.parameters()
        self.resolution, self.folder, self.record = None, None, None
        for resolution in RESOLUTIONS:  # from coarse to fine
            record = run.folder(resolution) / "run.json"
            found = json.loads(record.read_text()) if record.is_file() else None
            if found and (self.record is None or found["exit_code"] == 0 or self.record["exit_code"] != 0):
                self.resolution, self.folder, self.record = resolution, run.folder(resolution), found
        self.series, self.summary, self.contours = {}, {}, []
        if self.record is None or self.record["exit_code"] == 1:
            return
        history, summary, contours = (self.folder / f"{name}.csv" for name in ("history", "summary", "contours"))
        if history.is_file():
            self.series, _ = plot_run.read_table(history)
        if summary.is_file():
            self.summary = dict(line.split(",", 1) for line in summary.read_text().splitlines()[1:])
        if contours.is_file():
            table, _ = plot_run.read_table(contours)
            self.contours = plot_run.contours_by_time(table) if table else []

    def number(self, quantity):
        return plot_run.number(self.summary.get(quantity, "nan"))

    @property
    def G(self):
        return float(self.parameters.get("Scene/Shear number G", 0.05))

    @property
    def khat(self):
        return float(self.parameters.get("Scene/Reduced bending modulus", 0))

    def state(self):
        """"done", or why there is nothing."""
        if self.record is None:
            return "not run"
        if self.record["exit_code"] == 0:
            return "done"
        text = self.record["message"].split(";")[0]
        return "refused: " + text.split(": ")[-1] if self.record["exit_code"] == 1 else "failed: " + text

    def reference(self):
        """(series, motion) of the reference solution for this scene, or None."""
        for file in sorted(plot_run.REFERENCE_FOLDER.glob("*.csv")):
            table, notes = plot_run.read_table(file)
            if plot_run.matches(notes, self.parameters):
                series = plot_run.standard_columns(table)
                series.update({name: table[name] for name in ("L", "B", "W") if name in table})
                if "alpha_over_pi" not in table:
                    return series, None
                series["delta"] = motion.phase_angle(series["theta"], table["alpha_over_pi"])
                return series, motion.summary(series["time"], series["D"], series["theta"], table["alpha_over_pi"])
        return None

    def at(self, time, quantity):
        """Value at a time by a cubic through the four nearest rows."""
        return interpolated(self.series["time"], self.series[quantity], time) if quantity in self.series else math.nan


def interpolated(times, values, time):
    if not len(times) or time > times[-1] * (1 + 1e-9):
        return math.nan
    nearest = np.sort(np.argsort(np.abs(times - time))[:4])
    t, v = times[nearest], values[nearest]
    weights = [np.prod([(time - b) / (a - b) for b in t if b != a]) for a in t]
    return float(np.dot(weights, v))


class Results:
    """All runs of all figures."""

    def __init__(self):
        self.runs = {run.name: Result(run) for run in find([])}

    def of(self, figure):
        return [self.runs[run.name] for run in runs_of(figure)]
