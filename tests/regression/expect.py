#!/usr/bin/env python3
# SPDX-License-Identifier: LGPL-2.1-or-later
# Part of Tanktread: runs a command and checks its exit code as well as what it says; ctest's PASS_REGULAR_EXPRESSION leaves the exit code out.
"""Usage: expect.py EXIT_CODE REGULAR_EXPRESSION COMMAND...

Passes when the command ends with EXIT_CODE and the expression (Python's, ^ and $ at every line) is found in what it writes to standard output and error.
"""

import re
import subprocess
import sys


def main():
    exit_code, expression, *command = sys.argv[1:]
    result = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
    print(result.stdout)
    failures = []
    if result.returncode != int(exit_code):
        failures.append(f"exit code {result.returncode}, expected {exit_code}")
    if not re.search(expression, result.stdout, re.MULTILINE):
        failures.append(f"not said: {expression}")
    print("\n".join(failures) if failures else "passed")
    return 1 if failures else 0


if __name__ == "__main__":
    sys.exit(main())
