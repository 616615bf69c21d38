"""Runs killed at random moments, resumed, and compared bit for bit with one that was left alone: a Markdown table.

    python benchmarks/kills.py [--kills 100] [--workers 2] [--seed 1]

Each time the command line runs a scene of some seconds and gets a SIGKILL at a moment drawn uniformly from the time
that the whole run takes; then it is resumed to its end. Every block leaves a line in a log when it is begun and when it
is computed, so that the work lost is measured, in blocks: one for each that was computed but not yet written, and of
each that was being computed the share of its time that had gone by. It should be about the number of workers at most.
"""

import argparse
import collections
import os
import signal
import statistics
import subprocess
import sys
import tempfile
import time
from pathlib import Path
from typing import NamedTuple

import h5py
import numpy as np
from book import table

POINTS = 4000
SCENE = f"""
system: {{mu_m: 10, mu_k: 5, zeta: 0.05, f2: 0, omega: 0.63, R: 0.8}}
sweep: {{b: {{start: 6.5, stop: 6.9, num: {POINTS}}}}}
orbit: {{transient: 12000, record: 100}}
observe: [section, lyapunov, impacts]
"""

# The program, with a line in a log for each block that is begun or computed: its first point, its end, the time.
PROGRAM = """
import os, sys, time
from vibro_sweep import cli, compute, pool
log = os.open(sys.argv[1], os.O_WRONLY | os.O_APPEND | os.O_CREAT)
plain = compute.compute
def logged(block):
    place = f"{block.box[0].start} {block.box[0].stop}"
    os.write(log, f"{place} {time.monotonic()}\\n".encode())
    result = plain(block)
    os.write(log, f"{place} {time.monotonic()}\\n".encode())
    return result
pool.compute = logged
sys.exit(cli.main(["run", *sys.argv[2:]]))
"""


class Kill(NamedTuple):
    when: str
    points: int  # computed again
    blocks: int  # begun again
    work: float  # lost, in blocks


def start(log, scene, output, workers):
    options = ["--workers", str(workers), "--resume", "--quiet"]
    return subprocess.Popen([sys.executable, "-c", PROGRAM, log, scene, "-o", output, *options])


def killed(scene, folder, workers, moment):
    """One run killed after `moment` seconds and resumed: what was lost, and the file."""
    output, logs = folder / "out.h5", [folder / "first", folder / "second"]
    process = start(logs[0], scene, output, workers)
    try:
        process.wait(moment)
    except subprocess.TimeoutExpired:
        process.send_signal(signal.SIGKILL)
        process.wait()
    end = time.monotonic()
    part, journal = Path(f"{output}.part"), Path(f"{output}.part.journal")
    if output.exists():
        when = "after the end"
    elif not part.exists():
        when = "before the file existed"
    else:
        when = f"in mid-run, journal {'in use' if journal.stat().st_size > 1000 else 'empty'}"
    if start(logs[1], scene, output, workers).wait() != 0:
        raise SystemExit(f"the run killed after {moment} s cannot be resumed")
    first, second = map(blocks, logs)
    again = [times for place, times in first.items() if place in second]
    points = sum(len(range(*place)) for place in [*first, *second]) - POINTS
    whole = [times[1] - times[0] for times in [*first.values(), *second.values()] if len(times) == 2]
    usual = statistics.median(whole)  # the first block of each worker takes longer: it loads the compiled code
    work = sum(1 if len(times) == 2 else min(1, (end - times[0]) / usual) for times in again)
    return Kill(when, points, len(again), work), output


def blocks(log):
    """(first point, end) of each block -> when it was begun and, if it was, computed."""
    result = collections.defaultdict(list)
    for line in log.read_text().splitlines() if log.exists() else []:
        first, end, moment = line.split()
        result[int(first), int(end)].append(float(moment))
    return result


def arrays(path):
    with h5py.File(path) as file:
        return {name: dataset[()].tobytes() for name, dataset in file.items()}


def measure(kills, workers, seed):
    """What each kill cost; seconds of the whole run; whether all arrays are the same."""
    rng, found, same = np.random.default_rng(seed), [], True
    with tempfile.TemporaryDirectory() as folder:
        folder = Path(folder)
        scene, whole = folder / "scene.yaml", folder / "whole.h5"
        scene.write_text(SCENE)
        for _ in range(2):  # the first one compiles
            whole.unlink(missing_ok=True)
            began = time.monotonic()
            start(os.devnull, scene, whole, workers).wait()
            seconds = time.monotonic() - began
        expected = arrays(whole)
        for k in range(kills):
            place = folder / str(k)
            place.mkdir()
            kill, output = killed(scene, place, workers, rng.uniform(0, seconds))
            same &= arrays(output) == expected
            found.append(kill)
    return found, seconds, same


def report(found, seconds, same, workers) -> str:
    groups = collections.defaultdict(list)
    for kill in found:
        groups[kill.when].append(kill)
    rows = []
    for when, kills in sorted(groups.items()):
        begun, work = [kill.blocks for kill in kills], [kill.work for kill in kills]
        ends = f"{np.mean(work):.2f}", f"{max(work):.2f}"
        rows.append((when, len(kills), sum(kill.points for kill in kills), max(begun), *ends))
    header = ("killed", "runs", "points computed again", "blocks begun again, most", "work lost, mean", "most")
    every, again = POINTS * len(found), sum(kill.points for kill in found)
    return (
        f"{table(header, rows)}\n{len(found)} runs of {seconds:.1f} s with {workers} workers, each killed once. After "
        f"they were resumed all arrays are {'' if same else 'NOT '}equal bit for bit to those of an undisturbed run. "
        f"Work is in blocks; of {every:,} points {again:,} were computed again ({100 * again / every:.2g} %)."
    )


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--kills", type=int, default=100)
    parser.add_argument("--workers", type=int, default=2)
    parser.add_argument("--seed", type=int, default=1)
    chosen = parser.parse_args()
    print(report(*measure(chosen.kills, chosen.workers, chosen.seed), chosen.workers))


if __name__ == "__main__":
    main()
