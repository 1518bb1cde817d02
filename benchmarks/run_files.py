# SPDX-License-Identifier: LGPL-2.1-or-later
# Part of Tanktread: reads what a run leaves in its folder, and the reference solutions.
"""Tables as {column: array}, parameters as {"Section/Parameter": text}, values between rows, and the reference solutions of a scene."""

import csv
import math
import pathlib
import re

import numpy as np

REFERENCE_FOLDER = pathlib.Path(__file__).resolve().parent / "reference"


# ---------------------------------------------------------------------------------------------------------------------- reading
def read_table(file):
    """Columns of a csv file with one header line as {name: array}, and its `# key: value` lines as {key: value}."""
    notes, lines = {}, []
    for line in file.read_text().splitlines():
        if line.startswith("#"):
            key, colon, value = line[1:].partition(":")
            if colon:
                notes[key.strip()] = value.strip()
        elif line.strip():
            lines.append(line)
    rows = list(csv.reader(lines, skipinitialspace=True))
    if not rows:
        return {}, notes
    names = [name.strip() for name in rows[0]]
    body = [row for row in rows[1:] if len(row) == len(names)]  # the last line of a killed run may be cut off
    columns = {name: np.array([number(row[i]) for row in body]) for i, name in enumerate(names)}
    return (columns if body else {}), notes


def number(text):
    try:
        return float(text)
    except ValueError:
        return math.nan


def read_parameters(file):
    """A deal.II parameter file as {"Section/Parameter": value}."""
    parameters, path = {}, []
    for line in file.read_text().splitlines():
        line = line.split("#")[0].strip()
        if line.startswith("subsection "):
            path.append(line[len("subsection "):].strip())
        elif line == "end" and path:
            path.pop()
        elif line.startswith("set ") and "=" in line:
            name, value = line[len("set "):].split("=", 1)
            parameters["/".join(path + [name.strip()])] = value.strip()
    return parameters


def of_each_capsule(folder, stem):
    """Files of the capsules of a run in their order: <stem>.csv of a single one, else <stem>_1.csv, <stem>_2.csv, ..."""
    numbered = [file for file in folder.glob(f"{stem}_*.csv") if file.stem[len(stem) + 1:].isdigit()]
    return sorted(numbered, key=lambda file: int(file.stem[len(stem) + 1:])) or [file for file in [folder / f"{stem}.csv"] if file.is_file()]


def tables_of_capsules(folder, stem):
    """[(where it is from, table)] of the capsules of a run in their order; one file of many capsules is taken apart by its column `capsule`."""
    found = []
    for file in of_each_capsule(folder, stem):
        table = read_table(file)[0]
        if "capsule" not in table:
            found.append((file.name, table))
            continue
        for capsule in sorted(set(table["capsule"][np.isfinite(table["capsule"])])):
            rows = table["capsule"] == capsule
            found.append((f"{file.name}, capsule {capsule:g}", {name: column[rows] for name, column in table.items() if name != "capsule"}))
    return found


def contours_by_time(table):
    """[(time, x, z)] of consecutive rows with one time, each polyline closed."""
    starts = np.flatnonzero(np.diff(table["time"], prepend=math.nan) != 0)
    parts = zip(np.split(table["time"], starts[1:]), np.split(table["x"], starts[1:]), np.split(table["z"], starts[1:]))
    return [(time[0], np.append(x, x[0]), np.append(z, z[0])) for time, x, z in parts]


# ---------------------------------------------------------------------------------------------------------------------- columns
def standard_columns(table):
    """The columns of a history or reference file under one set of names."""
    aliases = {"time": ("time", "t"), "D": ("D_xz", "D"), "theta": ("theta", "theta_over_pi")}
    renamed = {name: table[word] for name, words in aliases.items() for word in words if word in table}
    return {**renamed, **{name: table[name] for name in ("L", "B", "W", "x", "y", "z", "u_x", "u_y", "u_z") if name in table}}


def without_jumps(theta):
    """Angle/pi with a gap wherever it wraps from 1/2 to -1/2, so that no line is drawn across."""
    theta = np.array(theta)
    theta[1:][np.abs(np.diff(theta)) > 0.5] = math.nan
    return theta


