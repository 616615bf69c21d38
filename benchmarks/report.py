"""Run every benchmark and write report.md with its figures: `python benchmarks/report.py` (`--quick`: reduced).

Nothing else should run on the machine meanwhile.
"""

import time

import compile_time
import driver
import floor
import masses
import scaling
import speed
import work_precision
from book import GOAL_HEADER, arguments, machine, section, table

ROOMS = (speed, work_precision, floor, masses, scaling, driver, compile_time)


def main() -> None:
    chosen = arguments(__doc__)
    chosen.output.mkdir(parents=True, exist_ok=True)
    about, parts, goals, began = machine(), [], [], time.perf_counter()
    reduced = "A reduced run (`--quick`): it shows that everything works; its figures are rough.\n\n" * chosen.quick
    path = chosen.output / "report.md"
    for room in ROOMS:
        print(f"{room.TITLE} ...", flush=True)
        part, reached = section(room, chosen.quick, chosen.output)
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
