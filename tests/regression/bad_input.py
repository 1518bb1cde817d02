#!/usr/bin/env python3
# SPDX-License-Identifier: LGPL-2.1-or-later
# Part of Tanktread: runs the program on bad input; checks message and exit code, and that nothing was written.
"""Usage: bad_input.py --list | bad_input.py PROGRAM CASE

Each case starts PROGRAM in an empty folder that holds case.prm (and the mesh files of data/). It passes when the exit code is the one wanted, all
expected texts are on standard error (or output, for exit code 0), and the folder holds the same files as before. A computation that fails (exit code 2)
leaves its folder behind.
"""

import pathlib
import shutil
import subprocess
import sys
import tempfile

DATA = pathlib.Path(__file__).resolve().parent / "data"


def section(name, *lines):
    return "\n".join([f"subsection {name}"] + [f"  {line}" for line in lines] + ["end", ""])


# name: (text of case.prm, words of the command line, exit code, expected texts)
CASES = {
    "misspelt_parameter": (
        section("Scene", "set Shear numbr G = 0.1"),
        ["case.prm"],
        1,
        ["case.prm:2: unknown parameter", '"Shear numbr G"', 'did you mean "Shear number G"?'],
    ),
    "misspelt_section": (
        section("Scen", "set End time = 1"),
        ["case.prm"],
        1,
        ['case.prm:1: unknown section "Scen"; did you mean "Scene"?'],
    ),
    "negative_modulus": (
        section("Scene", "", "set Reduced bending modulus = -0.01"),
        ["case.prm"],
        1,
        ["case.prm:3: Scene/Reduced bending modulus = -0.01; allowed: a number >= 0"],
    ),
    "wrong_word": (
        section("Capsule", "set Shape = cube"),
        ["case.prm"],
        1,
        ["case.prm:2: Capsule/Shape = cube; allowed: one of sphere, ellipsoid, oblate, biconcave, file"],
    ),
    "points_leave_a_membrane": (
        section("Shell mesh", "set Even control mesh = always"),
        ["case.prm"],
        1,
        ["case.prm:2: Shell mesh/Even control mesh is always; allowed where the shell has a membrane"],
    ),
    "deflated_to_nothing": (
        section("Capsule", "set Prestress = -1"),
        ["case.prm"],
        1,
        ["case.prm:2: Capsule/Prestress: got -1; allowed: an inflation above -0.5 and up to 9."],
    ),
    "spheroid_of_a_mesh_file": (
        section("Capsule", "set Shape = file", "set Mesh file = a.off", "set Stress-free shape = oblate"),
        ["case.prm"],
        1,
        ["case.prm:4: Capsule/Stress-free shape: ", "allowed with the shape 'file': initial"],
    ),
    "unbounded_with_inertia": (
        section("Scene", "set Boundary = unbounded", "set Reynolds number = 0.5"),
        ["case.prm"],
        1,
        ["Scene/Boundary is unbounded; allowed with Scene/Reynolds number = 0.5: faces"],
    ),
    "unbounded_without_walls": (
        section("Scene", "set Boundary = unbounded", "set Flow = plane Poiseuille"),
        ["case.prm"],
        1,
        ["Scene/Channel half width is 0; allowed with Scene/Boundary = unbounded, where the faces of the box are no walls: a number > 0"],
    ),
    "unbounded_in_too_small_a_box": (
        section("Scene", "set Boundary = unbounded", "set Box side = 5") + section("Capsule", "set Centres = 0, 0, 1.1"),
        ["case.prm"],
        1,
        ["Capsule/Centres: a capsule is 0.4", "a from a face of the box; allowed with Scene/Boundary = unbounded: 0.5 a or more (Scene/Box side)."],
    ),
    "two_errors": (
        section("Scene", "set Shear number G = -1", "set End tim = 1"),
        ["case.prm"],
        1,
        ["case.prm:2: Scene/Shear number G = -1; allowed: a number > 0", "case.prm:3: unknown parameter"],
    ),
    "thick_skalak": (
        section("Capsule", "set Membrane law = Skalak", "set Thickness = 0.1"),
        ["case.prm"],
        1,
        ["case.prm:3: Capsule/Thickness: got 0.1", "allowed with this 'Membrane law': 0"],
    ),
    "too_thick": (
        section("Capsule", "set Shape = oblate", "set Aspect ratio = 0.5", "set Thickness = 0.7"),
        ["case.prm"],
        1,
        ["Capsule/Thickness: got 0.7", "less than twice the smallest radius of curvature of the initial shape, which is 0.3"],
    ),
    "no_axis_of_symmetry": (
        section("Capsule", "set Shape = ellipsoid", "set Axes = 3, 2, 1", "set Inclined axis = symmetry"),
        ["case.prm"],
        1,
        ["case.prm:4: Capsule/Inclined axis: got symmetry", "Allowed: long"],
    ),
    "open_mesh": (
        section("Capsule", "set Shape = file", "set Mesh file = open_mesh.off"),
        ["case.prm"],
        1,
        ["case.prm:3: Capsule/Mesh file", "open_mesh.off", "edge"],
    ),
    "missing_mesh": (
        section("Capsule", "set Shape = file", "set Mesh file = no.off"),
        ["case.prm"],
        1,
        ["case.prm:3: Capsule/Mesh file", "no.off"],
    ),
    "output_is_a_file": (
        section("Output", "set Directory = case.prm/output"),
        ["case.prm"],
        1,
        ["case.prm:2: Output/Directory", "case.prm/output", "is not a folder"],
    ),
    "output_in_proc": (
        section("Output", "set Directory = /proc/tanktread/output"),
        ["case.prm"],
        1,
        ["case.prm:2: Output/Directory", "/proc/tanktread/output", "cannot be written"],
    ),
    "bad_override": (
        section("Scene", "set End time = 1"),
        ["case.prm", "--set", "Scene/End time=soon"],
        1,
        ['--set "Scene/End time=soon": Scene/End time = soon; allowed: a number >= 0'],
    ),
    "unknown_option": (
        "",
        ["--valdate", "case.prm"],
        1,
        ['unknown option "--valdate"; did you mean "--validate"?'],
    ),
    "missing_file": ("", ["no.prm"], 1, ['cannot read the parameter file "no.prm"']),
    "no_file": ("", [], 1, ["no parameter file given", "usage"]),
    "larger_cells_in_gaps": (
        section("Fluid mesh", "set Finest cell = 0.2", "set Finest cell in gaps = 0.3"),
        ["case.prm"],
        1,
        ["Fluid mesh/Finest cell in gaps is 0.3; allowed: at most Fluid mesh/Finest cell, 0.2, or 0"],
    ),
    "failing_computation": (
        section("Shell mesh", "set Level = 1")
        + section("Fluid mesh", "set Finest cell = 0.625")
        + section("Solver", "set Maximal linear iterations = 1"),
        ["case.prm"],
        2,
        ["numerical failure", "did not converge", "iterations"],
    ),
    # --validate finds what only the shapes tell.
    "validate_too_thick": (
        section("Capsule", "set Shape = oblate", "set Aspect ratio = 0.5", "set Thickness = 0.7"),
        ["--validate", "case.prm"],
        1,
        ["case.prm:4: Capsule/Thickness: got 0.7", "less than twice the smallest radius of curvature"],
    ),
    "validate_too_large": (
        section("Capsule", "set Shape = ellipsoid", "set Axes = 6, 1, 1") + section("Scene", "set Box side = 5"),
        ["--validate", "case.prm"],
        1,
        ["case.prm:6: Scene/Box side is 5 along x; allowed: more than 7.2", "the capsule's extent and four finest cells"],
    ),
    "validate_overlap": (
        section("Capsule", "set Centres = 0, 0, 0; 1.5, 0, 0"),
        ["--validate", "case.prm"],
        1,
        ["case.prm:2: Capsule/Centres: capsules 1 and 2 overlap by 0.499"],
    ),
    "validate_beyond_a_wall": (
        section("Capsule", "set Centres = 0, 0, 4.5"),
        ["--validate", "case.prm"],
        1,
        ["case.prm:2: Capsule/Centres: a capsule reaches 0.499", "beyond a face of the box"],
    ),
    "validate_flow_along_a_periodic_axis": (
        section("Scene", "set Flow = planar extension"),
        ["--validate", "case.prm"],
        1,
        ["case.prm:2: Scene/Box faces has 'periodic' across x", "Scene/Flow = planar extension"],
    ),
    "validate_assembled_with_two_viscosities": (
        section("Scene", "set Viscosity ratio = 5") + section("Solver", "set Method = assembled"),
        ["--validate", "case.prm"],
        1,
        ["case.prm:5: Solver/Method is assembled; allowed with Scene/Viscosity ratio = 5: matrix-free"],
    ),
    "validate_assembled_with_inertia": (
        section("Scene", "set Reynolds number = 0.5") + section("Solver", "set Method = assembled"),
        ["--validate", "case.prm"],
        1,
        ["case.prm:5: Solver/Method is assembled; allowed with Scene/Reynolds number = 0.5: matrix-free"],
    ),
    # and, so that the cases above cannot pass with a program that refuses everything:
    "good_input": (section("Scene", "set End time = 1"), ["--validate", "case.prm"], 0, ["valid"]),
    "good_method": (section("Solver", "set Method = assembled"), ["--validate", "case.prm"], 0, ["valid"]),
    "empty_file": ("", ["--validate", "case.prm"], 0, ["valid"]),
    "print_parameters": ("", ["--print-parameters"], 0, ["subsection Scene", "set Shear number G = 0.05"]),
    "version": ("", ["--version"], 0, ["Tanktread", "deal.II"]),
}


