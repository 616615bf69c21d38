"""Run every benchmark and write report.md with its figures: `python benchmarks/report.py` (`--quick`: reduced).

Nothing else should run on the machine meanwhile.
"""

import time

import compile_time
import floor
import scaling
import speed
import work_precision
from book import GOAL_HEADER, arguments, machine, section, table

ROOMS = (speed, work_precision, floor, scaling, compile_time)


def main() -> None:
    chosen = arguments(__doc__)
    chosen.output.mkdir(parents=True, exist_ok=True)
    about, parts, goals, began = machine(), [], [], time.perf_counter()
    for room in ROOMS:
        print(f"{room.TITLE} ...", flush=True)
        part, reached = section(room, chosen.quick, chosen.output)
        parts.append(part)
        goals += reached
    reduced = "A reduced run (`--quick`): it shows that everything works; its figures are rough.\n\n" * chosen.quick
    head = (
        f"# Speed against error\n\n{reduced}{about}- {time.perf_counter() - began:.0f} s, by `python "
        f"benchmarks/report.py{' --quick' * chosen.quick}`\n\n## Goals\n\nA ratio of at least 1 meets the goal.\n\n"
        + table(GOAL_HEADER, [goal.row() for goal in goals])
    )
    path = chosen.output / "report.md"
    path.write_text("\n".join([head, *parts]))
    print(f"{path} after {time.perf_counter() - began:.0f} s")


if __name__ == "__main__":
    main()
