# SPDX-License-Identifier: LGPL-2.1-or-later
# Part of Tanktread: numbers of the runs with their error bars.
"""Numbers of a run (Result) as report_parts.Value: with error bar, and that of the reference solution.

The bar of a target is the difference from the companion of four times the target (doc/theory.md, (52c): r = 4, p = 1, three times |q - q0|). The program gives
it for the numbers of its summary; here it is taken in the same way for what is read off the series: values at a time, means, differences over a whole run.
"""

import math

import numpy as np

import run_files
from report_parts import Value


def value_at(series, column, time):
    """By a cubic through the four nearest rows; NaN without a series."""
    return run_files.interpolated(series["time"], series[column], time) if column in series else math.nan


def at(result, column, time, reference=math.nan):
    value = value_at(result.series, column, time)
    return Value(value, abs(value - value_at(result.companion, column, time)), reference)


def last(result, column, reference=math.nan):
    """Run and companion end at the same time."""
    return at(result, column, result.series["time"][-1], reference)


def limit(result, name, column, reference=math.nan):
    """The limit, or the last value of a run that has none. Where only the companion has none, last values tell the bar of the target."""
    value, end = result.number(f"{name}_limit"), last(result, column, reference)
    if math.isnan(value):
        return end
    stop, target = (result.bars.get((f"{name}_limit", cause), math.nan) for cause in ("stop", "target"))
    return Value(value, stop + (end.bar if math.isnan(target) else target), reference)


def of_summary(result, name, reference=math.nan):
    return Value(result.number(name), result.bars.get((name, "target"), math.nan), reference)


def whole_periods(result):
    """Start and end of as many periods of D as there are since the motion can be judged, or of what there is."""
    start, end, period = result.number("from"), result.series["time"][-1], result.number("D_period")
    start = 0 if math.isnan(start) else start
    return (start, start + period * math.floor((end - start) / period)) if period <= end - start else (start, end)


def mean(result, column):
    """Over whole periods, by cubics, since the steps differ in length."""
    times = np.linspace(*whole_periods(result), 4001)
    value, other = (float(np.nanmean(value_at(series, column, times))) if series else math.nan for series in (result.series, result.companion))
    return Value(value, abs(value - other))


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


def largest_differences(result, reference):
    """((of D from the companion, from the reference), (of theta/pi ...)) over the whole run, as run_files.largest_differences(); NaN where there is none."""
    bars, errors = (run_files.largest_differences(result.series, wanted) if wanted else (math.nan, math.nan) for wanted in (result.companion, reference))
    return list(zip(bars, errors))
