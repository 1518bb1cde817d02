# SPDX-License-Identifier: LGPL-2.1-or-later
# Part of Tanktread: numbers of the runs with their error bars.
"""Numbers of a run (Result) as report_parts.Value: with error bar, and that of the reference solution.

Bars are those of the run's study (doc/theory.md, section 8.4): of the numbers of its summary, and of whole curves ("D_curve"), which hold for values at a given time.
Only for what the program has no bars of, the difference from the companion stands in.
"""

import math

import numpy as np

import run_files
from report_parts import Value


def value_at(series, column, time):
    """By a cubic through the four nearest rows; NaN without a series."""
    return run_files.interpolated(series["time"], series[column], time) if column in series else math.nan


def bar_of_curve(result, column, time):
    """Of theta/pi the curve's bar is weighted with D over its largest value."""
    bar = result.bars.get((f"{column}_curve", "target"), math.nan)
    return bar * np.nanmax(result.series["D"]) / value_at(result.series, "D", time) if column == "theta" else bar


def at(result, column, time, reference=math.nan):
    return Value(value_at(result.series, column, time), bar_of_curve(result, column, time), reference)


def last(result, column, reference=math.nan):
    return at(result, column, result.series["time"][-1], reference)


def limit(result, name, column, reference=math.nan):
    """The limit, with the bars of the stop and the target, or the last value of a run that has none."""
    value = result.number(f"{name}_limit")
    if math.isnan(value):
        return last(result, column, reference)
    return Value(value, sum(result.bars.get((f"{name}_limit", cause), math.nan) for cause in ("stop", "target")), reference)


def of_summary(result, name, reference=math.nan):
    return Value(result.number(name), result.bars.get((name, "target"), math.nan), reference)


def mean(result, column):
    """Over whole periods of D since the motion can be judged."""
    return of_summary(result, f"{column}_mean")


def span(result, column):
    """Largest less smallest value since the motion can be judged."""
    start = result.number("from")
    times = np.linspace(0 if math.isnan(start) else start, result.series["time"][-1], 4001)
    value, other = (float(np.ptp(value_at(series, column, times))) if series else math.nan for series in (result.series, result.companion))
    return Value(value, abs(value - other))


def area_change(result):
    """Largest relative change of the area, in per cent."""
    value, other = (100 * np.abs(series["area"] / series["area"][0] - 1).max() if series else math.nan for series in (result.series, result.companion))
    return Value(value, abs(value - other))


def whole_run(result, reference):
    """((bar of D, largest difference from the reference), (of theta/pi ...)) over the whole run, D relative to its largest value; NaN where there is none."""
    bar = lambda name: result.bars.get((f"{name}_curve", "target"), math.nan)  # noqa: E731
    errors = run_files.largest_differences(result.series, reference) if reference else (math.nan, math.nan)
    return list(zip((bar("D") / np.nanmax(result.series["D"]), bar("theta")), errors))
