# SPDX-License-Identifier: LGPL-2.1-or-later
# Part of Tanktread: the runs behind the figures of Le (2010), and what they have left in their folders.
"""Which runs a figure needs, where their results are, and their series, with those of the reference solutions."""

import pathlib
import sys

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent))
import run_files  # noqa: E402
import run_scenes  # noqa: E402

import motion  # noqa: E402

OUTPUT = run_scenes.ROOT / "output/le_2010"

# From coarse to fine: targets of the dial, which chooses what the parameter files leave open.
RESOLUTIONS = {"quick": "1e-2", "fair": "3e-3", "full": "1e-3"}


def described(resolution):
    """A resolution in words."""
    return f"a target error of {RESOLUTIONS[resolution]}"


def settings(run, resolution):
    """What is set beside the parameter file: the target, and the study that tells the error bars. Spheres in shear have a steady state, whose bar counts too; runs
    with fixed steps show what these do, which no companion can tell."""
    parameters = run.parameters()
    target = {"Accuracy/Target error": RESOLUTIONS[resolution]}
    if "Time/Step" in parameters:
        return target
    is_steady = parameters.get("Scene/Flow", "shear") == "shear" and parameters.get("Capsule/Shape", "sphere") == "sphere"
    return {**target, "Study/Vary": "target, stop" if is_steady else "target"}


def figure_names():
    return sorted(folder.name for folder in HERE.glob("fig*") if folder.is_dir())


def run_named(name):
    """The run of a parameter file: name is "fig05/G0.05_k0"."""
    return run_scenes.Run(HERE, OUTPUT, name)


def order(run):
    """By G and bending modulus, then by name."""
    parameters = run.parameters()
    return [float(parameters.get(f"Scene/{name}", 0)) for name in ("Shear number G", "Reduced bending modulus")] + [run.name]


def runs_of(figure):
    """The runs that a figure shows: its own parameter files, or those that its runs.txt names."""
    borrowed = HERE / figure / "runs.txt"
    if borrowed.is_file():
        return [run_named(line.strip()) for line in borrowed.read_text().splitlines() if line.strip() and not line.startswith("#")]
    return sorted((run_named(f"{figure}/{file.stem}") for file in (HERE / figure).glob("*.prm")), key=order)


def find(names):
    """Runs for figures and single runs, each once; all for no names."""
    found = {}
    for name in names or figure_names():
        for run in [run_named(name)] if "/" in name else runs_of(name):
            found[run.name] = run
    return [found[name] for name in sorted(found)]


def read_series(file):
    """Columns of a history, with D beside D_xz; {} if there is none."""
    table = run_files.read_table(file)[0] if file.is_file() else {}
    return {**table, "D": table["D_xz"]} if table else {}


def read_bars(file):
    """{(quantity, cause): bar} of a study, {} if there is none."""
    table = [line.split(",") for line in file.read_text().splitlines()[1:]] if file.is_file() else []
    return {(row[0], row[1]): run_files.number(row[3]) for row in table}


class Result:
    """The folder of a run at the finest resolution at which it has been done. `series` is {} when there is nothing, `companion` when there is no error bar."""

    def __init__(self, run):
        self.name, self.parameters = run.name, run.parameters()
        self.resolution, self.folder, self.record = None, None, None
        for resolution in RESOLUTIONS:  # from coarse to fine
            found = run.record(resolution)
            if found and "Accuracy/Target error" in found["settings"] and (self.record is None or found["exit_code"] == 0 or self.record["exit_code"] != 0):
                self.resolution, self.folder, self.record = resolution, run.folder(resolution), found
        self.series, self.companion, self.summary, self.bars, self.chosen, self.contours = {}, {}, {}, {}, {}, []
        if self.record is not None and self.record["exit_code"] != 1:
            self.read()

    def read(self):
        """What is in the folder; the companion is the run of four times the target."""
        self.series, self.companion = (read_series(folder / "history.csv") for folder in (self.folder, self.folder / "study/target-1"))
        self.bars = read_bars(self.folder / "study.csv")
        summary, contours, used = (self.folder / name for name in ("summary.csv", "contours.csv", "used_parameters.prm"))
        if summary.is_file():
            self.summary = dict(line.split(",", 1) for line in summary.read_text().splitlines()[1:])
        if contours.is_file():
            table, _ = run_files.read_table(contours)
            self.contours = run_files.contours_by_time(table) if table else []
        if used.is_file():
            self.chosen = run_files.read_parameters(used)

    def number(self, quantity):
        return run_files.number(self.summary.get(quantity, "nan"))

    @property
    def G(self):
        return float(self.parameters.get("Scene/Shear number G", 0.05))

    @property
    def khat(self):
        return float(self.parameters.get("Scene/Reduced bending modulus", 0))

    def state(self):
        """"done", also without a companion, or why there is nothing."""
        if self.record is None:
            return "not run"
        if self.record["exit_code"] == 0 or self.summary.get("outcome") in ("done", "steady"):
            return "done"
        text = self.record["message"].split(";")[0]
        return "refused: " + text.split(": ")[-1] if self.record["exit_code"] == 1 else "failed: " + text

    def reference(self):
        """(series, motion) of the reference solution for this scene, or None."""
        for file in run_files.find_references(self.parameters):
            table, _ = run_files.read_table(file)
            series = run_files.standard_columns(table)
            if "alpha_over_pi" not in table:
                return series, None
            series["delta"] = motion.phase_angle(series["theta"], table["alpha_over_pi"])
            return series, motion.summary(series["time"], series["D"], series["theta"], table["alpha_over_pi"])
        return None


class Results:
    """All runs of all figures."""

    def __init__(self):
        self.runs = {run.name: Result(run) for run in find([])}

    def of(self, figure):
        return [self.runs[run.name] for run in runs_of(figure)]

    def are_complete(self, figure):
        """Whether all runs of a figure have been tried, and one has left something."""
        found = self.of(figure)
        return all(result.record for result in found) and any(result.series for result in found)
