# SPDX-License-Identifier: LGPL-2.1-or-later
# Part of Tanktread: Markdown of the reports.
"""Numbers, differences, tables, and the sections that a report consists of so far."""

import math
from typing import NamedTuple


def show(value, digits=5):
    return "–" if value is None or isinstance(value, float) and math.isnan(value) else f"{value:.{digits}g}"


def difference(value, reference, small=0.01):
    """"value (+0.12 %)", for references that are small "value (+0.0012)", or the value alone."""
    if math.isnan(value) or math.isnan(reference):
        return show(value)
    if abs(reference) < small:
        return f"{value:.5f} ({value - reference:+.5f})"
    return f"{value:.5g} ({round(100 * (value / reference - 1), 2) + 0.0:+.2f} %)"  # + 0.0: no "-0.00"


class Value(NamedTuple):
    """A number, what it may be wrong by, and what it should be; NaN where that is not known."""

    value: float
    bar: float = math.nan
    reference: float = math.nan

    @property
    def is_compared(self):
        return math.isfinite(self.value - self.reference) and math.isfinite(self.bar)

    @property
    def is_within_bar(self):
        return abs(self.value - self.reference) <= self.bar

    def __str__(self):
        """"0.38120 ± 0.00031 (+0.02 %)", with two digits of the bar; the bracket as in difference()."""
        if math.isnan(self.value) or math.isnan(self.bar):
            return difference(self.value, self.reference)
        decimals = min(6, max(0, 1 - math.floor(math.log10(self.bar)))) if self.bar > 0 else 6
        bracket = difference(self.value, self.reference).partition(" ")[2]
        return f"{self.value:.{decimals}f} ± {self.bar:.{decimals}f}" + (f" {bracket}" if bracket else "")


def table(head, rows):
    lines = ["| " + " | ".join(head) + " |", "|" + "---|" * len(head)]
    return "\n".join(lines + ["| " + " | ".join(map(str, row)) + " |" for row in rows]) + "\n"


def rows_of(section):
    """Cells of the tables of a section, heads and rules included."""
    return [line.strip("| ").split(" | ") for line in section.splitlines() if line.startswith("| ")]


def former_sections(file):
    """{heading line: section} of a report, {} if there is none."""
    text = file.read_text() if file.is_file() else ""
    parts = text.replace("\n## ", "\n\0## ").split("\0")[1:]
    return {part.split("\n", 1)[0] + "\n": part.rstrip("\n") + "\n" for part in parts}
