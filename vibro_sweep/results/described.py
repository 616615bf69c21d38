"""What is said of a variable to those who read its file: by CF, and for axes of pictures."""

from typing import Any

import numpy as np

from vibro_sweep.oscillator.wording import sentence
from vibro_sweep.tables.quantity import Observable, Quantity


def described(of: Quantity, units: str) -> dict[str, Any]:
    """The attributes of a variable in these units: `long_name` is short, for axes; `description` is a sentence."""
    attributes = {"units": units, "long_name": of.long_name, "description": sentence(of.text)}
    if of.flags:
        attributes |= {"flag_values": np.array(of.codes, of.dtype), "flag_meanings": " ".join(of.flags)}
    return attributes | (dict(of.attributes) if isinstance(of, Observable) else {})
