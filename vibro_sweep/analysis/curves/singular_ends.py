"""The end of a curve whose steps fail: where its contacts are singular, each kind tried in turn."""

from dataclasses import replace

import numpy as np

from vibro_sweep.analysis.branches.split_contacts import joined_contacts
from vibro_sweep.analysis.curves.curve_record import CurveRecord
from vibro_sweep.analysis.curves.touch_at_contact import touch_at_contact
from vibro_sweep.analysis.curves.vanishing_preload import without_preload
from vibro_sweep.analysis.periodic.periodic_orbit import orbit_of
from vibro_sweep.engine.continuation.workspace import THETA, Place


def end_where_steps_fail(record: CurveRecord, last: Place) -> None:
    """Record the end beside the last place, `failed` where none is found."""
    if not any(ends(record, last) for ends in (contacts_join, touch_reaches_contact, preload_vanishes, contact_grazes)):
        record.add_special("failed", last, np.nan)


def contacts_join(record: CurveRecord, last: Place) -> bool:
    """Whether two contacts become one beside the place; then the curve ends there."""
    found = joined_contacts(record.curve, record.curve.solution(last), float(last.p[THETA]))
    if found is None:
        return False
    (event, _, place, error), both = found
    record.add_solution(place.p.copy(), both)
    point = record.special_point("split", place, error, event, place.curve)
    record.special.append(replace(point, orbit=orbit_of(point.orbit.system, both)))
    return True


def touch_reaches_contact(record: CurveRecord, last: Place) -> bool:
    """Whether the touch of a curve of grazes comes to the contact beside it; then the curve ends there."""
    found = touch_at_contact(record.curve, last)
    if found is None:
        return False
    record.add(found[0])
    record.add_special("split", *found)
    return True


def preload_vanishes(record: CurveRecord, last: Place) -> bool:
    """Whether a contact vanishes together with the preload of its stop; then the curve ends there."""
    place = without_preload(record.curve, record.curve.solution(last), last.p)
    if place is None:
        return False
    record.add_solution(np.append(place.p[:2], last.p[THETA]), place.solution)
    record.add_special("boundary", place, 0.0, curve=place.curve)
    return True


def contact_grazes(record: CurveRecord, last: Place) -> bool:
    """Whether a contact whose length has no digits has its graze beside the place; then the curve ends there."""
    found = record.short.graze_beside(last)
    if found is not None:
        record.add_event(found)
    return found is not None
