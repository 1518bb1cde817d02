# SPDX-License-Identifier: LGPL-2.1-or-later
# Part of Tanktread: which scenes are computed on how many ranks, and the calls of the program that do it.
"""Case: so many capsules on so many ranks; series(): the cases of each question; compute(): the runs, with count_mpi.c before the program."""

import dataclasses
import math
import os
import pathlib
import shlex
import shutil
import subprocess
import sys
import time

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent))
import run_scenes  # noqa: E402

CELLS_A_BRICK = 12  # finest cells along the side of the cube of liquid that each capsule has; on the coarsest level there are three
SHIFT = 0.1  # of each capsule from the middle of its brick, in a: no two lie alike among the cells
GOLDEN = (0.8191725134, 0.6710436067, 0.5497004779)  # powers of the root of x^4 = x + 1: numbers c GOLDEN modulo 1 fill a cube evenly
SERIES = {"proportion": "1 to 16 capsules on one rank", "weak": "as many capsules on each rank", "strong": "one scene on more and more ranks", "messages": "what the ranks say to each other",
          "memory": "of each rank"}
LAUNCHER = "mpirun --oversubscribe --bind-to none -np {ranks}"


@dataclasses.dataclass(frozen=True)
class Case:
    """`fraction`: volume of the capsules over that of the box; `places`: messages are counted by who sends them, which takes time."""
    capsules: int
    ranks: int
    fraction: float = 0.1
    steps: int = 8
    places: bool = False

    @property
    def name(self):
        return f"{self.capsules}_capsules_{100 * self.fraction:g}_percent_{self.ranks}_ranks_{self.steps}_steps" + ("_places" if self.places else "")


# ------------------------------------------------------------------------------------------------------------------------ scenes
def bricks(capsules):
    """Bricks along x, y and z: the box grows along x first, then y, then z, and again."""
    n, axis = [1, 1, 1], 0
    left = capsules
    while left > 1:
        factor = next(p for p in range(2, left + 1) if left % p == 0)
        n[axis % 3] *= factor
        left //= factor
        axis += 1
    return n


