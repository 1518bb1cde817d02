# SPDX-License-Identifier: LGPL-2.1-or-later
# Part of Tanktread: computes the scenes of a benchmark, several runs at a time.
"""A benchmark is a folder of parameter files that hold physics and times; how fine and in which box comes from its script, as settings. Results go to
output/<benchmark>/<resolution>/<name>, with run.json: what was computed, how it ended."""

import concurrent.futures
import json
import os
import pathlib
import platform
import re
import shutil
import subprocess
import sys
import threading
import time

from run_files import read_parameters

ROOT = pathlib.Path(__file__).resolve().parents[1]


class Run:
    """The parameter file <scenes>/<name>.prm and the folders of its results."""

    def __init__(self, scenes, output, name):
        self.name, self.output = name, output
        self.prm = scenes / f"{name}.prm"

    def folder(self, resolution):
        return self.output / resolution / self.name

    def record(self, resolution):
        """What run.json says, or None."""
        file = self.folder(resolution) / "run.json"
        return json.loads(file.read_text()) if file.is_file() else None

    def key(self, settings):
        """What decides the result; a run with another key has to be done again."""
        return {"prm": self.prm.read_text(), "settings": settings}

    def is_finished(self, resolution, settings):
        record = self.record(resolution)
        return record is not None and record["exit_code"] == 0 and record["input"] == self.key(settings)

    def parameters(self):
        return read_parameters(self.prm)

    def end_time(self):
        return float(self.parameters().get("Scene/End time", 10))


def add_arguments(parser):
    parser.add_argument("--jobs", type=int, help="runs at a time (default: as many as the processor has room for)")
    parser.add_argument("--ranks", type=int, help="MPI ranks of a run (default 1, more when there are fewer runs than cores)")
    parser.add_argument("--resume", action="store_true", help="leave out runs that are finished with the same parameters")
    parser.add_argument("--draw", action="store_true", help="compute nothing: draw and report what is there")
    parser.add_argument("--update-doc", action="store_true", help="replace in doc/ what has been computed; without it nothing there changes")
    parser.add_argument("--program", type=pathlib.Path, default=ROOT / "build/release/tanktread", help="default: build/release/tanktread")


def check_arguments(parser, args):
    if not args.draw and not args.program.is_file():
        parser.error(f"{args.program} is missing: build it (cmake --preset release && cmake --build --preset release) or name it with --program")
    for name in ("jobs", "ranks"):
        if getattr(args, name) is not None and getattr(args, name) < 1:
            parser.error(f"--{name} {getattr(args, name)}; allowed: a number >= 1")


