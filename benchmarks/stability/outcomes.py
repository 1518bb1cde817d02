# SPDX-License-Identifier: LGPL-2.1-or-later
# Part of Tanktread: from the folders of runs to the table of outcomes.
"""How each run of the maps has ended, read off its exit code, its log and its histories, and what it cost. No outcome is told by hand.

    holds     done, as wanted                      refused   exit code 1: the program says what is not allowed
    warned    done, with warnings                  ends      exit code 2 with a sentence that says why
    halves    done, with steps that were halved    limit     stopped at the limit of CPU time, still making steps

and those that must not be: `wrong` (no warning, and D at the end differs by more than a tenth of its largest value from the finest run of the group, or energy rises in a liquid at rest), `nan`
(in a history), `hang` (the limit of CPU time without a step in its last half) and `crash` (a signal, or an exit code without a sentence)."""

import datetime
import pathlib
import re
import signal
import sys

import numpy as np

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent))
import run_files  # noqa: E402
import run_scenes  # noqa: E402
import run_table  # noqa: E402

import maps  # noqa: E402

OUTPUT = run_scenes.ROOT / "output/stability"
GOOD, BAD = ("holds", "warned", "halves", "ends", "refused", "limit"), ("wrong", "nan", "hang", "crash")
FINISHED = ("holds", "warned", "halves", "wrong")
ALLOWED_ERROR = 0.1  # of D, over its largest value: what is further off has to be warned of
ENERGY_SLACK = 1e-6  # of the energy at the start: Newton's and the volume tolerance let that much through
TEXTS, NUMBERS = ["map", "row", "column", "outcome", "warnings", "message", "settings"], ["error_D", "D", "volume_error", "energy_rise", "detail_ratio", "time", "halved", "repeated", "steps",
                                                                                          "newton_a_step", "linear_a_step", "cpu_seconds", "cpu_a_unit"]


def run_of(cell):
    return run_scenes.Run(HERE, OUTPUT, cell.map.scene)


def record_of(cell):
    """run.json of a cell if it was made with the same scene and settings, however it ended; or None."""
    record = run_of(cell).record(maps.name(cell))
    return record if record and record["input"] == run_of(cell).key(maps.settings(cell)) else None


def log_of(folder):
    file = folder / "log.txt"
    return file.read_text(encoding="utf-8") if file.is_file() else ""


def histories_of(folder):
    return [table for _, table in run_files.tables_of_capsules(folder, "history") if table]


def warnings_in(log):
    """Names of what the program has warned of, `worst_` left out, and of what has no column: cells or control mesh that are too coarse for the target, too few points or steps to be judged."""
    lines = {"too_coarse": "what the file sets is too coarse", "few_points": "a control mesh of", "unknown_steps": "the local error of none"}
    at_start = [name for name, words in lines.items() if re.search(f"^WARNING: {words}", log, re.MULTILINE)]
    return at_start + list(dict.fromkeys(re.findall(r"^WARNED from time \S+ on: (?:worst_)?(\w+)", log, re.MULTILINE)))


def energy_rise(table):
    """Largest rise of the shell's energy from one row to the next, over the energy at the start."""
    energy = table["membrane_energy"] + table["bending_energy"]
    return float(max(0.0, np.max(np.diff(energy), initial=0.0)) / max(abs(energy[0]), 1e-300))


def has_nan(table):
    return any(not np.all(np.isfinite(table[name])) for name in ("D_xz", "L", "B", "W", "volume", "area", "membrane_energy", "bending_energy"))


def end_of_failure(record, log, progress):
    """Outcome of a run that did not end with exit code 0."""
    code, message = record["exit_code"], record["message"]
    if code == -signal.SIGXCPU:
        return "limit" if progress else "hang"
    if code == 1 and message:
        return "refused"
    return "ends" if code == 2 and "FAILED at time" in log else "crash"


def sentence(record, log):
    """What the program says of its end."""
    found = re.search(r"^FAILED at time (.*)$", log, re.MULTILINE)
    return "at time " + found[1] if found else record["message"]


def counts(log):
    """(steps halved, steps repeated for their local error or on another mesh)."""
    return len(re.findall(r"^Step of length \S+ halved", log, re.MULTILINE)), len(re.findall(r"^Step of length \S+ repeated", log, re.MULTILINE))


