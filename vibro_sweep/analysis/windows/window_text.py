"""What `repr` says of windows."""

from typing import TYPE_CHECKING

from vibro_sweep.analysis.branches.branch_text import event
from vibro_sweep.analysis.periodic.orbit_text import LINES, repr_text
from vibro_sweep.oscillator.wording import itinerary_text, without_rounding

if TYPE_CHECKING:
    from vibro_sweep.analysis.windows.window import Window, Windows


def of_window(window: "Window") -> str:
    held = "".join(f", {name} = {value:.10g}" for name, value in window.held.items())
    lines = [
        f"<Window {_window(window)}{held}",
        f"{window.points:,} orbits of the sweep; {window.other_attractor:,} at its values went to another attractor",
        f"begins with {event(window.lower)}",
        f"ends with {event(window.upper)}",
    ]
    return repr_text(lines)


def title(windows: "Windows") -> str:
    return f"Windows in {windows.parameter}: {len(windows)}; {len(windows.unvisited)} stretches that the sweep missed"


def of_windows(windows: "Windows") -> str:
    lines = [_window(one) for one in windows[: LINES - 2]]
    more = len(windows) - len(lines)
    return repr_text([f"<{title(windows)}", *lines, *([f"and {more:,} more"] if more else [])])


def _window(window: "Window") -> str:
    kind = ", symmetric" if window.symmetric else ""
    lo, hi = (without_rounding(end, window.hi - window.lo) for end in (window.lo, window.hi))
    return f"{lo:.10g} .. {hi:.10g}: {itinerary_text(window.itinerary)}, period {window.period}{kind}"
