# SPDX-License-Identifier: LGPL-2.1-or-later
# Part of Tanktread: the rule of doc/theory.md, section 8.2, for series that other programs have computed.
"""Motion mode, period and extremes of D of a reference solution, judged as the program judges its own runs (source/simulation/motion.cc)."""

import math

import numpy as np


def extrema(times, D):
    """Maxima and minima by turns as (time, value), each a fifth of the range away from the last, refined by parabolas."""
    least = 0.2 * np.ptp(D)
    maxima, minima, high, low, sought = [], [], 0, 0, 0
    for i, value in enumerate(D):
        high, low = (i if value > D[high] else high), (i if value < D[low] else low)
        if sought >= 0 and value < D[high] - least:
            if high > 0:
                maxima.append(refined(times, D, high))
            sought, low = -1, i
        elif sought <= 0 and value > D[low] + least:
            if low > 0:
                minima.append(refined(times, D, low))
            sought, high = 1, i
    return maxima, minima


def refined(times, D, i):
    a, b, c = np.polyfit(times[i - 1:i + 2] - times[i], D[i - 1:i + 2], 2)
    return (times[i], D[i]) if a == 0 else (times[i] - b / (2 * a), c - b * b / (4 * a))


def phase_angle(theta, alpha):
    """alpha - theta from its start, continuous, in units of pi."""
    difference = np.unwrap(alpha, period=2) - np.unwrap(theta, period=1)
    return difference - difference[0]


def summary(times, D, theta, alpha):
    """{mode, D_minimum, D_maximum, D_period, ...}; angles in units of pi, as they come, jumps included."""
    theta, alpha = np.unwrap(theta, period=1), np.unwrap(alpha, period=2)
    delta = alpha - theta
    turned = np.flatnonzero(np.abs(alpha - alpha[0]) >= 1)
    result = {"mode": "undetermined", "D_maxima": [], "D_minimum": math.nan, "D_maximum": math.nan, "D_period": math.nan, "theta_minimum": math.nan, "theta_maximum": math.nan}
    if not len(turned):
        return result
    after = slice(turned[0], None)
    shape, material = np.ptp(theta[after]) >= 1, np.ptp(delta[after]) >= 1
    result["mode"] = "transition" if shape and material else "tumbling" if shape else "swinging" if material else "undetermined"
    result["theta_minimum"], result["theta_maximum"] = theta[after].min(), theta[after].max()
    maxima, minima = extrema(times[after], D[after])
    if minima:
        result["D_minimum"] = minima[-1][1]
    result["D_maxima"] = [value for _, value in maxima]
    if maxima:
        result["D_maximum"] = maxima[-1][1]
    if len(maxima) > 1:
        result["D_period"] = (maxima[-1][0] - maxima[0][0]) / (len(maxima) - 1)
    return result
