"""b in parts of the grazing clearance b* (Theorem 1): it separates what lies close to it."""

import numpy as np

from vibro_sweep.plotting.picture_files import PlotError
from vibro_sweep.plotting.style import axis_name, symbol


def check_relative(name: str, keys, b_star) -> None:
    """Raises PlotError unless b is among the keys and b* (numbers, or None) is known."""
    if "b" not in keys:
        raise PlotError(f"relative: {name} has no b to divide by b*")
    if b_star is None or not np.all(np.isfinite(b_star)):
        raise PlotError(f"relative: {name} has no grazing clearance to divide by")


def axis_label(key: str, relative: bool, unit: str = "") -> str:
    return f"{symbol('b')}$/${symbol('b_star')}" if relative and key == "b" else axis_name(key, unit)
