"""Numbers and units that a caller gives, checked by what is declared of them."""

import math
from typing import Any

from vibro_sweep.model.real import array_of
from vibro_sweep.tables.units import SI, Units

UNITS_ALLOWED = "SI, or three positive numbers: what a mass, a length and a time of 1 are in kg, m and s"


def units_from(value: Any) -> Units | None:
    """None for values that are not units: neither the word SI nor three positive numbers."""
    if isinstance(value, str):
        return SI if value == "SI" else None
    found = array_of(value, 1)
    if found is None or found.shape != (3,) or not all(0 < one < math.inf for one in found.tolist()):
        return None
    return Units(*found.tolist())
