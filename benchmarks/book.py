"""What every benchmark needs to be read afterwards: goals, tables, the machine, figures, a command line.

A benchmark is a module with measure(quick) -> data, figure(data) -> Figure or None, text(data) -> Markdown, and
goals(data) -> list of `Goal`.
"""

import argparse
import os
import platform
import sys
import tempfile
from datetime import UTC, datetime
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path
from types import ModuleType
from typing import NamedTuple

from matplotlib import rc_context
from matplotlib.figure import Figure

from vibro_sweep.plotting.style import STYLE

HERE = Path(__file__).parent
PACKAGES = ("vibro_sweep", "numpy", "numba", "llvmlite", "heyoka", "scipy", "scikit-sundae", "mpmath", "h5py")


class Goal(NamedTuple):
    """A row of the report. `ratio` is reached/asked, or asked/reached where less is better: at least 1 is good."""

    asked: str
    reached: str
    ratio: float
    command: str

    def row(self) -> tuple[str, ...]:
        return self.asked, self.reached, f"{self.ratio:.2f}", "yes" if self.ratio >= 1 else "no", f"`{self.command}`"


GOAL_HEADER = ("goal", "reached", "ratio", "met", "again by")


def table(header, rows) -> str:
    """A Markdown table; columns after the first are aligned right."""
    rule = ["---"] + ["---:"] * (len(header) - 1)
    return "\n".join("| " + " | ".join(map(str, row)) + " |" for row in (header, rule, *rows)) + "\n"


def digits(value: float, count: int = 3) -> str:
    """A number with so many significant digits."""
    return f"{float(f'{value:.{count}g}'):.10g}" if 1e-3 <= abs(value) < 1e5 or value == 0 else f"{value:.1e}"


def machine() -> str:
    """Machine, versions, date and load, as Markdown."""
    names = [line.split(":", 1)[1].strip() for line in _read("/proc/cpuinfo").splitlines() if "model name" in line]
    load = ", ".join(f"{value:.2f}" for value in os.getloadavg())
    return "\n".join(
        [
            f"- {datetime.now(UTC):%Y-%m-%d %H:%M} UTC; load over 1, 5, 15 minutes at the beginning: {load}",
            f"- {names[0] if names else platform.processor()}, {os.cpu_count()} cores; {platform.system()} "
            f"{platform.release()}; Python {platform.python_version()}",
            "- " + ", ".join(f"{name} {installed(name)}" for name in PACKAGES),
            "",
        ]
    )


def installed(name: str) -> str:
    try:
        return version(name)
    except PackageNotFoundError:
        return "not installed"


def _read(path: str) -> str:
    try:
        return Path(path).read_text()
    except OSError:
        return ""


def save(fig: Figure, folder: Path, name: str) -> Path:
    path = folder / "figures" / f"{name}.png"
    path.parent.mkdir(parents=True, exist_ok=True)
    with rc_context(STYLE):  # ticks are made when the figure is drawn
        fig.savefig(path)
    return path


def styled(draw):
    """Run a drawing function in the package's style."""

    def styled_draw(*arguments):
        with rc_context(STYLE):
            return draw(*arguments)

    return styled_draw


def arguments(description: str, before: bool = False) -> argparse.Namespace:
    parser = argparse.ArgumentParser(description=description)
    parser.add_argument("--quick", action="store_true", help="everything in reduced form: shows that it works")
    parser.add_argument(
        "-o", "--output", type=Path, help="folder of the results (default: this one; with --quick a temporary one)"
    )
    if before:
        parser.add_argument("--before", type=Path, metavar="CHECKOUT", help="another version, to be compared with")
    chosen = parser.parse_args()
    if chosen.output is None:
        chosen.output = Path(tempfile.mkdtemp(prefix="vibro_sweep_benchmarks_")) if chosen.quick else HERE
    return chosen


def section(room: ModuleType, quick: bool, output: Path) -> tuple[str, list[Goal]]:
    """Run one benchmark: its part of the report, and its goals."""
    data = room.measure(quick)
    text, fig = room.text(data), room.figure(data)
    if fig is not None:
        path = save(fig, output, room.__name__)
        text = f"![{room.TITLE}]({path.relative_to(output)})\n\n{text}"
    return f"## {room.TITLE}\n\n{text}", room.goals(data)


def main(room_name: str) -> None:
    """The command line of one benchmark: prints its part of the report."""
    room = sys.modules[room_name]
    room.__name__ = Path(room.__file__).stem
    chosen = arguments(room.__doc__)
    text, goals = section(room, chosen.quick, chosen.output)
    print(text + "\n" + table(GOAL_HEADER, [goal.row() for goal in goals]) + f"\nfigures in {chosen.output}/figures")
