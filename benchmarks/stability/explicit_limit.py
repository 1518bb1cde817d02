# SPDX-License-Identifier: LGPL-2.1-or-later
# Part of Tanktread: how long explicit steps may be on a fine mesh, and what they cost beside implicit ones.
"""A sphere with bending in shear (G = 0.05, kappa hat = 0.0375) on cells of 10a/128 and the control mesh that goes with them. Explicit steps are halved until a few of them stay stable, from there the cost of a
whole run is that of a step times their number; implicit runs are made to the end. Results: explicit_limit.csv, a row a run."""

import csv
import math
import pathlib

import run_files
import run_scenes

import outcomes

HERE = pathlib.Path(__file__).resolve().parent
TABLE = HERE / "explicit_limit.csv"
END = 2.0  # shear times: D is within 1 % of its steady value
COMMON = {"Scene/Shear number G": "0.05", "Scene/Reduced bending modulus": "0.0375", "Scene/Box side": "7.5", "Fluid mesh/Finest cell": "0.078125", "Fluid mesh/Coarsest cell": "2.5",
          "Shell mesh/Level": "4", "Time/Tolerance": "0", "Solver/Newton tolerance": "0.001", "Solver/Volume tolerance": "1e-5"}
FIRST, STEPS = 0.002, 20  # explicit: the length to begin with, and how many steps a trial has: noise of 1e-6 that grows by 2 a step shows
IMPLICIT = [("BDF2", 0.5), ("BDF3", 0.5), ("BDF3", 0.2)]  # the last one is what the others are compared with
RIGHT = 0.01  # of D
COLUMNS = ["coupling", "scheme", "step", "steps", "outcome", "D", "detail_ratio", "cpu_seconds", "cpu_a_step"]


def run():
    return run_scenes.Run(HERE, outcomes.OUTPUT, "sphere")


def result_of(name, columns):
    """A row of the table from what a run has left."""
    record, folder = run().record(name), run().folder(name)
    row = {**columns, "steps": 0, "cpu_a_step": math.nan, "D": math.nan, "detail_ratio": math.nan, "cpu_seconds": record["cpu_seconds"], "outcome": "done" if record["exit_code"] == 0 else "unstable"}
    tables = outcomes.histories_of(folder)
    if tables:
        wall, steps = tables[0]["wall_time"], len(tables[0]["time"]) - 1
        row.update(steps=steps, D=float(tables[0]["D_xz"][-1]), detail_ratio=float(tables[0]["detail_ratio"][-1]),
                   cpu_a_step=record["cpu_seconds"] * (1 - wall[0] / record["seconds"]) / max(steps, 1))  # without the first flow
    if row["outcome"] == "done" and "detail_ratio" in outcomes.warnings_in(outcomes.log_of(folder)):
        row["outcome"] = "unstable"
    return row


def made(args, name, settings, columns):
    """The row of a run, which is made unless it is there."""
    record = run().record(name)
    if record is None or record["input"] != run().key(settings):
        run_scenes.compute(args, [(run(), name, settings)])
    return result_of(name, columns)


def explicit(args, step):
    settings = {**COMMON, "Solver/Coupling": "explicit", "Time/Step": f"{step:g}", "Scene/End time": f"{STEPS * step:g}"}
    return made(args, f"explicit_limit/explicit_{step:g}", settings, {"coupling": "explicit", "scheme": "Euler", "step": step})


def implicit(args, scheme, step):
    settings = {**COMMON, "Time/Scheme": scheme, "Time/Step": f"{step:g}", "Scene/End time": f"{END:g}"}
    return made(args, f"explicit_limit/{scheme}_{step:g}", settings, {"coupling": "implicit", "scheme": scheme, "step": step})


def bisect(args):
    """Explicit runs with steps that differ by two, until a stable one stands beside an unstable one."""
    rows = {}
    step = FIRST
    while True:
        rows[step] = explicit(args, step)
        stable = rows[step]["outcome"] == "done"
        following = 2 * step if stable else step / 2
        if following in rows or following < 1e-6:
            return [rows[key] for key in sorted(rows, reverse=True)]
        step = following


def measure(args):
    rows = bisect(args) + [implicit(args, *choice) for choice in IMPLICIT]
    with open(TABLE, "w", newline="", encoding="utf-8") as stream:
        writer = csv.DictWriter(stream, COLUMNS, lineterminator="\n")
        writer.writeheader()
        for row in rows:
            writer.writerow({key: f"{value:.5g}" if isinstance(value, float) else value for key, value in row.items()})


def read():
    """Rows of the table; none if it has not been made."""
    if not TABLE.is_file():
        return []
    with open(TABLE, encoding="utf-8") as stream:
        rows = list(csv.DictReader(stream))
    for row in rows:
        row.update({key: run_files.number(row[key]) for key in COLUMNS if key not in ("coupling", "scheme", "outcome")})
    return rows


def figures(rows):
    """What is wanted of the table: longest stable explicit step, implicit ones, CPU seconds to END."""
    stable = [row for row in rows if row["coupling"] == "explicit" and row["outcome"] == "done"]
    done = [row for row in rows if row["coupling"] == "implicit" and row["outcome"] == "done"]
    if not stable or not done:
        return None
    truth, longest = done[-1]["D"], max(stable, key=lambda row: row["step"])
    right = [row for row in done[:-1] if abs(row["D"] / truth - 1) <= RIGHT] or done[-1:]
    cheapest = min(right, key=lambda row: row["cpu_seconds"])
    seconds = longest["cpu_a_step"] * END / longest["step"]
    return {"explicit_step": longest["step"], "implicit_step": max(row["step"] for row in done), "explicit_seconds": seconds, "cheapest": cheapest, "truth": done[-1]}
