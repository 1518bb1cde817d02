# SPDX-License-Identifier: LGPL-2.1-or-later
# Part of Tanktread: the page of scaling.
"""Tables of the series, and of the model."""

import math

import cases
import counts
import model
import points
import run_table
from report_parts import show, table

A_RANK, RANKS_OF_MODEL = 8, [16, 64, 256, 1024, 4096]
STRONG = 4096  # capsules in the model of one scene on more and more ranks

INTRODUCTION = """# Scaling

How the time of a step, messages and memory grow with capsules and ranks. Made by

    benchmarks/scaling/run.py [--full] [--ranks 1,2,4] --update-doc

Neo-Hookean spheres with bending in shear (G = 0.2, κ̂ = 0.04) between two walls, periodic along the flow and across it, of 162 control points, enriched interface, one viscosity, steps of 0.05/γ̇ by BDF2. Each
capsule brings a cube of liquid of its own, so that the box grows with them; the volume fraction is {percent:g} %, the finest cells are a twelfth of the cube's side, 10a/{fine:.3g} (in the denser scene 10a/{dense:.3g}).
Capsules lie on a lattice of those cubes, each moved a little out of the middle.

{machine}

- **CPU s**: processor seconds of a rank outside of MPI, so that neither waiting for others nor neighbours that take turns on a core count; the median of the steps after the first two. The slowest rank counts. What
  neighbours do to caches and clock stays in them, and polling by `MPI_Test` and `MPI_Iprobe`, which only new meshes do.
- **Wall s** says little on a machine that does something else besides, and nothing with more ranks than cores.
- **Efficiency of the work** is that of CPU s alone: what would be left with messages that cost nothing.

What is computed does not depend on the number of ranks: histories of four capsules, two of them across a periodic face, agree to 10⁻⁹ on 1 to 8 ranks, and where ranks have no cells (tests `run/ranks_agree_*`).
"""


# ------------------------------------------------------------------------------------------------------------------------ choosing
def cases_of(rows, name, **wanted):
    """Cases of a series that have been done, by capsules and ranks."""
    chosen = [row for row in rows if name in row["series"].split() and row["state"] == "done" and all(row[key] == value for key, value in wanted.items())]
    return sorted(chosen, key=lambda row: (row["capsules"], row["ranks"]))


def strong_scenes(rows):
    """[[rows of one scene]]"""
    chosen = cases_of(rows, "strong")
    return [cases_of(rows, "strong", capsules=n) for n in sorted({row["capsules"] for row in chosen}, reverse=True)]


def efficiency(rows):
    """Of the work: against the first row, per capsule and rank."""
    first = rows[0]
    return [first["cpu_slowest"] * first["ranks"] / first["capsules"] / (row["cpu_slowest"] * row["ranks"] / row["capsules"]) for row in rows]


def efficiencies(rows):
    """[(label, rows, efficiency)] of the weak series and of each strong scene, those with more than one row."""
    series = [(f"{show(weak[0]['capsules'] / weak[0]['ranks'])} capsules a rank", weak) for weak in [cases_of(rows, "weak")] if weak]
    series += [(f"{scene[0]['capsules']:g} capsule{'s' if scene[0]['capsules'] > 1 else ''}", scene) for scene in strong_scenes(rows)]
    return [(label, chosen, efficiency(chosen)) for label, chosen in series if len(chosen) > 1]


def per_cent(value):
    return "–" if math.isnan(value) else f"{100 * value:.0f} %"


def wall(row, cores):
    return show(row["seconds"], 3) if row["ranks"] <= cores else "–"


# ------------------------------------------------------------------------------------------------------------------------ sections
def of_proportion(rows):
    chosen = cases_of(rows, "proportion")
    if not chosen:
        return ""
    first = chosen[0]["cpu_slowest"] / chosen[0]["capsules"]
    body = [[f"{row['capsules']:g}", f"{row['cells']:.0f}", show(row["cpu_slowest"], 3), show(row["cpu_slowest"] / row["capsules"], 3), f"{row['cpu_slowest'] / row['capsules'] / first:.2f}",
             f"{row['newton']:.1f}, {row['linear']:.1f}", f"{1e3 * row['cpu_slowest'] / row['capsules'] / row['linear']:.2g}", f"{row['memory_largest']:.0f}", f"{row['memory_largest'] / row['capsules']:.0f}"] for row in chosen]
    head = ["capsules", "cells", "CPU s a step", "a capsule", "over the first", "Newton, linear iterations a step", "CPU ms an iteration and capsule", "peak memory, MiB", "a capsule"]
    return ("## Capsules on one rank\n\n" + table(head, body) + "\nIterations grow by up to a third. Up to four capsules lie in the plane where the undisturbed flow stands still; eight and more are carried through the mesh, start each step from a worse guess and have "
            "it made anew now and then, a tenth of their time. Shells near each other are also more than the preconditioner foresees, which knows each shell alone. The rest is memory: what an iteration touches of one "
            "capsule stays in the caches of a core, of sixteen it does not. With sixteen the kinks and jumps of cut cells cost twice as much a capsule and iteration, residuals 1.4 times, V-cycles 1.2 times.\n")


