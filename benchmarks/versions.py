"""Two versions of this package, row by row: python benchmarks/versions.py BEFORE [AFTER] [--rows PATTERN]

BEFORE and AFTER (by default this checkout) are checkouts. The scripts of this folder run in processes of their own
against either one, by public names only; the two take turns, and the median of the ratios counts: what else the
machine does meanwhile hits both. `--pairs` are processes of each, as where the memory of one happens to lie makes it
some per cent faster or slower for good. A row that a version does not have is left out, with the reason.

The least version is 0.2: git worktree add ../before dfd88ceb
"""

import argparse
import importlib
import json
import os
import re
import statistics
import subprocess
import sys
import tempfile
from contextlib import ExitStack
from pathlib import Path

from bench import ROOT, digits, table

SCRIPTS = ("speed", "branches_and_curves", "scaling", "first_minutes")


class Version:
    """A script that runs against a checkout."""

    def __init__(self, script: str, checkout: Path, cache: str, stack: ExitStack):
        environment = os.environ | {"PYTHONPATH": str(checkout), "NUMBA_CACHE_DIR": cache}
        environment.pop("PYTHONDONTWRITEBYTECODE", None)  # else each start would compile the modules again
        command = [sys.executable, str(ROOT / "benchmarks" / f"{script}.py"), "--turns"]
        pipe, nothing = subprocess.PIPE, subprocess.DEVNULL
        self.process = subprocess.Popen(command, env=environment, stdin=pipe, stdout=pipe, stderr=nothing, text=True)
        stack.callback(self.process.wait)
        stack.callback(self.process.stdin.close)
        imported = json.loads(self.process.stdout.readline())
        assert Path(imported).is_relative_to(checkout), f"{imported} is not of {checkout}"

    def measure(self, row: str) -> float | str:
        """The figure of a row, or why there is none."""
        self.process.stdin.write(row + "\n")
        self.process.stdin.flush()
        return json.loads(self.process.stdout.readline())


def compared(row: str, pairs: list[tuple[Version, Version]], rounds: int) -> list:
    """Row, medians of both, and of their ratio; the first figures of each process do not count."""
    found, first = [], [version.measure(row) for pair in pairs for version in pair]
    if reasons := [one for one in first if isinstance(one, str)]:
        return [row, *("-" if isinstance(one, str) else digits(one) for one in first[:2]), reasons[0][:60]]
    for turn in range(rounds):
        for pair in pairs:
            order = (0, 1) if turn % 2 else (1, 0)
            values = {which: pair[which].measure(row) for which in order}
            found.append((values[0], values[1]))
    before, after = (statistics.median(column) for column in zip(*found, strict=True))
    return [row, digits(before), digits(after), f"{statistics.median(a / b for a, b in found):.3f}"]


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.partition(":")[0])
    parser.add_argument("checkouts", type=Path, nargs="+", metavar="CHECKOUT")
    parser.add_argument("--rows", default="", metavar="PATTERN", help="of the names of rows")
    parser.add_argument("--rounds", type=int, default=7)
    parser.add_argument("--pairs", type=int, default=2)
    parser.add_argument("--json", action="store_true")
    chosen = parser.parse_args()
    both, lines = [path.resolve() for path in (*chosen.checkouts, ROOT)[:2]], []
    for script in SCRIPTS:
        rows = [row for row in importlib.import_module(script).ROWS if re.search(chosen.rows, row)]
        with ExitStack() as stack:
            caches = [stack.enter_context(tempfile.TemporaryDirectory()) for _ in both]
            if rows:
                where = list(zip(both, caches, strict=True))
                pairs = [tuple(Version(script, *place, stack) for place in where) for _ in range(chosen.pairs)]
            for row in rows:
                first = row.startswith("first run")
                lines.append(compared(row, pairs[: 1 if first else None], 1 if first else chosen.rounds))
                print(" | ".join(lines[-1]), file=sys.stderr, flush=True)
    header = ("", *(path.name for path in both), "times faster")
    print(json.dumps([dict(zip(("row", "before", "after", "ratio"), line, strict=True)) for line in lines])
          if chosen.json else table(header, lines))  # fmt: skip


if __name__ == "__main__":
    main()