def settings(case):
    """Parameters of a case beyond scene.prm."""
    n, side = bricks(case.capsules), (4 / 3 * math.pi / case.fraction) ** (1 / 3)
    centres = []
    for c in range(case.capsules):
        place = (c % n[0], c // n[0] % n[1], c // (n[0] * n[1]))
        centres.append([(i + 0.5 - 0.5 * m) * side + SHIFT * (2 * ((c + 1) * g % 1) - 1) for i, m, g in zip(place, n, GOLDEN)])
    step = float(run_scenes.read_parameters(HERE / "scene.prm")["Time/Step"])
    return {"Scene/Box side": ", ".join(f"{side * m:.15g}" for m in n), "Scene/End time": f"{case.steps * step:.12g}",
            "Capsule/Centres": "; ".join(", ".join(f"{x:.12g}" for x in centre) for centre in centres),
            "Fluid mesh/Coarsest cell": f"{side / 3:.12g}", "Fluid mesh/Finest cell": f"{side / CELLS_A_BRICK * (1 + 1e-6):.12g}"}


def finest_cell(fraction):
    return (4 / 3 * math.pi / fraction) ** (1 / 3) / CELLS_A_BRICK


# ------------------------------------------------------------------------------------------------------------------------ series
def series(full=False, ranks=None, fraction=0.1):
    """{series: [Case]}. `ranks`: numbers of ranks in place of 1, 2, 4 (and 8 where memory is asked for)."""
    numbers, steps, a_rank = ranks or [1, 2, 4], 16 if full else 8, 8 if full else 2
    messages = [n for n in (2, 4, 8, 16) if n <= max(16, *numbers)] if ranks is None else [n for n in numbers if n > 1]
    return {
        "proportion": [Case(n, 1, fraction, steps) for n in (1, 2, 4, 8, 16)],
        "weak": [Case(a_rank * n, n, fraction, steps) for n in numbers],
        "strong": [Case(16, n, 2 * fraction, steps) for n in numbers] + [Case(1, n, fraction, steps) for n in numbers],
        "messages": [Case(4, n, fraction, 4, True) for n in messages] + [Case(n, 4, fraction, 4, True) for n in ((1, 2, 8, 16) if full else (1, 8))],
        "memory": [Case(2 * n, n, fraction, steps if 2 * n <= 2 * max(numbers) and not full else 4) for n in (ranks or [1, 2, 4, 8])],
    }


# --------------------------------------------------------------------------------------------------------------------- computing
def busy_cores(seconds=1.):
    """Cores that are not idle, over a while; nan where the system does not tell."""
    def times():
        fields = [int(word) for word in pathlib.Path("/proc/stat").read_text().split("\n", 1)[0].split()[1:]]
        return sum(fields[:8]), fields[3] + fields[4]  # all; idle and waiting for files

    try:
        before = times()
        time.sleep(seconds)
        after = times()
    except (OSError, ValueError, IndexError):
        return math.nan
    return os.cpu_count() * (1 - (after[1] - before[1]) / max(1, after[0] - before[0]))


class Counted(run_scenes.Computation):
    """Runs of the program behind count_mpi.c."""

    def __init__(self, args, case, library):
        super().__init__(args.program, 1, case.ranks, args.resume)
        self.case, self.library, self.launcher = case, library, args.launcher

    def command(self, run, settings, folder):
        counts = folder.parent / "counts"
        shutil.rmtree(folder.parent, ignore_errors=True)
        counts.mkdir(parents=True)
        (folder.parent / "load.txt").write_text(f"{busy_cores():.2f}\n")
        (counts / "program.txt").write_text(identity(pathlib.Path(self.program)))
        yields = self.launcher == LAUNCHER and self.ranks > len(os.sched_getaffinity(0))  # more ranks than cores: those that wait let others compute
        counting = [f"LD_PRELOAD={self.library}", f"TANKTREAD_COUNT_MPI={counts}", f"TANKTREAD_COUNT_PLACES={int(self.case.places)}"]
        words = ["env", *(["OMPI_MCA_mpi_yield_when_idle=1"] if yields else []), *counting, self.program, str(run.prm)]
        for name, value in {**settings, "Output/Directory": str(folder)}.items():
            words += ["--set", f"{name}={value}"]
        return ([] if self.ranks == 1 and self.launcher == LAUNCHER else shlex.split(self.launcher.format(ranks=self.ranks))) + words


def run_of(output):
    return run_scenes.Run(HERE, output, "scene")


def build_library(output):
    """Compiles count_mpi.c; returns the library's path."""
    output.mkdir(parents=True, exist_ok=True)
    library = output / "libcount_mpi.so"
    source = HERE / "count_mpi.c"
    if not library.is_file() or library.stat().st_mtime < max(file.stat().st_mtime for file in (source, HERE / "counted_calls.h")):
        subprocess.run(["mpicc", "-O2", "-shared", "-fPIC", "-o", str(library), str(source)], check=True)
    return library


def compute(args, wanted):
    """Runs those of the cases that are not there; a run that fails does not stop the others."""
    library, run = build_library(args.output), run_of(args.output)
    left = [case for case in wanted if not (args.resume and run.is_finished(case.name, settings(case)) and (not case.places or is_of(args, case)))]
    for i, case in enumerate(left):
        Counted(args, case, library).compute(f"[{i + 1}/{len(left)}] {case.name}", run, case.name, settings(case))


def identity(program):
    """Of a program: addresses are those of one build alone."""
    state = program.stat()
    return f"{state.st_size} bytes, {state.st_mtime_ns}"


def is_of(args, case):
    """Whether a case has been counted with the program that is there now."""
    return (run_of(args.output).folder(case.name).parent / "counts/program.txt").read_text() == identity(args.program)
