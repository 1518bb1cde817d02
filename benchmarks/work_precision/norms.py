# SPDX-License-Identifier: LGPL-2.1-or-later
# Part of Tanktread: errors of a series in time, the best of several runs, powers. Nothing here knows files or scenes.
"""A curve is {"time": array, quantity: array}; quantities are "D", "theta" (in units of pi, continuous) and "viscosity"."""

import math

import numpy as np

from run_files import interpolated

QUANTITIES = ("D", "theta", "viscosity")


def continuous(theta):
    """Angle/pi without the jumps of a line that turns by half a turn; what is not a number stays."""
    theta = np.array(theta, dtype=float)
    defined = np.isfinite(theta)
    theta[defined] = np.unwrap(theta[defined], period=1)
    return theta


def until(curve, end):
    """The rows until a time."""
    kept = curve["time"] <= end + 1e-9
    return {name: column[kept] for name, column in curve.items()}


def scale(curve, quantity):
    """What errors are divided by: the largest value; of theta, which passes zero, 1/4: the axis of the undisturbed strain."""
    return 0.25 if quantity == "theta" else np.nanmax(np.abs(curve[quantity]))


def differences(curve, other, quantity, dense=False):
    """(times, curve - other) while both last and `other` is defined, at the rows of the one that has fewer of them, the other one being read off by cubics; at those of `curve`
    if the rows of `other` are dense enough for that anywhere."""
    end = min(curve["time"][-1], other["time"][-1])
    few, others = until(curve, end), until(other, end)
    few, many = (few, other) if dense or len(few["time"]) <= len(others["time"]) else (others, curve)
    times = few["time"]
    values, wanted = few[quantity], interpolated(many["time"], many[quantity], times)  # by all of its rows: the run may end between two of them
    values, wanted = (values, wanted) if many is other else (wanted, values)
    result = values - wanted
    if quantity == "theta":
        result = result - np.round(result)
    first = other["time"][np.isfinite(other[quantity])][0]  # the angle of a sphere is not defined at the start
    counted = (times > first + 1e-9) | ((times > first - 1e-9) & np.isfinite(values))
    return times[counted], result[counted]


def largest(curve, other, quantity, dense=False):
    """Largest difference over all times, over the scale of `other`; infinite when the curve has gaps."""
    result = np.abs(differences(curve, other, quantity, dense)[1])
    return math.inf if not len(result) or np.isnan(result).any() else float(result.max() / scale(other, quantity))


def extrapolated(fine, coarse, order=2, ratio=2):
    """Curve at the coarse one's times, where errors are of this order in everything that is coarser by the ratio."""
    times = until(coarse, fine["time"][-1])["time"]
    result = {"time": times}
    for quantity in QUANTITIES:
        a, b = (interpolated(curve["time"], curve[quantity], times) for curve in (fine, coarse))
        step = a - b
        if quantity == "theta":
            step = step - np.round(step)
        result[quantity] = a + step / (ratio**order - 1)
    return result


def power(x, y):
    """Exponent of y ~ x^p by least squares in logarithms; NaN for fewer than two different x or what has no logarithm."""
    x, y = np.asarray(x, dtype=float), np.asarray(y, dtype=float)
    used = np.isfinite(x) & np.isfinite(y) & (x > 0) & (y > 0)
    if len(np.unique(x[used])) < 2:
        return math.nan
    return float(np.polyfit(np.log(x[used]), np.log(y[used]), 1)[0])


def pareto(costs, errors):
    """Indices of the points that no other point beats in cost and error, by cost."""
    best, front = math.inf, []
    for i in sorted(range(len(costs)), key=lambda k: (costs[k], errors[k])):
        if math.isfinite(costs[i]) and errors[i] < best:
            best = errors[i]
            front.append(i)
    return front


def guarded(sequences):
    """{run: error} of sequences [(run, error), ...] from coarse to fine: its error, or that of the next finer run if that is larger: then errors of different sign have cancelled."""
    result = {}
    for sequence in sequences:
        for i, (run, error) in enumerate(sequence):
            following = sequence[i + 1][1] if i + 1 < len(sequence) else 0
            result[run] = max(result.get(run, 0), error, following)
    return result


def cheapest(costs, errors, bound):
    """Index of the cheapest point with an error up to the bound, or None."""
    within = [i for i in range(len(costs)) if errors[i] <= bound]
    return min(within, key=lambda i: costs[i]) if within else None


def period(curve, extrema):
    """Time from the last maximum but one of D to the last; NaN if there are not two. `extrema` is that of benchmarks/le_2010/motion.py; rows of any step are read off every 0.05."""
    times = np.arange(0, curve["time"][-1] + 1e-9, 0.05)
    maxima, _ = extrema(times, interpolated(curve["time"], curve["D"], times))
    return maxima[-1][0] - maxima[-2][0] if len(maxima) > 1 else math.nan
