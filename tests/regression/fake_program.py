#!/usr/bin/env python3
# SPDX-License-Identifier: LGPL-2.1-or-later
# Part of Tanktread: stands in for the program where scripts are tested.
"""Takes the program's command line, FILE.prm --set Section/Parameter=value ..., and leaves a folder like one of its own.

The scenes of benchmarks/flows get their reference solution, read off at other times, in the frame of the box, with D larger by the factor 1 + (4/side)^3;
those of benchmarks/suspensions capsules that turn back, or a relative viscosity of 1 + 2.5 times the volume fraction from time 3 on;
those of benchmarks/work_precision a capsule whose D and intrinsic viscosity are too large by a tenth of the square of the finest cell; the rest a capsule whose D goes to 0.3, wrong by a third of the target error; that of benchmarks/scaling what its counting library leaves too; with a study there is a companion of four times the target and its table.
"""

import math
import os
import pathlib
import sys

COLUMNS = ("time D_xz theta L B W volume volume_error area membrane_energy bending_energy dissipation newton_iterations linear_iterations wall_time "
           "alpha delta pressure_jump step cells theta_continuous S_xx S_yy S_zz S_xy S_xz S_yz intrinsic_viscosity N1 N2 x y z u_x u_y u_z").split()
SUSPENSION_COLUMNS = "time relative_viscosity N1 N2 smallest_gap wall_gap volume_fraction shared_cells".split()
REFERENCES = {"crossing_pair": "crossing_pair_Ca0.45", "planar_extension": "planar_extension_Ca0.1", "uniaxial_extension": "uniaxial_extension_Ca0.1",
              "parabola": "plane_poiseuille_Ca1_H5_z1.5", "wall": "wall_Ca0.3_d2"}


def write(file, names, rows):
    lines = [",".join(f"{row.get(name, 0):.9g}" for name in names) for row in rows]
    file.write_text("\n".join([",".join(names), *lines]) + "\n")


REFINED = ("sphere", "sphere_lambda5", "oblate", "biconcave")
PARAMETERS = "subsection Time\n  # Allowed: one of BDF2, backward\n  # Euler. Default: BDF2.\n  set Scheme = BDF2\nend\n"


def refined(cell, step, end):
    """Rows of a capsule whose errors are known."""
    for i in range(round(end / step) + 1):
        t, factor = i * step, 1 + 0.1 * cell**2
        D = 0.4 - 0.02 * t
        yield {"time": t, "D_xz": factor * D, "theta": 0.25 - 0.05 * t, "L": 1 + D, "B": 1 - D, "W": 1, "volume": 4.18, "area": 12.5, "step": step, "cells": 100, "newton_iterations": 2,
               "linear_iterations": 8, "alpha": 0.1 * t, "intrinsic_viscosity": factor * (2 + t)}


def end_of(prm):
    return next(float(line.split("=")[1]) for line in prm.read_text().splitlines() if "End time" in line)


def simple(target):
    """Rows of a capsule in shear."""
    for step in range(41):
        t = 0.25 * step
        D = 0.3 * (1 + target / 3) * (1 - math.exp(-t))
        yield {"time": t, "D_xz": D, "theta": 0.25 - 0.1 * D, "L": 1 + D, "B": 1 - D, "W": 1, "volume": 4.18, "area": 12.5 + D, "step": 0.25, "alpha": 0.1 * t,
               "delta": 0.1 * t, "intrinsic_viscosity": 2.5}


def from_reference(file, side, frame, end):
    """Rows at times that are not those of the file."""
    sys.path.insert(0, str(file.parents[1]))
    import numpy as np
    import run_files
    table, _ = run_files.read_table(file)
    times = np.array([0, *np.arange(0.03, end, 0.0997), end])
    row = {name: run_files.interpolated(table["t"], column, times) for name, column in table.items()}
    row.update(time=times, D_xz=row["D"] * (1 + (4 / side) ** 3), theta=row.get("theta_over_pi", 0 * times))
    if "wall" in file.name:
        row["z"] += 2 - side / 2
        frame += side / 2  # the wall at rest moves in the box
    if frame != 0:
        row.update(x=row["x"] - frame * times, u_x=row["u_x"] - frame)
    return [{name: column[i] for name, column in row.items()} for i in range(len(times))]


def circles(rows):
    """Cuts of a sphere at the first and the last row."""
    for row in (rows[0], rows[-1]):
        for k in range(24):
            yield {"time": row["time"], "x": row.get("x", 0) + math.cos(k * math.pi / 12), "z": row.get("z", 0) + math.sin(k * math.pi / 12)}


def several(folder, prm, settings):
    """Capsules of benchmarks/suspensions: each comes from its side and turns back at x = 1; the mean flow carries a hundredth of the stress with inertia."""
    number = int(settings.get("Capsule/Number", 2))
    end = float(settings.get("Scene/End time", end_of(prm)))
    rows = list(simple(0))
    for i, row in enumerate(rows):
        row["time"] = t = end * i / (len(rows) - 1)
        row.update(x=-math.hypot(1, t - 10), z=0.2 if i == 0 else 0.1 * (10 - t) / 10, u_x=0, u_z=0)
    for c in range(number):
        turned = [{**row, "x": -row["x"], "z": -row["z"]} if c % 2 else row for row in rows]
        write(folder / f"history_{c + 1}.csv", COLUMNS, turned)
    fraction = 4 * math.pi / 3 * number / float(settings["Scene/Box side"])**3 if "Capsule/Number" in settings else 0
    table = [{"time": row["time"], "relative_viscosity": 1 + 2.5 * round(fraction, 4) if row["time"] >= 3 else 9, "smallest_gap": 0.1, "wall_gap": 1, "volume_fraction": fraction,
              "momentum_flux_xz": 0.01} for row in rows]
    write(folder / "suspension.csv", [*SUSPENSION_COLUMNS, "momentum_flux_xz"], table)
    return rows


