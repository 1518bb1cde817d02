#!/usr/bin/env python3
# SPDX-License-Identifier: LGPL-2.1-or-later
# Part of Tanktread: parameter and mesh files with accidents in them, and what the program says of them.
"""Usage: mutations.py --program PROGRAM {parameters,meshes} [--number N] [--seed S] [--keep FOLDER]

Each of N files is a good one with one to four accidents: characters or lines lost, doubled, moved or made up, numbers that are huge, negative, not finite or no numbers, a file cut off. PROGRAM --validate has
to end with exit code 0, or with 1 and a message that names the file (and, of parameters, a line or a parameter), within a time and an amount of memory, and leave no file behind. Files that do
otherwise are kept in FOLDER.
"""

import argparse
import concurrent.futures
import os
import pathlib
import random
import re
import resource
import shutil
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[2]
SECONDS, BYTES = 60, 6 << 30
NUMBERS = ["0", "-1", "1e308", "-1e308", "1e-308", "nan", "inf", "-inf", "99999999999999999999", "4294967296", "-2147483649", "1e400", "0x10", "1,5", "--3", "1e", "", "three", "2.0000001", "1000000"]
LETTERS = "abcxyz0189 \t=#;:,.-+/\\\"'%\x00\x07\x7f\u00e9\u03bb"


# ------------------------------------------------------------------------------------------------------------------------ accidents
def lose_letter(text, chance):
    at = chance.randrange(len(text) + 1)
    return text[:at] + text[at + chance.randrange(1, 4):]


def make_up_letters(text, chance):
    at = chance.randrange(len(text) + 1)
    return text[:at] + "".join(chance.choice(LETTERS) for _ in range(chance.randrange(1, 6))) + text[at:]


def on_lines(change):
    def accident(text, chance):
        lines = text.split("\n")
        change(lines, chance)
        return "\n".join(lines)
    return accident


def lose_line(lines, chance):
    del lines[chance.randrange(len(lines))]


def double_line(lines, chance):
    lines.insert(chance.randrange(len(lines) + 1), chance.choice(lines))


def swap_lines(lines, chance):
    i, j = chance.randrange(len(lines)), chance.randrange(len(lines))
    lines[i], lines[j] = lines[j], lines[i]


def long_line(lines, chance):
    i = chance.randrange(len(lines))
    lines[i] += lines[i] * chance.choice([3, 300, 30000])


def change_number(text, chance):
    words = text.split(" ")
    numbers = [i for i, word in enumerate(words) if word.strip(",;\n").replace(".", "", 1).replace("-", "", 1).replace("e", "", 1).isdigit()]
    if not numbers:
        return text
    i = chance.choice(numbers)
    words[i] = chance.choice(NUMBERS) + ("\n" if words[i].endswith("\n") else "")
    return " ".join(words)


def cut_off(text, chance):
    return text[:chance.randrange(len(text) + 1)]


ACCIDENTS = [lose_letter, make_up_letters, on_lines(lose_line), on_lines(double_line), on_lines(swap_lines), on_lines(long_line), change_number, change_number, change_number, cut_off]


def with_accidents(text, chance):
    for _ in range(chance.randrange(1, 5)):
        text = chance.choice(ACCIDENTS)(text, chance) if text else text
    return text


# ------------------------------------------------------------------------------------------------------------------------ files
def parameter_files():
    files = sorted([*ROOT.glob("prm/*.prm"), *ROOT.glob("tests/regression/*.prm"), *ROOT.glob("benchmarks/*/*.prm")])
    return [(file.name, file.read_text(encoding="utf-8")) for file in files]


def mesh_files():
    """The same mesh in each of the formats."""
    lines = [line for line in (ROOT / "tests/regression/data/ellipsoid.off").read_text().splitlines() if not line.startswith("#")]
    n, m = map(int, lines[1].split()[:2])
    points, faces = lines[2:2 + n], lines[2 + n:2 + n + m]
    obj = [f"v {point}" for point in points] + ["f " + " ".join(str(int(i) + 1) for i in face.split()[1:]) for face in faces]
    vtk = ["# vtk DataFile Version 3.0", "ellipsoid", "ASCII", "DATASET POLYDATA", f"POINTS {n} double", *points, f"POLYGONS {m} {4 * m}", *faces]
    return [("mesh.off", "\n".join(lines) + "\n"), ("mesh.obj", "\n".join(obj) + "\n"), ("mesh.vtk", "\n".join(vtk) + "\n")]


# ------------------------------------------------------------------------------------------------------------------------ runs
def limited():
    resource.setrlimit(resource.RLIMIT_AS, (BYTES, BYTES))
    resource.setrlimit(resource.RLIMIT_CORE, (0, 0))


def complaint(program, what, name, text, folder):
    """What the program did wrong with that text; empty if nothing."""
    file = folder / name
    file.write_text(text, encoding="utf-8")
    parameters = file
    if what == "meshes":
        parameters = folder / "case.prm"
        parameters.write_text(f"subsection Capsule\n  set Shape = file\n  set Mesh file = {name}\nend\n")
    before = sorted(folder.iterdir())
    try:
        run = subprocess.run([program, "--validate", parameters.name], cwd=folder, capture_output=True, timeout=SECONDS, preexec_fn=limited)
    except subprocess.TimeoutExpired:
        return f"no end within {SECONDS} s"
    said = run.stderr.decode(errors="replace")
    if run.returncode not in (0, 1):
        return f"exit code {run.returncode}: {said[-400:]}"
    if sorted(folder.iterdir()) != before:
        return "it left files behind"
    places = {"meshes": f"{re.escape(name)}|case\\.prm:\\d", "parameters": r"case\.prm:\d|\b[A-Z][A-Za-z0-9 ]*/[A-Z]"}
    if run.returncode == 1 and not re.search(places[what], said):
        return f"a message without a place: {said[-400:]}"
    return ""


def try_one(args, originals, number):
    chance = random.Random(f"{args.what} {args.seed} {number}")
    name, text = chance.choice(originals)
    text = with_accidents(text, chance)
    with tempfile.TemporaryDirectory(prefix="tanktread_mutations_") as temporary:
        folder = pathlib.Path(temporary)
        if args.what == "parameters":
            name = "case.prm"
        wrong = complaint(args.program, args.what, name, text, folder)
        if wrong and args.keep:
            shutil.copytree(folder, args.keep / f"{args.what}_{args.seed}_{number}", dirs_exist_ok=True)
    return wrong


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("what", choices=["parameters", "meshes"])
    parser.add_argument("--program", required=True, type=lambda name: str(pathlib.Path(name).resolve()))
    parser.add_argument("--number", type=int, default=500)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--jobs", type=int, default=len(os.sched_getaffinity(0)))
    parser.add_argument("--keep", type=pathlib.Path)
    args = parser.parse_args()
    originals = parameter_files() if args.what == "parameters" else mesh_files()
    with concurrent.futures.ThreadPoolExecutor(args.jobs) as pool:
        complaints = list(pool.map(lambda number: try_one(args, originals, number), range(args.number)))
    wrong = [(number, text) for number, text in enumerate(complaints) if text]
    for number, text in wrong:
        print(f"{args.what}, seed {args.seed}, number {number}: {text}")
    print(f"{args.number} {args.what}: {len(wrong)} treated wrongly")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
