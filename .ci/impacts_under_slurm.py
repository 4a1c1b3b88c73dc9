"""A comparison and a diagnosis whose beds and impacts are tasks of a running SLURM: the numbers of this machine alone.

usage: impacts_under_slurm.py PLUNGE

Each command is killed once while it waits, and goes on by itself.
"""

import json
import shutil
import subprocess
import sys
import time
from pathlib import Path

SET = "cli/tests/runs/two-impacts"
MODEL = "configs/schema/tests/good/small-2d.toml"
CANDIDATES = ["--candidate", "rolling-resistance", "--candidate", "grain-friction"]
VERBS = {"compare": [], "diagnose": CANDIDATES}


def require(condition, what):
    if not condition:
        raise AssertionError(what)


def under_slurm(plunge, verb, folder):
    def command(where):
        options = ["--cache", str(folder / where), "--out", str(folder / f"out-{where}"), "--on", where]
        return [plunge, verb, SET, "--model", MODEL, "--json", "--quiet", *VERBS[verb], *options]

    def impacts(where):
        return {file.name: file.stat().st_ino for file in (folder / where / "impacts").glob("*.impact")}

    start = time.monotonic()
    waiting = subprocess.Popen(command("slurm"), stdout=subprocess.DEVNULL)
    while len(impacts("slurm")) < 2 and waiting.poll() is None:
        time.sleep(0.1)
    require(waiting.poll() is None, f"{verb} ended with {waiting.returncode} before it could be killed")
    waiting.kill()
    waiting.wait()
    before = impacts("slurm")
    told = {where: subprocess.run(command(where), check=True, capture_output=True) for where in ["slurm", "local"]}
    numbers = {where: json.loads(one.stdout) for where, one in told.items()}
    for one in numbers.values():
        one.pop("cost", None)
    require(numbers["slurm"] == numbers["local"], numbers)
    after = impacts("slurm")
    require(after.keys() == impacts("local").keys(), "other impacts were run")
    require(all(after[name] == file for name, file in before.items()), "an impact was run twice")
    print(
        f"slurm: {verb}, {len(after)} impacts, killed with {len(before)} of them done, "
        f"in {time.monotonic() - start:.0f} s"
    )


def main():
    plunge = str(Path(sys.argv[1]).resolve())
    folder = Path("target").resolve() / "ci-impacts"
    shutil.rmtree(folder, ignore_errors=True)
    for verb in VERBS:
        (folder / verb).mkdir(parents=True)
        under_slurm(plunge, verb, folder / verb)


main()
