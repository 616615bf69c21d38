"""The dimensions that variables have beside those of the sweep, and how long they are."""

import functools
from typing import NamedTuple

from vibro_sweep.model.state import state


class Dimension(NamedTuple):
    """A variable's own dimension, with its coordinate; without `extent` the scene decides how long it is."""

    label: str
    text: str
    extent: int | None = None
    units: str = "1"

    @property
    def long_name(self) -> str:
        return self.label


def averaged(masses: int) -> tuple[str, ...]:
    """The dimensions of what all orbits of an attractor have in common."""
    return (*state(masses), "impacts_right", "impacts_left", "lyapunov")


@functools.cache
def dimensions(masses: int) -> dict[str, Dimension]:
    """The dimensions that variables may have, for so many masses."""
    return {
        "start": Dimension("start", "start of the orbit"),
        "sample": Dimension("section point", "section point, counted from the end of the transient"),
        "exponent": Dimension("exponent", "Lyapunov exponent, counted from the largest", 2 * masses),
        "multiplier": Dimension("multiplier", "Floquet multiplier, counted from that of largest modulus", 2 * masses),
        "averaged": Dimension(
            "average of", "section points, impacts and contacts in a forcing period, lambda_1", len(averaged(masses))
        ),
        "elapsed": Dimension("forcing periods recorded", "forcing periods since the end of the transient"),
        "t_over_T": Dimension("time t/T", "forcing periods since the last section point"),
        "trajectory_section": Dimension("time t/T", "forcing periods since the last section point"),
        "trajectory_impact": Dimension("impact", "impact along the orbit, counted from the last section point"),
    }


DIMENSIONS = dimensions(2)  # of the paper's oscillator
