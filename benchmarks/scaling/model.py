# SPDX-License-Identifier: LGPL-2.1-or-later
# Part of Tanktread: an estimate of the time of a step on many ranks, from what few ranks have been measured to do.
"""Linear laws, fitted to the cases by least squares with coefficients that are not negative, and the time of a step that they give.

With N capsules on P ranks, a step and rank:
    work       a N/P (divided) + b N (what every rank does for all capsules) + c       processor seconds outside of MPI
    memory     the same                                                                MiB
    messages   m (P - 1) while there are few ranks, no more than those to 26 neighbours
    bytes      of messages: k (N/P)^(2/3), the surface of a rank's part
    sums       s + t N + q min(P, N) calls of all ranks: some are made for each capsule, some by each rank with capsules
    sum bytes  u N + v
A message takes latency + bytes / bandwidth, a call of all ranks log2(P) latencies and twice its bytes / bandwidth.

All but memory is fitted a linear iteration, so that more iterations are not taken for work that is not divided, and told for as many as the largest scene takes. Divided work is fitted to cells, which
a capsule has more of in some scenes than in others."""

import dataclasses
import itertools
import math

import numpy as np

LATENCY, BANDWIDTH = 2e-6, 1e9  # seconds; bytes/s of a rank: a network of 25 GB/s a node, shared by some two dozen ranks
NEIGHBOURS = 26


def fit(columns, values):
    """Coefficients >= 0 that leave the least sum of squares of relative errors, by trying all sets of columns; zeros where there are fewer values than two."""
    columns, values = np.asarray(columns, dtype=float), np.asarray(values, dtype=float)
    n, best, least = columns.shape[1], np.zeros(columns.shape[1]), math.inf
    weighted = columns / values[:, None]
    for size in range(1, min(n, len(values)) + 1):
        for kept in itertools.combinations(range(n), size):
            found, *_ = np.linalg.lstsq(weighted[:, kept], np.ones(len(values)), rcond=None)
            error = np.sum((weighted[:, kept] @ found - 1) ** 2)
            if (found >= 0).all() and error < least - 1e-12:  # more columns only where they say more
                least, best = error, np.zeros(n)
                best[list(kept)] = found
    return best


@dataclasses.dataclass
class Model:
    """Coefficients, in the order of the module's text; `iterations`: linear ones a step; `error`: largest relative error of the work in the cases that it was fitted to."""
    work: np.ndarray
    memory: np.ndarray
    a_neighbour: float
    surface: float
    sums: np.ndarray
    sum_bytes: np.ndarray
    iterations: float
    error: float

    def parts(self, capsules, ranks, latency=LATENCY, bandwidth=BANDWIDTH):
        """{part: seconds of a step}"""
        a, b, c = self.work
        log = math.log2(ranks) if ranks > 1 else 0
        messages, sums = self.a_neighbour * min(ranks - 1, NEIGHBOURS), self.sums @ numbers_of_sums(capsules, ranks) * (ranks > 1)
        return {"divided work": a * capsules / ranks, "work of all ranks": b * capsules + c, "messages, latency": messages * latency,
                "messages, bytes": self.surface * (capsules / ranks) ** (2 / 3) / bandwidth * (ranks > 1), "sums, latency": sums * latency * log,
                "sums, bytes": 2 * (self.sum_bytes[0] * capsules + self.sum_bytes[1]) / bandwidth * (ranks > 1)}

    def crossing_of_work(self):
        """Ranks on which a N/P = b N."""
        return self.work[0] / self.work[1] if self.work[1] > 0 else math.inf

    def crossing_of_bytes(self, bandwidth=BANDWIDTH):
        """Ranks on which the bytes of the calls of all ranks take a N/P."""
        return self.work[0] * bandwidth / (2 * self.sum_bytes[0]) if self.sum_bytes[0] > 0 else math.inf

    def crossing_of_latency(self, latency=LATENCY):
        """Ranks on which the calls that are made for each capsule take a N/P: P log2(P) = a / (t latency)."""
        if self.sums[1] <= 0:
            return math.inf
        low, high = 1., 1e12
        for _ in range(100):
            middle = math.sqrt(low * high)
            low, high = (middle, high) if middle * math.log2(middle) < self.work[0] / (self.sums[1] * latency) else (low, middle)
        return low

    def memory_of(self, capsules, ranks):
        """MiB of a rank."""
        return float(self.memory @ shares(capsules, ranks))


def shares(capsules, ranks):
    return np.array([capsules / ranks, capsules, 1.])


def numbers_of_sums(capsules, ranks):
    return np.array([1., capsules, min(capsules, ranks)])


def of_rows(rows, fraction, cores=math.inf):
    """The model of the cases, for that volume fraction; None where there are too few. Work is that of cases with no more ranks than cores: ranks that take turns on a core spoil each other's caches."""
    rows = [row for row in rows if row["state"] == "done"]
    timed, alike = [row for row in rows if not row["places"] and row["ranks"] <= cores], [row for row in rows if abs(row["fraction"] - fraction) < 1e-9]
    several = [row for row in alike if row["ranks"] > 1]
    if len(timed) < 4 or len({row["ranks"] for row in timed}) < 2 or len(several) < 2:
        return None
    largest, most = max(alike, key=lambda row: (row["capsules"], -row["places"])), max(row["ranks"] for row in several)
    iterations, cells = largest["linear"], largest["cells"] / largest["capsules"]

    def law(columns, chosen, name):
        return fit([row["linear"] * np.asarray(columns(row)) for row in chosen], [row[name] for row in chosen]) * iterations

    def work_columns(row):
        return shares(row["cells"] / cells, row["ranks"]) * [1, 0, 0] + shares(row["capsules"], row["ranks"]) * [0, 1, 1]

    work = law(work_columns, timed, "cpu_slowest")
    errors = [abs(row["linear"] / iterations * work_columns(row) @ work / row["cpu_slowest"] - 1) for row in timed]
    return Model(work, fit([shares(row["capsules"], row["ranks"]) for row in alike], [row["memory_largest"] for row in alike]),
                 max(row["messages"] / row["linear"] * iterations / min(row["ranks"] - 1, NEIGHBOURS) for row in several if row["ranks"] == most),
                 float(np.median([row["bytes"] / row["linear"] * iterations / (row["capsules"] / row["ranks"]) ** (2 / 3) for row in several])),
                 law(lambda row: numbers_of_sums(row["capsules"], row["ranks"]), several, "sums"), law(lambda row: (row["capsules"], 1.), several, "sum_bytes"), iterations, max(errors))


def limit(parts):
    """The largest part beside the divided work."""
    return max((name for name in parts if name != "divided work"), key=parts.get)