def division_of_cores(n_runs, n_cores, jobs=None, ranks=None):
    """(runs at a time, ranks of each) that use all cores: runs side by side before ranks, of which more than four gain little in scenes of this size."""
    if ranks is None:
        ranks = max(1, min(4, n_cores // max(1, min(n_runs, jobs or n_cores))))
    return jobs or max(1, n_cores // ranks), ranks


def processor():
    file = pathlib.Path("/proc/cpuinfo")
    names = [line.split(":", 1)[1].strip() for line in file.read_text().splitlines() if line.startswith("model name")] if file.is_file() else []
    return f"{os.cpu_count()} cores, {names[0] if names else platform.processor() or 'processor unknown'}, {platform.machine()}"


class Progress:
    """The state of the runs: one line that changes on a terminal, a line for each run that has ended in a file."""

    def __init__(self):
        self.lock, self.running = threading.Lock(), {}

    def show(self, title, text):
        with self.lock:
            self.running[title] = text
            self.draw()

    def end(self, title, text):
        with self.lock:
            self.running.pop(title, None)
            print(("\r\033[K" if sys.stdout.isatty() else "") + f"{title}: {text}", flush=True)
            self.draw()

    def draw(self):
        if sys.stdout.isatty():
            line = "; ".join(f"{title}: {text}" for title, text in self.running.items())
            print("\r\033[K" + line[:shutil.get_terminal_size().columns - 1], end="", flush=True)


class Computation:
    """Runs of the program on a pool of threads."""

    def __init__(self, program, jobs, ranks, resume, cpu_limit=None):
        """cpu_limit: CPU seconds after which a run is ended, with exit code -SIGXCPU; None: as long as it takes."""
        self.program, self.jobs, self.ranks, self.resume, self.cpu_limit = str(program.resolve()), jobs, ranks, resume, cpu_limit
        self.progress, self.processes, self.stopped = Progress(), [], False

    def command(self, run, settings, folder):
        words = ([] if self.cpu_limit is None else ["prlimit", f"--cpu={self.cpu_limit}:{self.cpu_limit + 10}"]) + [self.program, str(run.prm)]
        for name, value in {**settings, "Output/Directory": str(folder)}.items():
            words += ["--set", f"{name}={value}"]
        if self.ranks == 1:
            return words
        return ["mpirun", *(["--bind-to", "none"] if self.jobs > 1 else []), "-np", str(self.ranks), *words]

    def compute(self, title, run, resolution, settings):
        """One run; leaves run.json beside its results, also when it fails or is refused. It has no CPU seconds where a study has gone on from where it was interrupted."""
        if self.stopped:
            return
        folder, end, start, tail = run.folder(resolution), run.end_time(), time.time(), []
        is_study = "Study/Vary" in settings
        goes_on = is_study and self.resume and (folder / "summary.csv").is_file()
        if is_study and not goes_on:
            shutil.rmtree(folder, ignore_errors=True)  # the program does not compute again what is there
        environment = {"OMP_NUM_THREADS": "1", "OMPI_ALLOW_RUN_AS_ROOT": "1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1", **os.environ}
        process = subprocess.Popen(self.command(run, settings, folder), stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, env=environment, cwd=ROOT)
        self.processes.append(process)
        for line in process.stdout:
            tail = tail[-7:] + [line.strip()]
            words = line.split()
            if len(words) > 2 and re.fullmatch(r"\d+", words[0]):
                self.progress.show(title, f"t = {words[1]} of {end:g}, remaining {words[-1]}")
        _, status, used = os.wait4(process.pid, 0)  # for its CPU seconds, those of all ranks
        code = process.returncode = os.waitstatus_to_exitcode(status)
        if self.stopped:
            return
        message = "" if code == 0 else next((text for text in tail if "not available" in text or "FAILED" in text), " ".join(tail[-1:]))
        seconds = round(time.time() - start, 1)
        record = {"input": run.key(settings), "exit_code": code, "message": message, "seconds": seconds, "cpu_seconds": round(used.ru_utime + used.ru_stime, 2), "ranks": self.ranks, "settings": settings}
        if goes_on:
            del record["cpu_seconds"]
        folder.mkdir(parents=True, exist_ok=True)
        (folder / "run.json").write_text(json.dumps(record, indent=1) + "\n")
        self.progress.end(title, ("done" if code == 0 else f"exit code {code}: {message}") + f", {seconds:.0f} s")

    def stop(self):
        self.stopped = True
        for process in self.processes:
            if process.poll() is None:
                process.terminate()


def compute(args, wanted):
    """Computes [(run, resolution, settings)]; a run that fails or that the program refuses does not stop the others."""
    left = [item for item in wanted if not (args.resume and item[0].is_finished(*item[1:]))]
    if len(left) < len(wanted):
        print(f"finished before: {len(wanted) - len(left)} of {len(wanted)} runs")
    jobs, ranks = division_of_cores(len(left), len(os.sched_getaffinity(0)), args.jobs, args.ranks)
    computation = Computation(args.program, jobs, ranks, args.resume, getattr(args, "cpu_limit", None))
    with concurrent.futures.ThreadPoolExecutor(jobs) as pool:
        futures = [pool.submit(computation.compute, f"[{i + 1}/{len(left)}] {item[1]} {item[0].name}", *item) for i, item in enumerate(left)]
        try:
            for future in concurrent.futures.as_completed(futures):
                future.result()
        except BaseException:
            pool.shutdown(wait=False, cancel_futures=True)
            computation.stop()
            raise


def call(main):
    """Ends a script with main()'s exit code; Control-C says how to go on."""
    try:
        sys.exit(main())
    except KeyboardInterrupt:
        print("\nstopped; --resume goes on with the runs that are left")
        sys.exit(130)
