# SPDX-License-Identifier: LGPL-2.1-or-later
# Part of Tanktread: what count_mpi.c has written beside a run.
"""Totals and series of each rank; calls by who makes them; Measured: a case's figures a step."""

import collections
import csv
import re
import statistics
import subprocess

import numpy as np

import cases
import run_files

MESSAGES = ("Isend", "Send", "Issend", "Sendrecv")
WAITS = ("Wait", "Waitall", "Waitsome", "Waitany", "Recv", "Probe")  # nothing is handed over
FIRST_STEPS = 2  # that do not count: libraries, meshes and the time scheme start
LINEAR_SOLVE, STEP = re.compile(r"\bsolve_fgmres<[^(]*MonolithicOperator"), re.compile(r"\bSimulation::step\(")
GROUPS = {"liquid": "ghosts, multigrid and norms of the liquid", "coupling": "what the points of the shells send in the liquid's mesh", "shells": "control points and forces of all shells",
          "Krylov": "scalar products of the linear solver", "rest": "output, errors, start of meshes"}

Sum = collections.namedtuple("Sum", "calls bytes cpu")
Frame = collections.namedtuple("Frame", "function layer file line")  # layer: None outside of the project's sources


# ------------------------------------------------------------------------------------------------------------------------ totals
def read_totals(file):
    """({kind: Sum}, notes) of one rank."""
    lines = file.read_text().splitlines()
    notes = dict(line[2:].split(": ", 1) for line in lines if line.startswith("# "))
    rows = csv.DictReader(line for line in lines if not line.startswith("# "))
    return {row["kind"]: Sum(int(row["calls"]), int(row["bytes"]), float(row["cpu_seconds"])) for row in rows}, notes


def of_each_rank(folder, stem):
    """Files <stem>_0.csv, <stem>_1.csv, ... in their order."""
    return sorted(folder.glob(f"{stem}_*.csv"), key=lambda file: int(file.stem.rsplit("_", 1)[1]))


# ------------------------------------------------------------------------------------------------------------------------ places
def resolved(program, addresses):
    """{address: [Frame], innermost first}: what has been inlined there, and the function itself."""
    if not addresses:
        return {}
    said = subprocess.run(["addr2line", "-a", "-i", "-f", "-C", "-e", str(program)], input="\n".join(addresses) + "\n", stdout=subprocess.PIPE, text=True, check=True)
    return parsed(said.stdout)


def parsed(text):
    """What addr2line -a -i -f -C says."""
    result, frames, function = {}, None, None
    for line in text.splitlines():
        if re.fullmatch(r"0x[0-9a-f]+", line):
            frames = result.setdefault(hex(int(line, 16)), [])
        elif function is None:
            function = line
        else:
            found = re.search(r"(?:source|include/tanktread)/(\w+)/(\w+\.(?:h|cc)):(\d+)", line)
            frames.append(Frame(function, *(found.groups() if found else (None, "", ""))))
            function = None
    return result


def group(frames):
    """Which of GROUPS a call belongs to, by the frames of its stack, innermost first: whoever makes it, but what the liquid's parts do for the coupling is the coupling's."""
    layers = [(frame.layer, frame.file) for frame in frames if frame.layer not in (None, "base")]
    if not layers:
        return "rest"
    if layers[0][1] in ("krylov_basis.cc", "krylov_basis.h"):
        return "Krylov"
    first = next((layer for layer, _ in layers if layer != "fluid"), None)
    if first == "coupling":
        return "coupling"
    if layers[0][0] == "fluid":
        return "liquid"
    return {"solver": "shells"}.get(layers[0][0], "rest")


class Place:
    """Calls of one kind from one line of the project's sources; of one rank."""

    def __init__(self, kind, calls, bytes_, frames):
        self.kind, self.calls, self.bytes, self.group = kind, calls, bytes_, group(frames)
        own = next((frame for frame in frames if frame.layer is not None), None)
        self.where = f"{own.layer}/{own.file}:{own.line}" if own else "outside"
        functions = " ".join(frame.function for frame in frames)
        self.in_solve, self.in_step = bool(LINEAR_SOLVE.search(functions)), bool(STEP.search(functions))
        self.is_message = kind in MESSAGES