def of_ranks(rows, cores):
    text = ""
    for label, chosen, effective in efficiencies(rows):
        body = [[f"{row['ranks']:g}", f"{row['capsules']:g}", f"{row['cells']:.0f}", show(row["cpu_slowest"], 3), show(row["cpu_mean"], 3), per_cent(law), wall(row, cores), f"{row['linear']:.1f}"]
                for row, law in zip(chosen, effective)]
        text += f"\n{label[0].upper() + label[1:]}, {100 * chosen[0]['fraction']:g} %:\n\n"
        text += table(["ranks", "capsules", "cells", "CPU s a step, slowest rank", "mean", "efficiency of the work", "wall s a step", "linear iterations a step"], body)
    return f"## Several ranks\n{text}" if text else ""


def of_messages(rows, places):
    chosen = [row for row in rows if row["places"] and row["state"] == "done"]
    if not chosen:
        return ""
    text = ("## Messages\n\nOf the first rank, counted before MPI, by who sends: " + "; ".join(f"*{name}*, {about}" for name, about in counts.GROUPS.items()) +
            ". *An iteration*: what is sent within the linear solver of steps, found by the names on the stack, over the linear iterations of `history.csv`; what a solve sends at its start and end is in it. *A step*: all that is "
            "sent within steps, over their number. Messages go from rank to rank; calls of all ranks are sums, copies from one to all, barriers; bytes are those that the rank hands over.\n")
    groups = list(counts.GROUPS)
    for title, suffix in (("An iteration", ""), ("A step", "_in_step")):
        for what, name in (("messages", "message"), ("calls of all ranks", "sum")):
            body = [[f"{row['capsules']:g}", f"{row['ranks']:g}", *(amount(row, [group], name, suffix) for group in groups), amount(row, groups, name, suffix), of_shells(row, name, suffix)] for row in chosen]
            text += f"\n{title}, {what}: number, bytes:\n\n" + table(["capsules", "ranks", *groups, "all", "of the shells"], body)
    if places:
        most = max(places, key=lambda row: row["ranks"] * 1e6 + row["capsules"])
        body = [[row["kind"], f"`{row['where']}`", row["group"], show(row["calls"], 3), size(row["bytes"])] for row in places if (row["capsules"], row["ranks"]) == (most["capsules"], most["ranks"])]
        text += f"\nThe lines that do most of it in calls of all ranks, {most['capsules']:g} capsules on {most['ranks']:g} ranks, an iteration:\n\n" + table(["call", "line", "of", "number", "bytes"], body)
    return text


def size(bytes_):
    """With three digits and a unit."""
    factor, unit = next(((factor, unit) for factor, unit in ((1e6, "MB"), (1e3, "kB")) if bytes_ >= factor), (1, "B"))
    return f"{show(bytes_ / factor, 3)} {unit}"


def summed(row, groups, name, suffix):
    return (sum(row[f"{group}_{what}{suffix}"] for group in groups) for what in (f"{name}s", f"{name}_bytes"))


def amount(row, groups, name, suffix):
    calls, bytes_ = summed(row, groups, name, suffix)
    return "0" if calls == 0 else f"{calls:.0f}, {size(bytes_)}" if calls >= 100 else f"{show(calls, 3)}, {size(bytes_)}"


def of_shells(row, name, suffix):
    """Parts of numbers and bytes that the shells are the reason of."""
    shells, everything = (list(summed(row, groups, name, suffix)) for groups in (("coupling", "shells"), counts.GROUPS))
    return ", ".join(per_cent(part / whole if whole > 0 else math.nan) for part, whole in zip(shells, everything))


def of_memory(rows):
    chosen = cases_of(rows, "memory")
    if not chosen:
        return ""
    body = [[f"{row['ranks']:g}", f"{row['capsules']:g}", f"{row['memory_largest']:.0f}", f"{row['memory_mean']:.0f}"] for row in chosen]
    return f"## Memory of a rank\n\n{show(chosen[0]['capsules'] / chosen[0]['ranks'])} capsules a rank; resident memory at most, libraries included:\n\n" + table(["ranks", "capsules", "largest, MiB", "mean, MiB"], body)


