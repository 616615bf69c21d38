"""The frame of tangent vectors of an oscillator."""

from vibro_sweep.engine.coordinates.contact import contact_coordinates, natural_coordinates
from vibro_sweep.engine.coordinates.frame import Frame, frame_of
from vibro_sweep.oscillator.linear import stacked


def frame_of_one(system) -> Frame:
    q = stacked([system.linear])
    return Frame(*(one[0] for one in frame_of(natural_coordinates(q, contact_coordinates(q)), q.omega)))
