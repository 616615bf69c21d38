"""The frame of tangent vectors of an oscillator."""

import numpy as np

from vibro_sweep.engine.points.contact import contact_coordinates, natural_coordinates
from vibro_sweep.engine.points.frame import Frame, frame_of
from vibro_sweep.oscillator.linear import stacked


def frame_of_one(system) -> Frame:
    q = stacked([system.linear])
    natural = natural_coordinates(q, contact_coordinates(q))
    return Frame(*(one[0] for one in frame_of(natural, q.omega, np.zeros(1, int))))