def read_places(file, program):
    """Places of one rank's file, one for each stack."""
    with open(file, newline="") as stream:
        rows = list(csv.DictReader(stream))
    frames = resolved(program, sorted({address for row in rows for address in row["frames"].split()}))
    return [Place(row["kind"], int(row["calls"]), int(row["bytes"]), [frame for address in row["frames"].split() for frame in frames[address]]) for row in rows]


# ------------------------------------------------------------------------------------------------------------------------ a case
def times_of_rows(wall_times, last_written):
    """Seconds since 1970 of the rows of a history whose file was written last at last_written: what else a run does at its end does not touch it."""
    return last_written - (wall_times[-1] - wall_times)


def a_step(times, series):
    """Medians of what a sum in `series` grows by a step; `times`: ends of the steps. The first steps do not count."""
    values = np.interp(times, series[0], series[1])
    return float(np.median(np.diff(values)[FIRST_STEPS:]))


class Measured:
    """A case and what its run has left, a step: `cpu` processor seconds of each rank outside of MPI, `seconds` wall time, iterations; `memory`, MiB, of each rank; messages and sums of each rank."""

    def __init__(self, case, output):
        self.case, run = case, cases.run_of(output)
        self.record = run.record(case.name)
        folder = run.folder(case.name)
        self.counts = folder.parent / "counts"
        histories = run_files.of_each_capsule(folder, "history")
        self.is_there = self.record is not None and self.record["exit_code"] == 0 and len(of_each_rank(self.counts, "totals")) == case.ranks and bool(histories)
        if not self.is_there:
            return
        self.load = float((folder.parent / "load.txt").read_text())
        _, history = run_files.tables_of_capsules(folder, "history")[0]
        self.read_history(history)
        times = times_of_rows(history["wall_time"], histories[0].stat().st_mtime)
        self.totals = [read_totals(file) for file in of_each_rank(self.counts, "totals")]
        self.memory = [int(notes["memory, KiB"]) / 1024 for _, notes in self.totals]
        tables = [run_files.read_table(file)[0] for file in of_each_rank(self.counts, "series")]
        self.cpu, self.messages, self.bytes, self.sums, self.sum_bytes = (
            [a_step(times, (table["time"], table[name])) for table in tables] for name in ("cpu", "messages", "bytes", "sums", "sum_bytes"))

    def read_history(self, history):
        counted = slice(1 + FIRST_STEPS, None)
        self.steps = len(history["time"]) - 1
        self.seconds = float(np.median(np.diff(history["wall_time"])[FIRST_STEPS:]))
        self.newton, self.linear = (float(np.mean(history[f"{name}_iterations"][counted])) for name in ("newton", "linear"))
        self.all_linear, self.cells = float(np.sum(history["linear_iterations"][1:])), float(history["cells"][-1])

    @property
    def slowest(self):
        return max(self.cpu)

    @property
    def mean(self):
        return statistics.mean(self.cpu)


def by_group(places, is_message, in_solve):
    """{group: (calls, bytes)} of messages or of calls of all ranks, in linear solves of steps or anywhere in steps."""
    result = {name: [0, 0] for name in GROUPS}
    for place in places:
        if place.is_message == is_message and place.in_step and (place.in_solve or not in_solve):
            result[place.group][0] += place.calls
            result[place.group][1] += place.bytes
    return result


def largest(places, n):
    """[(kind, where, group, calls, bytes)] of the lines in linear solves that hand over most bytes in calls of all ranks, beside those with most calls."""
    sums = {}
    for place in places:
        if place.in_solve and place.in_step and not place.is_message:
            calls, bytes_ = sums.get((place.kind, place.where, place.group), (0, 0))
            sums[place.kind, place.where, place.group] = (calls + place.calls, bytes_ + place.bytes)
    rows = [(*key, *value) for key, value in sums.items()]
    kept = sorted(rows, key=lambda row: -row[4])[:n] + sorted(rows, key=lambda row: -row[3])[:n]
    return sorted(dict.fromkeys(kept), key=lambda row: (-row[4], -row[3]))
