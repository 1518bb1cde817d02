# SPDX-License-Identifier: LGPL-2.1-or-later
# Part of Tanktread: a Python that has what a script needs.
"""need("numpy", "matplotlib"), called before they are imported, starts the script again with another Python when this one lacks them, or ends it with one
line that says what to install.

The first python3 on PATH is often one of a version manager or a conda environment, while the packages of the system belong to /usr/bin/python3.
"""

import importlib
import os
import shutil
import subprocess
import sys

STARTED_AGAIN = "TANKTREAD_PYTHON_STARTED_AGAIN"  # in the environment: so that no script is started for ever
SYSTEM = "/usr/bin/python3"


def others():
    """Pythons to try: that of the system, then those on PATH, each once."""
    found = [SYSTEM] + [shutil.which("python3", path=folder) for folder in os.get_exec_path()]
    return list(dict.fromkeys(python for python in found if python and os.access(python, os.X_OK)))


def has(python, packages):
    return subprocess.run([python, "-c", "import " + ", ".join(packages)], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL).returncode == 0


def imports(package):
    try:
        importlib.import_module(package)
        return True
    except ImportError:
        return False


def need(*packages):
    """Returns when this Python has the packages; else starts sys.argv again with one that has, or exits."""
    missing = [package for package in packages if not imports(package)]
    if not missing:
        os.environ.pop(STARTED_AGAIN, None)  # it is nothing to what this script starts
        return
    script = os.path.basename(sys.argv[0])
    if os.path.isfile(sys.argv[0]) and STARTED_AGAIN not in os.environ:
        for python in others():
            if has(python, packages):
                os.environ[STARTED_AGAIN] = "1"
                sys.stdout.flush()
                os.execv(python, [python, *sys.argv])
    debian = " ".join(f"python3-{package}" for package in missing)
    install = f"install {debian} (Debian), or python3 -m pip install {' '.join(missing)}"
    sys.exit(f"{script}: {sys.executable} has no {' and no '.join(missing)}, nor has any other python3 here: {install}")
