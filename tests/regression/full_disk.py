#!/usr/bin/env python3
# SPDX-License-Identifier: LGPL-2.1-or-later
# Part of Tanktread: a run on a disk that fills up ends with exit code 2 and a line that says what could not be written, and keeps what it had.
"""Usage: full_disk.py --program tanktread --prm FILE [--ranks N] [--size KIBIBYTES]

The disk is a file system in memory of that size, mounted in a name space of this test's own. Where that is not allowed the test is skipped (exit code 77)."""

import argparse
import csv
import os
import pathlib
import subprocess
import sys
import tempfile

SKIPPED = 77


def run_on_full_disk(arguments, folder):
    """What the program says, its exit code, and the rows of history.csv."""
    mount = subprocess.run(["mount", "-t", "tmpfs", "-o", f"size={arguments.size}k", "tmpfs", folder], capture_output=True)
    if mount.returncode != 0:
        print("skipped: no file system can be mounted:", mount.stderr.decode().strip())
        sys.exit(SKIPPED)
    command = ["mpirun", "--oversubscribe", "-np", str(arguments.ranks), arguments.program, arguments.prm, "--set", f"Output/Directory={folder}/run",
               "--set", "Output/Field interval=0.1"]
    result = subprocess.run(command, capture_output=True, text=True, timeout=120)
    history = pathlib.Path(folder, "run", "history.csv")
    rows = list(csv.reader(history.open())) if history.is_file() else []
    return result.stdout + result.stderr, result.returncode, rows


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--program", required=True)
    parser.add_argument("--prm", required=True)
    parser.add_argument("--ranks", type=int, default=1)
    parser.add_argument("--size", type=int, default=1200)
    arguments = parser.parse_args()
    if "TANKTREAD_OWN_MOUNTS" not in os.environ:
        # Started again as root of a name space of its own, whose mounts are gone when it ends.
        again = ["unshare", "--mount", "--map-root-user", sys.executable, *sys.argv]
        try:
            allowed = subprocess.run(again[:3] + ["true"], capture_output=True).returncode == 0
        except FileNotFoundError:
            allowed = False
        if not allowed:
            print("skipped: no name space of its own")
            sys.exit(SKIPPED)
        sys.exit(subprocess.run(again, env={**os.environ, "TANKTREAD_OWN_MOUNTS": "1"}).returncode)

    with tempfile.TemporaryDirectory() as folder:
        output, exit_code, rows = run_on_full_disk(arguments, folder)
        subprocess.run(["umount", folder])
    errors = []
    if exit_code != 2:
        errors.append(f"exit code {exit_code}, wanted 2")
    for words in ("tanktread: output failure\ncannot write \"", ": No space left on device\n"):
        if words not in output:
            errors.append(f"no {words!r} in what it says")
    for words in ("Stacktrace", "Backtrace", "Additional information"):
        if words in output:
            errors.append(f"{words!r} in what it says")
    if len(rows) < 2 or any(len(row) != len(rows[0]) for row in rows):
        errors.append(f"history.csv has rows of {sorted({len(row) for row in rows})} columns")
    print(output)
    print("\n".join(errors) or f"history.csv has {len(rows) - 1} whole rows")
    sys.exit(1 if errors else 0)


if __name__ == "__main__":
    main()
