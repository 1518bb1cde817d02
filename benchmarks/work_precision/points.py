# SPDX-License-Identifier: LGPL-2.1-or-later
# Part of Tanktread: from the folders of runs to the table of points.
"""Reads what the runs have left, compares it with what is true, and makes one row a point: errors, differences within a sweep, costs.

True are the boundary-integral solutions of benchmarks/reference for D and theta where there is one; else, and for the viscosity, what the two finest runs of the sweep "joint" tend to
with second order, doubted by all of what that is away from the finest of them.
"""

import datetime
import pathlib
import sys

import numpy as np

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent))
sys.path.append(str(HERE.parent / "le_2010"))  # at the end: it has a report.py too
import motion  # noqa: E402
import run_files  # noqa: E402
import run_scenes  # noqa: E402
import run_table  # noqa: E402

import norms  # noqa: E402
import sweeps  # noqa: E402

OUTPUT = run_scenes.ROOT / "output/work_precision"
ERRORS = ([f"error_{quantity}" for quantity in norms.QUANTITIES] + [f"end_error_{quantity}" for quantity in norms.QUANTITIES] + ["period_error"]
          + [f"difference_{quantity}" for quantity in norms.QUANTITIES])
COSTS = ["cpu_seconds", "wall_seconds", "steps", "cells", "control_points", "newton_iterations", "linear_iterations"]
NUMBERS = ["value", *ERRORS, *COSTS]
COLUMNS = ["scene", "cause", "value", "run", "settings", "outcome", *ERRORS, *COSTS]


def run_of(scene):
    return run_scenes.Run(HERE, OUTPUT, scene.name)


def record_of(scene, choice):
    """run.json of a choice if it was made with the same scene and settings, however it ended; or None."""
    run = run_of(scene)
    record = run.record(sweeps.name(choice))
    return record if record and record["input"] == run.key(sweeps.parameters(choice)) else None


def history(scene, choice):
    record = record_of(scene, choice)
    file = run_of(scene).folder(sweeps.name(choice)) / "history.csv"
    return run_files.read_table(file)[0] if record and record["exit_code"] == 0 and file.is_file() else {}


def curve_of(scene, choice):
    """The curve of a finished run, or None."""
    table = history(scene, choice)
    return {"time": table["time"], "D": table["D_xz"], "theta": norms.continuous(table["theta"]), "viscosity": table["intrinsic_viscosity"]} if table else None


class Truth:
    """Of each quantity: a curve, whether it may be read off anywhere (`dense`), its value at the end (steady scenes), how uncertain it is, over its scale (`doubt`)."""

    def __init__(self, scene):
        self.curve, self.dense, self.doubt = {}, {}, {}
        end = run_of(scene).end_time()
        found = [curve for curve in (curve_of(scene, sweeps.Choice(*joint)) for joint in sweeps.JOINT) if curve]
        guesses = [norms.extrapolated(fine, coarse) for coarse, fine in zip(found, found[1:])]
        for quantity in norms.QUANTITIES if guesses else []:
            self.curve[quantity], self.dense[quantity] = guesses[-1], False
            self.doubt[quantity] = norms.largest(found[-1], guesses[-1], quantity)
        for file in run_files.find_references(run_of(scene).parameters()):
            table = run_files.standard_columns(run_files.read_table(file)[0])
            reference = norms.until({"time": table["time"], "D": table["D"], "theta": norms.continuous(table["theta"])}, end)
            for quantity in ("D", "theta"):
                self.curve[quantity], self.dense[quantity], self.doubt[quantity] = reference, True, 0.0
            self.limit = {"D": table["D"][-1], "theta": table["theta"][-1]} if scene.steady else {}
            break
        else:
            self.limit = {}
        if scene.steady and "viscosity" in self.curve:
            self.limit["viscosity"] = self.curve["viscosity"]["viscosity"][-1]

    def errors(self, scene, choice, curve):
        """Errors of a curve by column."""
        result = {}
        for quantity, true in self.curve.items():
            if not choice.stop:
                result[f"error_{quantity}"] = norms.largest(curve, true, quantity, self.dense[quantity])
            if quantity in self.limit:
                result[f"end_error_{quantity}"] = abs(curve[quantity][-1] / self.limit[quantity] - 1)
        if scene.swinging and "D" in self.curve:
            found, true = (norms.period(of, motion.extrema) for of in (curve, self.curve["D"]))
            result["period_error"] = abs(found / true - 1)
        return result


def costs_of(scene, choice):
    record, table = record_of(scene, choice), history(scene, choice)
    result = {"cpu_seconds": record["cpu_seconds"], "wall_seconds": record["seconds"]}
    if table:
        result.update(steps=len(table["time"]) - 1, cells=int(table["cells"][-1]),
                      newton_iterations=round(float(np.mean(table["newton_iterations"][1:])), 3), linear_iterations=round(float(np.mean(table["linear_iterations"][1:])), 2))
        used = run_files.read_parameters(run_of(scene).folder(sweeps.name(choice)) / "used_parameters.prm")
        if "Shell mesh/Level" in used:
            result["control_points"] = 10 * 4 ** int(used["Shell mesh/Level"]) + 2
    return result


def rows_of(scene, points):
    """Rows of the points of a scene that have been computed. `difference_...`: from the next finer point of the sweep, over the scale of that."""
    truth, rows = Truth(scene), []
    usual = sweeps.parameters(sweeps.Choice(1, 0, 0))
    for i, point in enumerate(points):
        record, curve = record_of(scene, point.choice), curve_of(scene, point.choice)
        if record is None:
            continue
        changed = {key: value for key, value in sweeps.parameters(point.choice).items() if usual.get(key) != value}
        row = {"scene": scene.name, "cause": point.cause, "value": f"{point.value:.6g}", "run": sweeps.name(point.choice), "outcome": "done" if curve else f"failed: {record['message']}",
               "settings": "; ".join(f"{key}={value}" for key, value in changed.items()), **costs_of(scene, point.choice)}
        if curve:
            row.update(truth.errors(scene, point.choice, curve))
            finer = curve_of(scene, points[i + 1].choice) if i + 1 < len(points) and points[i + 1].cause == point.cause else None
            if finer and not point.choice.stop:
                row.update({f"difference_{quantity}": norms.largest(curve, finer, quantity) for quantity in norms.QUANTITIES})
        rows.append(row)
    return rows, truth


def programs(of):
    """First lines of the logs of all runs: version and revision, each once."""
    logs = [run_of(scene).folder(sweeps.name(point.choice)) / "log.txt" for scene in sweeps.SCENES for point in of[scene.name]]
    return "; ".join(dict.fromkeys(log.read_text().partition("\n")[0] for log in logs if log.is_file()))


def collect(of, mode, jobs):
    """(notes, rows): the table of all points. of: {scene name: points}."""
    notes, rows = {"machine": run_scenes.processor(), "date": f"{datetime.date.today()}", "program": programs(of), "mode": mode, "runs at a time": f"{jobs}, one rank each"}, []
    for scene in sweeps.SCENES:
        found, truth = rows_of(scene, of[scene.name])
        rows += found
        notes.update({f"doubt of {scene.name} {quantity}": f"{value:.3g}" for quantity, value in truth.doubt.items()})
    return notes, rows


def write(file, notes, rows):
    run_table.write(file, COLUMNS, notes, ({key: f"{value:.5g}" if isinstance(value, float) and key in ERRORS else value for key, value in row.items()} for row in rows))