def files_of(folder):
    return sorted(str(path.relative_to(folder)) for path in folder.rglob("*"))


def run_case(program, name):
    text, words, exit_code, expected = CASES[name]
    with tempfile.TemporaryDirectory() as temporary:
        folder = pathlib.Path(temporary)
        (folder / "case.prm").write_text(text)
        for mesh in DATA.glob("*.off"):
            shutil.copy(mesh, folder)
        before = files_of(folder)
        result = subprocess.run([program] + words, cwd=folder, capture_output=True, text=True, timeout=60)
        after = files_of(folder)
    said = result.stdout if exit_code == 0 else result.stderr
    failures = [f"missing: {part}" for part in expected if part not in said]
    if result.returncode != exit_code:
        failures.append(f"exit code {result.returncode}, expected {exit_code}")
    if exit_code == 2:
        failures += [f"not written: {name}" for name in ("output/case/log.txt", "output/case/used_parameters.prm") if name not in after]
    elif after != before:
        failures.append(f"written: {sorted(set(after) - set(before))}")
    print(f"--- stdout\n{result.stdout}--- stderr\n{result.stderr}---")
    print("\n".join(failures) if failures else "passed")
    return 1 if failures else 0


if __name__ == "__main__":
    if sys.argv[1:] == ["--list"]:
        print(";".join(CASES), end="")
    else:
        sys.exit(run_case(str(pathlib.Path(sys.argv[1]).resolve()), sys.argv[2]))