def study(folder, target):
    """The companion of a simple capsule, and what it says of the curves, and of the least value of D, which it has no error in."""
    companion = folder / "study/target-1"
    companion.mkdir(parents=True, exist_ok=True)
    write(companion / "history.csv", COLUMNS, list(simple(4 * target)))
    rows = {"D_curve": (0.3, 0.3 * target), "D_minimum": (0.2, 0), "theta_curve": (0.25, 0.03 * target)}
    (folder / "study.csv").write_text("quantity,cause,value,error,order,order is observed,extrapolated\n" +
                                      "".join(f"{name},target,{value:g},{error:g},1,0,nan\n" for name, (value, error) in rows.items()))


def counted(folder, capsules):
    """Histories of so many capsules and what benchmarks/scaling/count_mpi.c leaves: on FAKE_RANKS ranks a step takes each 0.1 s N/P + 0.01 s N of processor time, 10 messages of 100 bytes, 5 calls of 8 bytes."""
    ranks = int(os.environ.get("FAKE_RANKS", "1"))
    rows = [{"time": 0.05 * i, "wall_time": 1 + 0.3 * i, "newton_iterations": 2 * (i > 0), "linear_iterations": 8 * (i > 0), "cells": 1400 * capsules} for i in range(9)]
    names = ["history.csv"] if capsules == 1 else [f"history_{c + 1}.csv" for c in range(capsules)]
    for name in names:
        write(folder / name, COLUMNS, rows)
    start = (folder / names[0]).stat().st_mtime - rows[-1]["wall_time"]
    cpu = 0.1 * capsules / ranks + 0.01 * capsules
    for rank in range(ranks):
        counts = pathlib.Path(os.environ["TANKTREAD_COUNT_MPI"])
        (counts / f"totals_{rank}.csv").write_text(f"# ranks: {ranks}\n# memory, KiB: {1024 * (200 + 10 * capsules)}\nkind,calls,bytes,cpu_seconds\nIsend,80,8000,0.1\nAllreduce,40,320,0.2\n")
        lines = [f"{start + row['wall_time']:.6f},{cpu * i:.6f},{0.2 * i},{10 * i},{1000 * i},{5 * i},{40 * i}" for i, row in enumerate(rows)]
        (counts / f"series_{rank}.csv").write_text("\n".join(["time,cpu,waiting,messages,bytes,sums,sum_bytes", *lines]) + "\n")


def main():
    if sys.argv[1] in ("--print-parameters", "--version"):
        print(PARAMETERS if sys.argv[1] == "--print-parameters" else "Tanktread, a stand-in")
        return
    settings = dict(word.split("=", 1) for word in sys.argv[2:] if word != "--set")
    prm, folder = pathlib.Path(sys.argv[1]), pathlib.Path(settings["Output/Directory"])
    folder.mkdir(parents=True, exist_ok=True)
    if prm.stem == "scene":
        return counted(folder, 1 + settings["Capsule/Centres"].count(";"))
    if prm.stem in REFERENCES:
        file = prm.parents[1] / f"reference/{REFERENCES[prm.stem]}_prestress0.05.csv"
        end = end_of(prm)
        frame = float(settings.get("Scene/Frame velocity", "0").split(",")[0])
        rows = from_reference(file, float(settings["Scene/Box side"].split(",")[-1]), frame, end)
    elif prm.parent.name == "suspensions":
        rows = several(folder, prm, settings)
    elif prm.stem in REFINED and "Fluid mesh/Finest cell" in settings:
        rows = list(refined(float(settings["Fluid mesh/Finest cell"]), float(settings["Time/Step"]), end_of(prm)))
    else:
        rows = list(simple(float(settings.get("Accuracy/Target error", 0))))
    if prm.parent.name == "suspensions":
        pass  # written
    elif prm.stem == "crossing_pair":
        second = [{**row, **{name: -row.get(name, 0) for name in ("x", "y", "z", "u_x", "u_y", "u_z")}} for row in rows]
        for i, capsule in enumerate((rows, second)):
            write(folder / f"history_{i + 1}.csv", COLUMNS, capsule)
            write(folder / f"contours_{i + 1}.csv", ["time", "x", "z"], circles(capsule))
        write(folder / "suspension.csv", SUSPENSION_COLUMNS, [{**row, "smallest_gap": row["gap"], "relative_viscosity": 1.1} for row in rows])
    else:
        write(folder / "history.csv", COLUMNS, rows)
        write(folder / "contours.csv", ["time", "x", "z"], circles(rows))
    (folder / "summary.csv").write_text("quantity,value\noutcome,end time\nmode,steady\nfrom,0\n")
    if "target" in settings.get("Study/Vary", ""):
        study(folder, float(settings["Accuracy/Target error"]))
    (folder / "used_parameters.prm").write_text(prm.read_text())
    for i, row in enumerate(rows):
        print(i, f"{row['time']:g}", 0.1, 2, 10, f"{row['D_xz']:g}", 0.2, 0, 1)


if __name__ == "__main__":
    main()
