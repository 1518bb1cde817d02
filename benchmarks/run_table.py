# SPDX-License-Identifier: LGPL-2.1-or-later
# Part of Tanktread: the table of a benchmark's runs, and what is made of it.
"""A table of runs is a CSV file that begins with notes, "# key: value". It is written to output/<benchmark>, a copy is kept beside the benchmark's script; chart and page are made of either."""

import csv

import run_files
import run_scenes


def write(file, columns, notes, rows):
    """rows: dictionaries of texts and numbers, in the form that they shall have in the file."""
    file.parent.mkdir(parents=True, exist_ok=True)
    with open(file, "w", newline="", encoding="utf-8") as stream:
        for key, value in notes.items():
            stream.write(f"# {key}: {value}\n")
        writer = csv.DictWriter(stream, columns, lineterminator="\n")
        writer.writeheader()
        writer.writerows(rows)


def read(file, numbers):
    """(notes, rows) of a table written by write(): the columns `numbers` as numbers, NaN where one is missing."""
    lines = file.read_text(encoding="utf-8").splitlines()
    notes = dict(line[2:].split(": ", 1) for line in lines if line.startswith("# "))
    rows = list(csv.DictReader(line for line in lines if not line.startswith("# ")))
    for row in rows:
        row.update({key: run_files.number(row[key]) for key in numbers})
    return notes, rows


def renew(args, here, file, numbers, measure, draw, page):
    """Measures the table `file`, or with --draw takes what is there; then its chart and page beside it, and with --doc those of the repository and the copy in `here`, the benchmark's folder.

    measure() writes the file; draw(notes, rows, figure) and page(notes, rows, link to the figure) are the benchmark's.
    """
    name, kept, doc = here.name, here / file.name, run_scenes.ROOT / "doc"
    if not args.draw:
        measure()
    notes, rows = read(file if file.is_file() else kept, numbers)
    targets = [(file.parent / f"{name}.md", file.parent / f"{name}.png", f"{name}.png")]
    if args.doc:
        targets.append((doc / f"{name}.md", doc / f"figures/{name}.png", f"figures/{name}.png"))
        if file.is_file():
            kept.write_bytes(file.read_bytes())
    for text, figure, link in targets:
        figure.parent.mkdir(parents=True, exist_ok=True)
        draw(notes, rows, figure)
        text.write_text(page(notes, rows, link), encoding="utf-8")
        print(text)