def costs(table, record):
    done = table["time"][-1]
    steps = len(table["time"]) - 1
    result = {"D": float(table["D_xz"][-1]), "volume_error": float(np.max(np.abs(table["volume_error"]))), "detail_ratio": float(np.max(table["detail_ratio"], initial=0.0, where=np.isfinite(table["detail_ratio"]))),
              "time": float(done), "steps": steps}
    if steps > 0:
        result.update(newton_a_step=float(np.mean(table["newton_iterations"][1:])), linear_a_step=float(np.mean(table["linear_iterations"][1:])), cpu_a_unit=record["cpu_seconds"] / done)
    return result


def row_of(cell, record):
    """What is seen of one run by itself."""
    folder = run_of(cell).folder(maps.name(cell))
    log, tables = log_of(folder), histories_of(folder)
    halved, repeated = counts(log)
    row = {"map": cell.map.name, "row": cell.row.label, "column": cell.column.label, "message": "", "warnings": " ".join(warnings_in(log)), "cpu_seconds": record["cpu_seconds"], "halved": halved,
           "repeated": repeated, "settings": " | ".join(f"{key}={value}" for key, value in maps.settings(cell).items())}
    for table in tables[:1]:
        row.update(costs(table, record))
    if record["input"]["prm"].find("quiescent") >= 0 and tables:
        row["energy_rise"] = max(map(energy_rise, tables))
    if record["exit_code"] != 0:
        row["outcome"] = end_of_failure(record, log, bool(tables) and tables[0]["wall_time"][-1] > 0.5 * record["seconds"])
        row["message"] = sentence(record, log)
    elif not tables or any(map(has_nan, tables)):
        row["outcome"] = "nan"
    else:
        row["outcome"] = "halves" if halved else "warned" if row["warnings"] else "holds"
        if row.get("energy_rise", 0) > ENERGY_SLACK and not row["warnings"]:
            row["outcome"] = "wrong"
            row["message"] = f"energy rises by {row['energy_rise']:.2g} of that at the start"
    return row


def reference_of(found):
    """Of the rows of a group, in the order of the map: the last finished one of the last row that has one; None when it would be compared with itself alone."""
    finished = [row for row in found if row["outcome"] in FINISHED]
    return finished[-1] if len(finished) > 1 else None


def compare(cells, found):
    """Adds the differences of D at the end; what is further off than ALLOWED_ERROR and not warned of is wrong."""
    for group in dict.fromkeys(cell.row.group for cell in cells):
        rows = [row for cell, row in zip(cells, found) if row and cell.row.group == group]
        reference = reference_of(rows)
        for row in rows if reference else []:
            if row is reference or row["outcome"] not in FINISHED:
                continue
            row["error_D"] = abs(row["D"] - reference["D"]) / largest_D(cells, reference)
            if row["error_D"] > ALLOWED_ERROR and not row["warnings"]:
                row["outcome"] = "wrong"
                row["message"] = row["message"] or f"D differs by {100 * row['error_D']:.2g} % from {reference['row']} at {reference['column']}"


def largest_D(cells, row):
    cell = next(cell for cell in cells if (cell.row.label, cell.column.label) == (row["row"], row["column"]))
    return float(np.max(histories_of(run_of(cell).folder(maps.name(cell)))[0]["D_xz"]))


def collect(quick, jobs):
    """(notes, rows) of all runs that are there."""
    result, missing, seconds, programs = [], 0, 0.0, {}
    for map_ in maps.MAPS:
        cells = maps.cells_of(map_, quick)
        records = [record_of(cell) for cell in cells]
        found = [row_of(cell, record) if record else None for cell, record in zip(cells, records)]
        if map_.compared:
            compare(cells, found)
        result += [row for row in found if row]
        missing += sum(row is None for row in found)
        for cell in cells:
            programs.setdefault(log_of(run_of(cell).folder(maps.name(cell))).partition("\n")[0])
    programs.pop("", None)
    seconds = sum(row["cpu_seconds"] for row in result)
    notes = {"machine": run_scenes.processor(), "date": f"{datetime.date.today()}", "program": "; ".join(programs), "mode": "quick" if quick else "full", "runs at a time": f"{jobs}, one rank each",
             "runs": len(result), "not made": missing, "CPU seconds": f"{seconds:.0f}"}
    return notes, result


def write(file, notes, rows):
    run_table.write(file, TEXTS[:-1] + NUMBERS + TEXTS[-1:], notes, ({key: f"{value:.4g}" if isinstance(value, float) else value for key, value in row.items()} for row in rows))
