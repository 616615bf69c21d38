"""Run every benchmark and write report.md with its figures: `python benchmarks/report.py` (`--quick`: reduced;
`--before CHECKOUT`: beside another version, too).

Nothing else should run on the machine meanwhile.
"""

import time
from functools import partial
from pathlib import Path

import compile_time
import driver
import estimates
import floor
import masses
import scaling
import speed
import versions
import work_precision
from book import GOAL_HEADER, Goal, arguments, machine, section, table

ROOMS = (speed, work_precision, floor, masses, scaling, driver, estimates, compile_time)


def beside(checkout: Path, quick: bool) -> tuple[str, list[Goal]]:
    """The part about another version."""
    rows = versions.measure(checkout, 6 if quick else versions.ROUNDS)
    return f"## Beside version {versions.commit_of(checkout)}\n\n{versions.text(rows, checkout)}", versions.goals(rows)


def main() -> None:
    chosen = arguments(__doc__, before=True)
    chosen.output.mkdir(parents=True, exist_ok=True)
    about, parts, goals, began = machine(), [], [], time.perf_counter()
    reduced = "A reduced run (`--quick`): it shows that everything works; its figures are rough.\n\n" * chosen.quick
    path = chosen.output / "report.md"
    jobs = [(room.TITLE, partial(section, room, chosen.quick, chosen.output)) for room in ROOMS]
    if chosen.before is not None:
        jobs.insert(0, (versions.TITLE, partial(beside, chosen.before, chosen.quick)))
    for title, job in jobs:
        print(f"{title} ...", flush=True)
        part, reached = job()
        parts.append(part)
        goals += reached
        took = f"- {time.perf_counter() - began:.0f} s, by `python benchmarks/report.py{' --quick' * chosen.quick}`"
        head = (
            f"# Speed against error\n\n{reduced}{about}{took}\n\n## Goals\n\nA ratio of at least 1 meets the goal.\n\n"
        )
        path.write_text("\n".join([head + table(GOAL_HEADER, [goal.row() for goal in goals]), *parts]))
    print(f"{path} after {time.perf_counter() - began:.0f} s")


if __name__ == "__main__":
    main()