def interpolated(times, values, wanted):
    """Values at the wanted times (a number or an array) by cubics through the four rows around each that are numbers; NaN outside the rows."""
    defined = np.isfinite(values)
    times, values, wanted = times[defined], values[defined], np.asarray(wanted, dtype=float)
    if len(times) < 4:
        return np.full(wanted.shape, math.nan) if wanted.ndim else math.nan
    first = np.clip(np.searchsorted(times, wanted) - 2, 0, len(times) - 4)
    t, v = (column[first[..., None] + np.arange(4)] for column in (times, values))
    weights = np.ones(t.shape)
    for a in range(4):
        for b in set(range(4)) - {a}:
            weights[..., a] *= (wanted - t[..., b]) / (t[..., a] - t[..., b])
    slack = 1e-9 * max(1, abs(times[-1]))
    result = np.where((wanted >= times[0] - slack) & (wanted <= times[-1] + slack), np.sum(weights * v, axis=-1), math.nan)
    return result if wanted.ndim else float(result)


def direction(D, theta):
    """D exp(2 i theta), theta in units of pi: smooth also where a section is round for a moment; 0 where it is round for longer."""
    return np.where(np.isfinite(theta), D * np.exp(2j * np.pi * np.nan_to_num(theta)), 0.)


def largest_differences(series, wanted):
    """(of D, of theta/pi) of one series at the times of another that both have: D relative to its largest value, theta weighted with D over that, since a round
    section has no direction. Columns as of standard_columns()."""
    rows = wanted["time"] <= series["time"][-1] * (1 + 1e-9)
    largest = np.nanmax(wanted["D"])
    truth = direction(wanted["D"][rows], wanted["theta"][rows])
    found = interpolated(series["time"], direction(series["D"], series["theta"]), wanted["time"][rows])
    turn = np.angle(found * np.conj(truth)) / (2 * np.pi)
    return np.max(np.abs(np.abs(found) - np.abs(truth))) / largest, np.max(np.abs(turn) * np.abs(truth)) / largest


# ------------------------------------------------------------------------------------------------------------------- references
SCENE = {  # key in a reference file: (parameter of a run, its value where the run's file does not say, value where the reference does not say: None: any)
    "flow": ("Scene/Flow", "shear", None),
    "G": ("Scene/Shear number G", "0.05", None),
    "khat": ("Scene/Reduced bending modulus", "0", None),
    "scale modulus": ("Scene/Scale modulus", "Young", "Young"),
    "viscosity ratio": ("Scene/Viscosity ratio", "1", "1"),
    "Reynolds number": ("Scene/Reynolds number", "0", "0"),
    "oscillation frequency": ("Scene/Oscillation frequency", "0", "0"),
    "channel half width": ("Scene/Channel half width", "0", None),
    "shape": ("Capsule/Shape", "sphere", None),
    "axes": ("Capsule/Axes", "2, 2, 1", None),
    "aspect ratio": ("Capsule/Aspect ratio", "0.6", None),
    "inclination": ("Capsule/Inclination", "0", None),
    "centres": ("Capsule/Centres", "0, 0, 0", "0, 0, 0"),
    "prestress": ("Capsule/Prestress", "0", "0"),
    "thickness": ("Capsule/Thickness", "0", "0"),
    "membrane law": ("Capsule/Membrane law", "neo-Hookean", None),
    "bending form": ("Capsule/Bending form", "variational", None),
    "reference curvature": ("Capsule/Reference curvature", "flat", None),
}


def agree(wanted, found, up_to_a_factor=False):
    """Whether two parameter texts mean the same: word by word, numbers to 1e-4, lists of axes up to a factor."""
    a, b = ([number(word) for word in re.split(r"[\s,;:]+", text.strip())] for text in (wanted, found))
    if any(map(math.isnan, a + b)):
        return wanted.lower() == found.lower()
    if up_to_a_factor:
        a, b = ([value / max(values) for value in values] for values in (a, b))
    return len(a) == len(b) and np.allclose(a, b, rtol=1e-4, atol=1e-12)


def matches(notes, parameters):
    """Whether a reference file's notes describe the run's scene."""
    if "flow" not in notes or any(name.startswith("Capsule ") for name in parameters):
        return False  # further kinds of capsules are in no reference
    khat = number(notes.get("khat", "nan"))
    for key, (parameter, default, unsaid) in SCENE.items():
        wanted = notes.get(key, unsaid)
        if wanted in (None, "none"):
            continue
        if key in ("bending form", "reference curvature") and khat == 0:
            continue
        if key in ("khat", "scale modulus") and math.isnan(khat):  # relaxation: any modulus, the caller says what that means
            continue
        if not agree(wanted, parameters.get(parameter, default), key == "axes"):
            return False
    return True


def find_references(parameters):
    """Files of benchmarks/reference for the run's scene."""
    return [file for file in sorted(REFERENCE_FOLDER.glob("*.csv")) if matches(read_table(file)[1], parameters)]
