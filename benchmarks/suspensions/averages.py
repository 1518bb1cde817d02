# SPDX-License-Identifier: LGPL-2.1-or-later
# Part of Tanktread: averages over time with error bars.
"""Means over a stretch of time and over blocks of it: what a fluctuating series is worth, and how well that is known."""

import math

import numpy as np

START = 4  # strains after which shapes have grown; those of capsules with Ca = 0.1 follow the flow within one
N_BLOCKS = 4


def time_mean(times, values, begin, end):
    """Mean of the polyline through the rows over [begin, end], which must lie within them."""
    inner = (times > begin) & (times < end)
    t = np.concatenate([[begin], times[inner], [end]])
    v = np.concatenate([[np.interp(begin, times, values)], values[inner], [np.interp(end, times, values)]])
    return float(np.sum((v[1:] + v[:-1]) * np.diff(t)) / 2 / (end - begin))


def block_average(times, values, begin=START, n_blocks=N_BLOCKS):
    """(mean, standard error, means of the blocks) of a series from `begin` to its end, divided into blocks of equal length.

    The error is the standard deviation of the blocks' means over the root of their number: right if blocks are longer than what a series remembers, too small
    otherwise. All is nan where less than one unit of time is left."""
    times, values = np.asarray(times, dtype=float), np.asarray(values, dtype=float)
    defined = np.isfinite(values)
    times, values = times[defined], values[defined]
    if len(times) < 2 or times[-1] - begin < 1 or times[0] > begin:
        return math.nan, math.nan, np.full(n_blocks, math.nan)
    edges = np.linspace(begin, times[-1], n_blocks + 1)
    blocks = np.array([time_mean(times, values, *pair) for pair in zip(edges[:-1], edges[1:])])
    return float(blocks.mean()), float(blocks.std(ddof=1) / math.sqrt(n_blocks)), blocks


def over_runs(means):
    """(mean, standard error) of the means of independent runs, of which there are two or more; the error is nan of one."""
    means = np.asarray(means, dtype=float)
    return float(means.mean()), float(means.std(ddof=1) / math.sqrt(len(means))) if len(means) > 1 else math.nan


def mean_of_capsules(histories, name):
    """(times, mean over the capsules) of a column, in the rows that all have. Of `theta` the mean direction, each capsule alike."""
    rows = min(len(history["time"]) for history in histories)
    columns = np.array([history[name][:rows] for history in histories])
    if name == "theta":  # in units of pi, without a head: twice the angle is a direction
        mean = np.angle(np.exp(2j * math.pi * columns).mean(axis=0)) / (2 * math.pi)
    else:
        mean = columns.mean(axis=0)
    return histories[0]["time"][:rows], mean
