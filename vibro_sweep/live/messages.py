"""Messages to a page: a text of JSON, or arrays behind such a text, which the page reads without copying."""

import json
from collections.abc import Mapping
from typing import Any

import numpy as np

ALIGNED = 8  # bytes, of the beginning of each array


def text_message(type: str, seq: int, **values: Any) -> str:
    """A message without arrays."""
    return json.dumps({"type": type, "seq": seq} | values, allow_nan=False)


def binary_message(type: str, seq: int, arrays: Mapping[str, np.ndarray], **values: Any) -> bytes:
    """A message with arrays: uint32 length of the padded text, the text, then the arrays, each padded.

    The text has `arrays`: name, type and length of each, in their order.
    """
    packed = {name: np.ascontiguousarray(array.astype(array.dtype.newbyteorder("<"))) for name, array in arrays.items()}
    described = [[name, array.dtype.name, array.size] for name, array in packed.items()]
    text = json.dumps({"type": type, "seq": seq, "arrays": described} | values, allow_nan=False).encode()
    text += b" " * (-(4 + len(text)) % ALIGNED)
    parts = [np.uint32(len(text)).astype("<u4").tobytes(), text]
    for array in packed.values():
        data = array.tobytes()
        parts += [data, b"\0" * (-len(data) % ALIGNED)]
    return b"".join(parts)


def number(value: float) -> float | None:
    """A number for JSON, which has no infinities."""
    return float(value) if np.isfinite(value) else None
