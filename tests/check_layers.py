#!/usr/bin/env python3
# SPDX-License-Identifier: LGPL-2.1-or-later
# Part of Tanktread: fails when an #include points the wrong way between layers.
"""Usage: check_layers.py ROOT, where ROOT holds include/tanktread/<layer> and source/<layer>.

Layers, each of which may include itself and those it names:
    base -> surface -> shell, base -> fluid, (shell, fluid) -> coupling -> solver -> simulation -> main
Surface and shell know Eigen, OpenSubdiv and METIS only: no MPI and of deal.II nothing but its ParameterHandler.
"""

import pathlib
import re
import sys

MAY_INCLUDE = {
    "base": "base",
    "surface": "base surface",
    "shell": "base surface shell",
    "fluid": "base fluid",
    "coupling": "base surface shell fluid coupling",
    "solver": "base surface shell fluid coupling solver",
    "simulation": "base surface shell fluid coupling solver simulation",
    "main": "base surface shell fluid coupling solver simulation",
}
FLUIDLESS = ("surface", "shell")
ALLOWED_DEAL_II = "deal.II/base/parameter_handler.h"
FORBIDDEN = re.compile(r"(mpi\.h|tanktread/base/mpi_errors\.h|deal\.II/.*)$")
INCLUDE = re.compile(r'\s*#\s*include\s*[<"]([^>"]+)[>"]')


def layer_of(path):
    """Layer of a file below ROOT, or None for files that belong to none."""
    parts = path.parts
    if parts[:2] == ("include", "tanktread"):
        return parts[2]
    if parts[0] == "source":
        return parts[1] if len(parts) > 2 else "main"
    return None


def errors_of_include(layer, header):
    if header.startswith("tanktread/"):
        other = header.split("/")[1]
        if other not in MAY_INCLUDE[layer].split():
            yield f"layer {layer} may not include {header}; allowed: {MAY_INCLUDE[layer]}"
    if layer in FLUIDLESS and FORBIDDEN.match(header) and header != ALLOWED_DEAL_II:
        yield f"layer {layer} may not include {header}; of MPI and deal.II only {ALLOWED_DEAL_II} is allowed"


def errors_of_file(root, path):
    relative = path.relative_to(root)
    layer = layer_of(relative)
    lines = path.read_text().splitlines()
    if layer not in MAY_INCLUDE:
        yield f"{relative}: unknown layer {layer}; allowed: {' '.join(MAY_INCLUDE)}"
        return
    if len(lines) < 2 or "SPDX-License-Identifier: LGPL-2.1-or-later" not in lines[0] or "Part of Tanktread: " not in lines[1]:
        yield f"{relative}:1: the first two lines name the licence and what the file is"
    guard = "_".join(("tanktread", layer, path.stem, "h"))
    if path.suffix == ".h" and f"#ifndef {guard}" not in lines:
        yield f"{relative}: the include guard is missing or not {guard}"
    for number, line in enumerate(lines, 1):
        found = INCLUDE.match(line)
        if found:
            for error in errors_of_include(layer, found.group(1)):
                yield f"{relative}:{number}: {error}"


def main():
    root = pathlib.Path(sys.argv[1])
    files = [path for folder in ("include", "source") for path in sorted((root / folder).rglob("*")) if path.suffix in (".h", ".cc")]
    errors = [error for path in files for error in errors_of_file(root, path)]
    print("\n".join(errors) if errors else f"{len(files)} files, all includes point the right way")
    return 1 if errors or not files else 0


if __name__ == "__main__":
    sys.exit(main())