# --------------------------------------------------------------------------------------------------------------------------- model
def milliseconds(value):
    return f"{1e3 * value:.3g}" if value < 1 else f"{1e3 * value:.0f}"


def crossing(ranks):
    return "no number of" if math.isinf(ranks) else f"{ranks:.2g}" if ranks < 100 else f"{round(ranks, -int(math.log10(ranks)) + 1):.0f}"


def of_model(rows, fraction, cores):
    law = model.of_rows(rows, fraction, cores)
    if law is None:
        return "## Model\n\nToo few cases for one.\n"
    a, b, c = law.work
    text = (f"## Model: 16 to 4096 ranks\n\n**This is a model, not a measurement.** With N capsules on P ranks a step takes each rank {milliseconds(a)} ms × N/P + {milliseconds(b)} ms × N + {milliseconds(c)} ms "
            f"outside of MPI with {law.iterations:.3g} linear iterations (least squares of the cases with no more ranks than cores, an iteration, of which the worst differs by {100 * law.error:.0f} %): divided work, what every rank does for all capsules, the rest. It sends "
            f"{law.a_neighbour:.3g} messages to each of its neighbours (as on the most ranks measured; all other ranks up to {model.NEIGHBOURS}), {size(law.surface)} × (N/P)^(2/3) in all, and takes part in "
            f"{law.sums[0]:.3g} + {law.sums[1]:.3g} N + {law.sums[2]:.3g} min(P, N) calls of all ranks, with {size(law.sum_bytes[0])} × N + {size(law.sum_bytes[1])}. A message costs {1e6 * model.LATENCY:g} μs and its bytes at "
            f"{model.BANDWIDTH / 1e9:g} GB/s of a rank; a call of all ranks log₂ P times that latency and twice its bytes. Memory of a rank: {law.memory[0]:.3g} MiB × N/P + {law.memory[1]:.3g} MiB × N + {law.memory[2]:.0f} MiB. "
            f"What takes as long as the divided work, whatever N: the work of all ranks on {crossing(law.crossing_of_work())} ranks, the bytes of calls of all ranks on {crossing(law.crossing_of_bytes())}, "
            f"the latency of calls made for each capsule on {crossing(law.crossing_of_latency())}. "
            "Left out: ranks that wait for the slowest, noise, a growing number of iterations, memory bandwidth shared by the cores of a node, new meshes, output.\n")
    for title, number in ((f"{A_RANK} capsules a rank", lambda n: A_RANK * n), (f"{STRONG} capsules", lambda n: STRONG)):
        body = []
        for n in RANKS_OF_MODEL:
            parts = law.parts(number(n), n)
            whole = sum(parts.values())
            body.append([n, number(n), *(milliseconds(value) for value in parts.values()), milliseconds(whole), per_cent(parts["divided work"] / whole), f"{law.memory_of(number(n), n) / 1024:.2g}", model.limit(parts)])
        text += f"\n{title}, ms a step:\n\n" + table(["ranks", "capsules", *law.parts(1, 2), "all", "divided work of all", "memory of a rank, GiB", "limits first"], body)
    return text


# --------------------------------------------------------------------------------------------------------------------------- page
def machine(notes, rows):
    load, cores = max((row["load"] for row in rows if row["state"] == "done"), default=math.nan), float(notes["cores"])
    busy = " **The machine was busy: wall seconds are void, CPU seconds rough; iterations, messages, bytes and memory are not touched by it.**" if load > 0.2 else ""
    return f"{notes['machine']}; revision {notes['revision']}, {notes['date']}, {notes['mode']}. Cores that others used in the second before a run, at most: {load:.2f} of {notes['cores']}.{busy}"


def page(notes, rows, link, places=()):
    """The page; `link`: the figure as seen from it."""
    fraction, cores = float(notes["fraction"]), float(notes["cores"])
    failed = [f"{row['case']}: {row['state']}" for row in rows if row["state"] != "done"]
    text = [INTRODUCTION.format(percent=100 * fraction, fine=10 / cases.finest_cell(fraction), dense=10 / cases.finest_cell(2 * fraction), machine=machine(notes, rows)), f"![Scaling]({link})\n",
            of_proportion(rows), of_ranks(rows, cores), of_messages(rows, places), of_memory(rows), of_model(rows, fraction, cores)]
    if failed:
        text.append("Runs that failed: " + "; ".join(failed) + ".\n")
    return "\n".join(part for part in text if part)


def read_places(args):
    file = points.kept(args, "places.csv")
    return run_table.read(file, points.PLACE_NUMBERS)[1] if file.is_file() else []
