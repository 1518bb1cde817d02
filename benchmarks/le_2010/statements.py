# SPDX-License-Identifier: LGPL-2.1-or-later
# Part of Tanktread: what Le (2010) states in words, and how each statement is looked up in the results.
"""STATEMENTS: (figure, the statement in our words, function of the results that says what they show)."""

import numpy as np

import run_files
import values


def done(results, figure, word=""):
    """Runs of a figure that have a series, in order of the bending modulus."""
    return sorted((result for result in results.of(figure) if result.series and result.summary and word in result.name), key=lambda result: result.khat)


def each(found, text):
    """"κ̂ = 0: ...; κ̂ = 0.01: ..."; says so when there is nothing."""
    return "; ".join(f"κ̂ = {result.khat:g}: {text(result)}" for result in found) or "not computed"


def becomes_sphere(word):
    def seen(results):
        found = [result for result in results.of("fig01") if result.series and word in result.name]
        lines = [f"{result.name.split('/')[1]}: L/B − 1 = {result.series['L'][-1] / result.series['B'][-1] - 1:.1e} at t = {result.series['time'][-1]:g}" for result in found]
        return "; ".join(lines) or "not computed"
    return seen


def step_lengths(results):
    """What became of the long steps: those that Newton's method does not solve are halved."""
    def text(result):
        name = result.name.split("/")[1].replace("_step", ", step ")
        if not result.series:
            return f"{name}: {result.state()}"
        steps = result.series["step"][1:]
        return f"{name}: {result.state()} in {len(steps)} steps, the first of {steps[0]:.2g}, the longest of {steps.max():.2g}"
    found = [result for result in results.of("fig01") if result.record and "_step" in result.name]
    return "; ".join(map(text, found)) or "not computed"


def volume(results):
    errors = [np.abs(result.series["volume_error"]).max() for result in results.runs.values() if result.series]
    return f"at most {max(errors):.0e} in {len(errors)} runs" if errors else "not computed"


def resolution(results):
    """Cells and control points at each target."""
    def span(numbers):
        return " to ".join(f"{number:.3g}" for number in sorted({min(numbers), max(numbers)}))
    found = {}
    for result in results.runs.values():
        if result.series:
            cell, level = (run_files.number(result.chosen.get(name, "nan")) for name in ("Fluid mesh/Finest cell", "Shell mesh/Level"))
            found.setdefault(result.record["settings"]["Accuracy/Target error"], []).append((cell, 10 * 4**level + 2))
    words = [f"target {target}: {len(chosen)} runs, cells of {span([h for h, _ in chosen])} a, {span([n for _, n in chosen])} control points"
             for target, chosen in sorted(found.items(), key=lambda item: float(item[0]))]
    return "; ".join(words) or "not computed"


def falls_and_turns(figure, G):
    """Whether D falls and theta grows with the bending modulus."""
    def seen(results):
        found = [result for result in done(results, figure) if result.G == G]
        if len(found) < 2:
            return "not computed"
        D, theta = ([values.limit(result, name, name) for result in found] for name in ("D", "theta"))
        falls, grows = all(np.diff([value.value for value in D]) < 0), all(np.diff([value.value for value in theta]) > 0)
        verdict = f"D {'falls' if falls else 'does not always fall'}, θ {'grows' if grows else 'does not always grow'}"
        return f"{verdict}: " + "; ".join(f"κ̂ = {result.khat:g}: D = {a}, θ = ({b}) π" for result, a, b in zip(found, D, theta))
    return seen


def modes(figure, khat=None):
    def seen(results):
        return each([result for result in done(results, figure) if khat is None or result.khat == khat], lambda result: result.summary["mode"])
    return seen


def calmer(figure, names, period=False):
    """Range of some columns over the run, after its first half turn."""
    def seen(results):
        def text(result):
            parts = [f"range of {symbol} {values.span(result, name)}" for name, symbol in names]
            if period:
                parts.append(f"period of D {values.of_summary(result, 'D_period')}")
            return ", ".join(parts)
        return each(done(results, figure), text)
    return seen


def against_viscosity_one(results):
    pairs = [(thick, thin) for thick in done(results, "fig08") for thin in done(results, "fig05") if thick.khat == thin.khat]
    lines = []
    for thick, thin in pairs:
        D, theta = ([values.mean(result, name) for result in (thick, thin)] for name in ("D", "theta"))
        lines.append(f"κ̂ = {thick.khat:g}: mean D {D[0]} (ratio 1: {D[1]}), mean θ/π {theta[0]} ({theta[1]})")
    return "; ".join(lines) or "not computed"


def area(results):
    found = done(results, "fig09") + done(results, "fig11")
    return each(found, lambda result: f"{values.area_change(result)} %")


STATEMENTS = [
    ("1", "The 2:2:1 ellipsoid becomes a sphere (snapshots at t κ_B/(μa³) = 0, 0.25, 0.75, 5)", becomes_sphere("ellipsoid")),
    ("1", "The biconcave disk becomes a sphere (0, 0.2, 0.5, 1.4, 5)", becomes_sphere("biconcave")),
    ("1", "Steps of 0.005 μa³/κ_B are stable, ten times those of an earlier boundary-integral method", step_lengths),
    ("all", "The volume changes by less than 0.03 %", volume),
    ("all", "96³ cells of 0.104 a in a box of 10 a, shell of 10242 nodes", resolution),
    ("all", "The undisturbed velocity on z = ±5 a, periodic in x and y", lambda results: "unbounded liquid"),
    ("3", "G = 0.05: with growing bending stiffness D falls and θ grows (κ̂ = 0, 0.01, 0.025, 0.0375)", falls_and_turns("fig03", 0.05)),
    ("3", "G = 0.2: the same (0, 0.04, 0.1, 0.15)", falls_and_turns("fig03", 0.2)),
    ("4", "Viscosity ratio 5, G = 0.05: the same (0, 0.01, 0.025, 0.0375)", falls_and_turns("fig04", 0.05)),
    ("5", "Oblate, G = 0.05: swinging for κ̂ = 0, 0.005, 0.01, 0.025", modes("fig05")),
    ("6", "Oblate, G = 0.005: tumbling for κ̂ = 0, 0.01, 0.02, 0.05", modes("fig06")),
    ("6", "Stiffer bending makes D and the phase angle oscillate less", calmer("fig06", [("D", "D"), ("delta", "δ/π")])),
    ("7", "Oblate, G = 0.008, κ̂ = 0: swinging", modes("fig07", 0.0)),
    ("7", "κ̂ = 0.002: in transition from swinging to tumbling", modes("fig07", 0.002)),
    ("7", "κ̂ = 0.005: tumbling", modes("fig07", 0.005)),
    ("8", "Oblate with viscosity ratio 5: less deformed and more aligned with the flow than with ratio 1", against_viscosity_one),
    ("8", "swinging for κ̂ = 0, 0.005, 0.01, 0.025", modes("fig08")),
    ("9, 10", "Biconcave, Skalak, G = 0.5, viscosity ratio 2: swinging for κ̂ = 0, 0.01, 0.04; without bending the dimple vanishes", modes("fig09")),
    ("11, 12", "G = 0.1, viscosity ratio 4: tumbling where κ̂ > 0 (0, 0.01, 0.04)", modes("fig11")),
    ("11", "Stiffer bending shortens the period and makes D oscillate less", calmer("fig11", [("D", "D")], period=True)),
    ("9–12", "The area changes by 0.5 to 1 %", area),
    ("9–12", "Biconcave shape with the coefficients 0.2072, 2.0026, −1.1228", lambda results: "the same shape, scaled to the volume of the unit sphere"),
]
