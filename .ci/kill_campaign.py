"""Runs a campaign of 200 points while it is killed 20 times at random, and fails unless each point is done once.

usage: kill_campaign.py PLUNGE local|slurm [KILLS] [SEED]

`local` kills `plunge sweep` itself; `slurm` kills, by SIGKILL, tasks and `plunge sweep --on slurm`, and requeues
and cancels tasks as an administrator would. What was killed is started again by the same command. A point
was done twice if its `done.json` is ever another file than it was.
"""

import json
import os
import random
import shutil
import signal
import subprocess
import sys
import time
from collections import Counter
from pathlib import Path

POINTS = 200

CAMPAIGN = """\
[campaign]
name = "kills"
models = ["two-term-vector"]

[sample]
method = "sobol"
count = 200
[sample.ranges]
impact.speed = ["0.5 m/s", "4 m/s"]
intruder.mass = ["20 g", "80 g"]
"""

# Longest wait for anything (s).
PATIENCE = 900


def require(condition, what):
    if not condition:
        raise AssertionError(what)


class Campaign:
    def __init__(self, plunge, folder):
        self.plunge = str(Path(plunge).resolve())
        self.folder = folder
        self.file = folder / "kills.toml"
        self.out = folder / "out"
        self.file.write_text(CAMPAIGN)
        # Of every done.json: the file that it was when it was first seen.
        self.seen = {}

    def command(self, *more):
        return [self.plunge, "sweep", str(self.file), "--out", str(self.out), "--quiet", *more]

    def look(self):
        """How many points are done; none of them may be done again."""
        for done in self.out.glob("points/*/done.json"):
            now = done.stat()
            identity = (now.st_ino, now.st_mtime_ns)
            before = self.seen.setdefault(done.parent.name, identity)
            require(before == identity, f"{done.parent.name} was done twice")
        return len(self.seen)

    def check(self):
        """Every point of the plan is done, and no other."""
        planned = {point["hash"] for point in json.loads((self.out / "points.json").read_text())["points"]}
        require(len(planned) == POINTS, f"{len(planned)} points are planned")
        self.look()
        require(set(self.seen) == planned, "the points that are done are not those of the plan")
        for point in planned:
            done = json.loads((self.out / "points" / point / "done.json").read_text())
            require(done["status"] == "done" and done["hash"] == point, done)
        # The same command collects and runs nothing.
        told = json.loads(subprocess.run(self.command("--json"), check=True, capture_output=True).stdout)
        require(told["done"] == POINTS and told["waiting"] == 0, told)
        self.look()


def kill_locally(campaign, kills, dice):
    """Kills `plunge sweep` so many times, each after a random part of the work."""
    struck = Counter()
    while struck["plunge sweep"] < kills:
        target = min(POINTS, campaign.look() + dice.randrange(1, POINTS // kills - 2))
        sweep = subprocess.Popen(campaign.command("--threads", "2"))
        while sweep.poll() is None and campaign.look() < target:
            time.sleep(dice.uniform(0, 0.004))
        if sweep.poll() is not None:
            require(sweep.returncode == 0, f"it ended with {sweep.returncode}")
            break
        sweep.kill()
        sweep.wait()
        struck["plunge sweep"] += 1
        campaign.look()
    subprocess.run(campaign.command(), check=True, stdout=subprocess.DEVNULL)
    return struck


def tasks_of_points(plunge):
    """Processes of this program that run a point."""
    for entry in Path("/proc").iterdir():
        if entry.name.isdigit():
            try:
                words = (entry / "cmdline").read_bytes().split(b"\0")
            except OSError:
                continue
            if words[0] == plunge.encode() and b"--point" in words:
                yield int(entry.name)


def queue():
    """Tasks in the queue of SLURM, with their states."""
    listed = subprocess.run(["squeue", "-h", "-r", "-o", "%i %T"], check=True, capture_output=True, text=True)
    return [line.split() for line in listed.stdout.splitlines()]


def submit(campaign):
    subprocess.run(campaign.command("--on", "slurm"), check=True, stdout=subprocess.DEVNULL)


def strike(campaign, dice):
    """One thing that befalls a campaign; what it was, or nothing if there was nothing to befall."""
    kind = dice.choice(["task killed"] * 3 + ["task requeued"] * 3 + ["task cancelled", "submission killed"])
    if kind == "submission killed":
        sweep = subprocess.Popen(campaign.command("--on", "slurm"), stdout=subprocess.DEVNULL)
        time.sleep(dice.uniform(0, 0.05))
        if sweep.poll() is not None:
            return None
        sweep.kill()
        sweep.wait()
        return kind
    if kind == "task killed":
        tasks = list(tasks_of_points(campaign.plunge))
        if not tasks:
            return None
        try:
            os.kill(dice.choice(tasks), signal.SIGKILL)
        except ProcessLookupError:
            return None
        return kind
    running = [task for task, state in queue() if state == "RUNNING"]
    if not running:
        return None
    order = ["scontrol", "requeue"] if kind == "task requeued" else ["scancel", "--signal=KILL", "--full"]
    done = subprocess.run([*order, dice.choice(running)], capture_output=True)
    return kind if done.returncode == 0 else None


def kill_under_slurm(campaign, kills, dice):
    struck, end = Counter(), time.monotonic() + PATIENCE
    while campaign.look() < POINTS:
        require(time.monotonic() < end, f"{campaign.look()} points after {PATIENCE} s")
        if not queue():
            submit(campaign)
        # Kills are spread over the campaign: none before its share of the points is done.
        elif sum(struck.values()) < kills and campaign.look() * kills >= sum(struck.values()) * POINTS:
            befell = strike(campaign, dice)
            if befell:
                struck[befell] += 1
        time.sleep(0.02)
    # What a killed submission has left in the queue finds every point done.
    subprocess.run(["scancel", "--user", str(os.getuid())], check=True)
    return struck


def main():
    plunge, where = sys.argv[1:3]
    kills = int(sys.argv[3]) if len(sys.argv) > 3 else 20
    seed = int(sys.argv[4]) if len(sys.argv) > 4 else 1
    folder = Path("target").resolve() / f"ci-kills-{where}"
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir(parents=True)
    campaign, start = Campaign(plunge, folder), time.monotonic()
    struck = {"local": kill_locally, "slurm": kill_under_slurm}[where](campaign, kills, random.Random(seed))
    campaign.check()
    told = ", ".join(f"{kind} {count} times" for kind, count in sorted(struck.items()))
    require(sum(struck.values()) >= kills, f"only {told}")
    print(f"{where}: {POINTS} points, each done once, in {time.monotonic() - start:.0f} s; {told}")


main()
