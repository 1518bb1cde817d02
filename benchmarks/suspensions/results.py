# SPDX-License-Identifier: LGPL-2.1-or-later
# Part of Tanktread: what the runs with several capsules have left, and what was published of such scenes.
"""Result: one run. PUBLISHED_*: what others have, with the source."""

import dataclasses
import functools

import numpy as np

import averages
import run_files
import scenes

# Doddi, Bagchi, Int. J. Multiphase Flow 34, 375 (2008): height of the first capsule over D, digitised, to about 0.003: (times, heights) at Re on the diameter.
PUBLISHED_INERTIA = {
    3: ((0, 3.38, 7.61, 11.13, 14.64, 18.64, 22.16, 26.29), (0.100, 0.107, 0.095, 0.059, 0.019, -0.021, -0.057, -0.093)),
    10: ((0, 4.09, 7.99, 11.65, 15.21, 18.92, 22.82, 26.72, 29.71), (0.100, 0.102, 0.082, 0.030, -0.035, -0.088, -0.109, -0.091, -0.050)),
    50: ((0.02, 4.04, 7.37, 10.13, 12.6, 15.12, 18.26, 21.25, 24.06, 27.15, 30), (0.101, 0.096, 0.066, 0.021, -0.019, -0.051, -0.066, -0.055, -0.034, -0.014, -0.001)),
}
READING = 0.003  # of these heights
BAR = 0.05  # what the positions are asked to agree to, over D

# Huet, Wachs, J. Comput. Phys. 492, 112424 (2023) and the case suspension.c of their open code: 50 capsules in a cube, neo-Hookean, Ca = 0.1, Re = rho gamma a^2 / mu = 10,
# stress of the walls over mu gamma from their recorded runs; the two walls differ by up to 5 %.
PUBLISHED_VISCOSITY = {0.05: 1.28, 0.10: 1.52, 0.15: 1.72, 0.20: 1.93, 0.30: 2.34}


@dataclasses.dataclass(frozen=True)
class Average:
    """A mean over time with its standard error."""
    mean: float
    error: float


class Result:
    """A run at a resolution. `capsules` is [] where there is nothing."""

    def __init__(self, name, resolution):
        self.name, self.resolution, self.scene = name, resolution, scenes.SCENES[name]
        run = scenes.run_of(name)
        self.record, self.folder = run.record(resolution), run.folder(resolution)
        tables = [table for _, table in run_files.tables_of_capsules(self.folder, "history")] if self.record else []
        self.capsules = [run_files.standard_columns(table) for table in tables if "time" in table]
        file = self.folder / "suspension.csv"
        self.suspension = run_files.read_table(file)[0] if self.record and file.is_file() else {}

    def setting(self, name, default=""):
        return self.record["settings"].get(name, scenes.run_of(self.name).parameters().get(name, default))

    @property
    def label(self):
        return self.scene.label + ("" if self.resolution == "quick" else f" ({self.resolution})")

    def state(self):
        """"done", or what became of it."""
        if self.record is None:
            return "not run"
        if self.record["exit_code"] < 0 and self.capsules:
            return f"stopped from outside at {self.end():g}"
        return "done" if self.record["exit_code"] == 0 else self.record["message"] or f"exit code {self.record['exit_code']}"

    def end(self):
        return float(self.capsules[0]["time"][-1])

    def height_over_diameter(self, times):
        """Of the first capsule."""
        return run_files.interpolated(self.capsules[0]["time"], self.capsules[0]["z"] / 2, np.asarray(times, dtype=float))

    def offset(self):
        """(distance along the flow, distance across) of a pair, over 2a."""
        rows = min(len(series["time"]) for series in self.capsules)
        return tuple((self.capsules[0][name][:rows] - self.capsules[1][name][:rows]) / 2 for name in ("x", "z"))

    @functools.cached_property
    def averages(self):
        """{quantity: Average} after the start-up."""
        series = {name: (self.suspension["time"], self.suspension[name]) for name in ("relative_viscosity", "N1", "N2", "momentum_flux_xz") if name in self.suspension}
        series.update({name: averages.mean_of_capsules(self.capsules, name) for name in ("D", "theta")})
        return {name: Average(*averages.block_average(*pair)[:2]) for name, pair in series.items()}

    def smallest_gap(self):
        return float(np.nanmin(self.suspension["smallest_gap"]))

    def strains(self):
        """Capsules times the time that they have been followed."""
        return len(self.capsules) * self.end()

    def cpu_seconds(self):
        """Of all ranks; nan of a run that did not tell."""
        return self.record.get("cpu_seconds", float("nan"))


def load():
    """{name: [Result]} of all runs that have been tried, coarse to fine."""
    found = {name: [Result(name, resolution) for resolution in scenes.RESOLUTIONS] for name in scenes.SCENES}
    return {name: [result for result in results if result.record] for name, results in found.items()}
