# SPDX-License-Identifier: LGPL-2.1-or-later
# Part of Tanktread: the table of all cases.
"""points.csv, a row a case; places.csv, the lines that send most."""

import datetime
import os
import pathlib
import re
import statistics
import sys

import cases
import counts
import run_scenes
import run_table

OF_GROUPS = [f"{group}_{what}" for group in counts.GROUPS for what in ("messages", "message_bytes", "sums", "sum_bytes")]
NUMBERS = ["places", "capsules", "ranks", "fraction", "steps", "cells", "newton", "linear", "seconds", "cpu_slowest", "cpu_mean", "memory_largest", "memory_mean", "messages", "bytes", "sums", "sum_bytes",
           "load", *OF_GROUPS, *(f"{name}_in_step" for name in OF_GROUPS)]
COLUMNS = ["case", "series", *NUMBERS, "state"]
PLACE_NUMBERS = ["capsules", "ranks", "calls", "bytes"]
PLACE_COLUMNS = ["capsules", "ranks", "kind", "where", "group", "calls", "bytes"]


def of_places(measured, program):
    """(columns of groups, rows of places.csv) of the first rank: an iteration's, and a step's in columns *_in_step. The starting solve is in neither."""
    places = counts.read_places(measured.counts / "places_0.csv", program)
    if not any(place.in_solve for place in places):
        sys.exit(f"{measured.case.name}: no call from a linear solve: {program} has no names of functions (addr2line, -g1), or counts.LINEAR_SOLVE is out of date")
    columns = {}
    for suffix, in_solve, number in (("", True, measured.all_linear), ("_in_step", False, measured.steps)):
        for what, is_message in (("message", True), ("sum", False)):
            for group, (calls, bytes_) in counts.by_group(places, is_message, in_solve).items():
                columns[f"{group}_{what}s{suffix}"], columns[f"{group}_{what}_bytes{suffix}"] = f"{calls / number:.6g}", f"{bytes_ / number:.6g}"
    rows = [dict(zip(PLACE_COLUMNS, (measured.case.capsules, measured.case.ranks, kind, where, group, f"{calls / measured.all_linear:.4g}", f"{bytes_ / measured.all_linear:.6g}")))
            for kind, where, group, calls, bytes_ in counts.largest(places, 6)]
    return columns, rows


def row_of(case, names, measured, program):
    """(row of points.csv, rows of places.csv)"""
    row = {"case": case.name, "series": " ".join(names), "places": int(case.places), "capsules": case.capsules, "ranks": case.ranks, "fraction": case.fraction, "steps": case.steps}
    if not measured.is_there:
        return {**row, "state": "not run" if measured.record is None else measured.record["message"] or f"exit code {measured.record['exit_code']}"}, []
    figures = {"cells": measured.cells, "newton": measured.newton, "linear": measured.linear, "seconds": measured.seconds, "cpu_slowest": measured.slowest, "cpu_mean": measured.mean,
               "memory_largest": max(measured.memory), "memory_mean": statistics.mean(measured.memory), "load": measured.load}
    figures |= {name: statistics.mean(getattr(measured, name)) for name in ("messages", "bytes", "sums", "sum_bytes")}
    columns, places = of_places(measured, program) if case.places else ({}, [])
    return {**row, **{name: f"{value:.6g}" for name, value in figures.items()}, **columns, "state": "done"}, places


def revisions(args, names):
    """Of the program, as the logs of the runs have it; more than one where some runs are older."""
    logs = [cases.run_of(args.output).folder(case.name) / "log.txt" for case in names]
    found = [re.search(r"revision ([^,)\s]+)", log.read_text()) for log in logs if log.is_file()]
    return ", ".join(sorted({match.group(1) for match in found if match})) or "unknown"


def write(args, series):
    """Both tables, of all cases that have been tried."""
    names = {}
    for name, wanted in series.items():
        for case in wanted:
            names.setdefault(case, []).append(name)
    rows, all_places = [], []
    for case, of_case in names.items():
        measured = counts.Measured(case, args.output)
        if case.places and measured.is_there and not cases.is_of(args, case):
            continue  # its addresses mean nothing any more
        row, places = row_of(case, of_case, measured, args.program)
        if row["state"] != "not run":
            rows.append(row)
            all_places += places
    notes = {"date": datetime.date.today().isoformat(), "revision": revisions(args, names), "machine": run_scenes.processor(), "mode": "full" if args.full else "quick", "fraction": f"{args.fraction:g}",
             "cores": len(os.sched_getaffinity(0))}
    run_table.write(args.output / "points.csv", COLUMNS, notes, rows)
    run_table.write(args.output / "places.csv", PLACE_COLUMNS, {}, all_places)


def kept(args, name):
    """The table of this name in the output, or else that of the repository."""
    here = pathlib.Path(__file__).resolve().parent
    return args.output / name if (args.output / name).is_file() else here / name
