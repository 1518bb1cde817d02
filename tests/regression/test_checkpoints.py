#!/usr/bin/env python3
# SPDX-License-Identifier: LGPL-2.1-or-later
# Part of Tanktread: runs that are killed, stopped and resumed, and checkpoints that are damaged.
"""test_checkpoints.py PROGRAM SCENE.prm [--kills N] [--seed S] [-v]: nothing of a run is lost, whatever happens to it."""

import argparse
import csv
import os
import pathlib
import random
import shutil
import signal
import subprocess
import sys
import tempfile
import time
import unittest

PROGRAM, SCENE, KILLS, SEED = "", "", 5, 1
END, STEP, INTERVAL = 1., 0.05, 0.1  # of the runs below; a few hundredths of a second a step


def parent_of(process):
    """Number of the parent of a folder of /proc; 0 if it has gone."""
    try:
        return int((process / "stat").read_text().rsplit(")", 1)[1].split()[1])
    except (OSError, IndexError, ValueError):
        return 0


class Restart(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.home = pathlib.Path(tempfile.mkdtemp(prefix="tanktread_restart_"))
        cls.whole = cls.home / "whole"
        started = time.monotonic()
        cls.run_to_end(cls.whole)
        cls.seconds = time.monotonic() - started

    @classmethod
    def tearDownClass(cls):
        shutil.rmtree(cls.home, ignore_errors=True)

    @staticmethod
    def command(folder, *more):
        words = [PROGRAM, SCENE]
        for setting in (f"Output/Directory={folder}", f"Output/Checkpoint interval={INTERVAL}", f"Scene/End time={END}", f"Time/Step={STEP}", "Time/Scheme=BDF2", "Output/Field interval=0.25"):
            words += ["--set", setting]
        return [*words, *more]

    @classmethod
    def run_to_end(cls, folder, *more, code=0):
        done = subprocess.run(cls.command(folder, *more), stdout=subprocess.PIPE, stderr=subprocess.STDOUT, universal_newlines=True, timeout=300)
        if done.returncode != code:
            raise AssertionError(f"exit code {done.returncode}, expected {code}\n{done.stdout}")
        return done.stdout

    @staticmethod
    def rows(folder):
        """Of history.csv, without the times of the clock."""
        with open(folder / "history.csv", newline="") as file:
            rows = list(csv.reader(file))
        clock = rows[0].index("wall_time")
        return [row[:clock] + row[clock + 1:] for row in rows]

    def assert_whole(self, folder):
        self.assertEqual(self.rows(folder), self.rows(self.whole))
        for series in ("fluid.pvd", "shell.pvd"):
            self.assertEqual(*([line for line in (path / series).read_text().splitlines() if "<DataSet" in line] for path in (folder, self.whole)))

    def folder(self, name):
        return self.home / name

    def copied(self, name):
        shutil.copytree(self.whole, self.folder(name))
        return self.folder(name)

    @staticmethod
    def checkpoints(folder):
        return sorted((folder / "checkpoints").glob("step_????????"))

    # ------------------------------------------------------------------------------------------------------------ accidents
    def test_killed_at_random(self):
        chance = random.Random(SEED)
        folder, n_killed = self.folder("killed"), 0
        while n_killed < KILLS:
            process = subprocess.Popen(self.command(folder, "--resume"), stdout=subprocess.PIPE, stderr=subprocess.STDOUT, universal_newlines=True)
            try:
                said, _ = process.communicate(timeout=chance.uniform(0., 1.2 * self.seconds))
                self.assertEqual(process.returncode, 0, said)
                self.assert_whole(folder)
                shutil.rmtree(folder)
            except subprocess.TimeoutExpired:
                process.send_signal(signal.SIGKILL)
                process.communicate()
                n_killed += 1
        self.run_to_end(folder, "--resume")
        self.assert_whole(folder)

    def test_a_rank_dies(self):
        folder = self.folder("rank_dies")
        process = subprocess.Popen(["mpirun", "--oversubscribe", "-np", "2", *self.command(folder)], stdout=subprocess.PIPE, stderr=subprocess.STDOUT, universal_newlines=True)
        until = time.monotonic() + 60
        while len(self.checkpoints(folder)) < 2:
            self.assertLess(time.monotonic(), until)
            time.sleep(0.01)
        ranks = [int(path.name) for path in pathlib.Path("/proc").glob("[0-9]*") if parent_of(path) == process.pid]
        os.kill(ranks[-1], signal.SIGKILL)
        said, _ = process.communicate(timeout=60)
        self.assertNotEqual(process.returncode, 0, said)
        self.assertIn("signal 9", said)
        self.assertIn("Resumed at time", self.run_to_end(folder, "--resume"))
        self.assertEqual(len(self.rows(folder)), len(self.rows(self.whole)))

    def test_killed_while_checkpoints_are_written(self):
        folder = self.folder("unfinished")
        shutil.copytree(self.whole, folder)
        newest = self.checkpoints(folder)[-1]
        newest.rename(str(newest) + ".part")
        (pathlib.Path(str(newest) + ".part") / "manifest.txt").unlink()
        said = self.run_to_end(folder, "--resume")
        self.assertIn("Resumed at time 0.9", said)
        self.assert_whole(folder)
        self.assertEqual([path.name for path in self.checkpoints(folder)], ["step_00000018", "step_00000020"])
        self.assertEqual(list((folder / "checkpoints").glob("*.part")), [])

    def damage(self, name, change, *words):
        folder = self.copied(name)
        change(self.checkpoints(folder)[-1])
        said = self.run_to_end(folder, "--resume")
        for word in ("WARNING: the checkpoint", "step_00000020 cannot be used: ", "The one before it is tried.", "Resumed at time 0.9", *words):
            self.assertIn(word, said)
        self.assert_whole(folder)

    def test_truncated(self):
        self.damage("truncated", lambda path: os.truncate(path / "rank_0.bin", 1000), "rank_0.bin has 1000 bytes; written were")

    def test_missing_file(self):
        self.damage("missing", lambda path: (path / "run.bin").unlink(), "cannot read")

    def test_flipped_bits(self):
        def flip(path, file):
            data = bytearray((path / file).read_bytes())
            data[len(data) // 2] ^= 1
            (path / file).write_bytes(data)

        for i, file in enumerate(("rank_0.bin", "run.bin", "manifest.txt")):
            with self.subTest(file=file):
                self.damage(f"flipped_{i}", lambda path, file=file: flip(path, file), "manifest is damaged" if file == "manifest.txt" else "the checksum differs")

    def test_all_damaged(self):
        folder = self.copied("all_damaged")
        for path in self.checkpoints(folder):
            os.truncate(path / "manifest.txt", 10)
        said = self.run_to_end(folder, "--resume")
        self.assertIn("There is no checkpoint to resume from", said)
        self.assertIn("The folder held a former run, now in", said)
        self.assert_whole(folder)

    def test_disk_full(self):
        if os.geteuid() != 0:
            self.skipTest("mounting a small disk takes root")
        disk = self.home / "disk"
        disk.mkdir()
        if subprocess.run(["mount", "-t", "tmpfs", "-o", "size=1600k", "tmpfs", str(disk)], stderr=subprocess.DEVNULL).returncode != 0:
            self.skipTest("no small disk can be mounted here")
        try:
            folder = disk / "run"
            done = subprocess.run(self.command(folder), stdout=subprocess.PIPE, stderr=subprocess.STDOUT, universal_newlines=True, timeout=300)
            said = done.stdout
            self.assertIn("No space left on device", said)
            self.assertNotIn("An error occurred in line", said)
            self.assertIn(done.returncode, (0, 2), said)
            subprocess.run(["mount", "-o", "remount,size=50m", str(disk)], check=True)
            self.run_to_end(folder, "--resume")
            self.assert_whole(folder)
        finally:
            subprocess.run(["umount", str(disk)], check=False)

    # ------------------------------------------------------------------------------------------------------------ requests
    def ask(self, name, request, code):
        """Starts a run, asks for something as soon as it has begun, and waits for the end."""
        folder = self.folder(name)
        process = subprocess.Popen(self.command(folder, "--set", "Output/Checkpoint interval=0"), stdout=subprocess.PIPE, stderr=subprocess.STDOUT, universal_newlines=True)
        until = time.monotonic() + 60
        while not (folder / "history.csv").is_file() or len((folder / "history.csv").read_text().splitlines()) < 2:
            self.assertLess(time.monotonic(), until)
            time.sleep(0.005)
        request(process, folder)
        said, _ = process.communicate(timeout=300)
        self.assertEqual(process.returncode, code, said)
        return folder, said

    def stops(self, name, request):
        folder, said = self.ask(name, request, 3)
        self.assertIn("Stopped as asked for; --resume goes on from here.", said)
        self.assertLess(len(self.rows(folder)), len(self.rows(self.whole)))
        self.assertIn("outcome,stopped", (folder / "summary.csv").read_text())
        self.run_to_end(folder, "--resume")
        self.assert_whole(folder)

    def test_sigterm(self):
        self.stops("sigterm", lambda process, folder: process.send_signal(signal.SIGTERM))

    def test_stop_file(self):
        self.stops("stop_file", lambda process, folder: (folder / "stop").touch())

    def test_sigusr1(self):
        folder, _ = self.ask("sigusr1", lambda process, folder: process.send_signal(signal.SIGUSR1), 0)
        self.assertEqual(len(self.checkpoints(folder)), 1)
        self.assertEqual(self.rows(folder), self.rows(self.whole))
        self.run_to_end(folder, "--resume")
        self.assert_whole(folder)

    def test_by_the_clock(self):
        folder = self.folder("clock")
        self.run_to_end(folder, "--set", "Output/Checkpoint interval=0", "--set", "Output/Checkpoint wall interval=0.001")
        self.assertEqual(len(self.checkpoints(folder)), 2)
        self.assertEqual(self.rows(folder), self.rows(self.whole))

    # ---------------------------------------------------------------------------------------------------------- parameters
    def test_longer(self):
        folder = self.copied("longer")
        said = self.run_to_end(folder, "--resume", "--set", "Scene/End time=1.2")
        self.assertIn("Resumed at time 1,", said)
        rows = self.rows(folder)
        self.assertEqual(rows[:21], self.rows(self.whole)[:21])
        self.assertEqual([float(row[0]) for row in rows[1:]], [float(f"{i * STEP:.10g}") for i in range(25)])

    def test_other_parameters(self):
        folder = self.copied("others")
        said = self.run_to_end(folder, "--resume", "--set", "Scene/Viscosity ratio=2", "--set", "Time/Scheme=BDF3", code=1)
        self.assertIn("Scene/Viscosity ratio: got 2; allowed: 1", said)
        self.assertIn("Time/Scheme: got BDF3; allowed: BDF2", said)
        self.assert_whole(folder)

    def test_shorter_steps(self):
        folder = self.copied("shorter")
        shutil.rmtree(self.checkpoints(folder)[-1])
        self.run_to_end(folder, "--resume", "--set", f"Time/Step={STEP / 2}")
        rows = self.rows(folder)
        self.assertEqual(rows[:20], self.rows(self.whole)[:20])
        self.assertEqual([float(row[0]) for row in rows[20:]], [0.925, 0.95, 0.975, 1.])

    def test_of_a_study(self):
        said = self.run_to_end(self.folder("study"), "--resume", "--set", "Study/Vary=step", code=1)
        self.assertIn("--resume is for single runs", said)


if __name__ == "__main__":
    parser = argparse.ArgumentParser()
    parser.add_argument("program")
    parser.add_argument("prm")
    parser.add_argument("--kills", type=int, default=KILLS)
    parser.add_argument("--seed", type=int, default=SEED)
    arguments, rest = parser.parse_known_args()
    PROGRAM, SCENE, KILLS, SEED = os.path.abspath(arguments.program), os.path.abspath(arguments.prm), arguments.kills, arguments.seed
    unittest.main(argv=[sys.argv[0], *rest])
