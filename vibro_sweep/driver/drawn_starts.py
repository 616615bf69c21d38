"""Where the orbits of a block start."""

import numpy as np

from vibro_sweep.driver.blocks import Block
from vibro_sweep.oscillator.grid import linears
from vibro_sweep.oscillator.linear import rest_state
from vibro_sweep.tables.coordinates import start, state

ATTEMPTS = 100  # at a state with the gap between the stops


def starts_of(block: Block) -> np.ndarray:
    """(points, starts, 2 N): given; held by a stop; or random, by the point's place alone."""
    masses = block.system.masses
    shape = tuple(len(values) for values in block.axes.values())
    count = int(np.prod(shape))
    if isinstance(block.starts, tuple):
        return _random(block, count, masses)
    result = np.broadcast_to(block.starts, (count, *block.starts.shape)).copy()
    for i, name in enumerate(start(masses)):
        if name in block.axes:
            result[..., i] = block.parameters[name].reshape(-1, 1)
    if block.from_rest:
        result[..., 0::2] = rest_state(linears(block.system, block.axes)).reshape(count, 1, masses)
    return result


def _random(block: Block, count: int, masses: int) -> np.ndarray:
    """States uniform in |x_i - offset| < |b|, |v_i| < omega |b|, or in the box of the scene, with the gap between the
    stops.

    Of one stop alone with b < 0 these x_i are all behind it, and are drawn as far away on its free side.
    """
    each, seed, box = block.starts
    ranges = [(state(masses).index(name), low, high) for name, low, high in box]
    along, stops = block.system.linear.contact.normal, block.system.options.get("stops", "both")
    numbers = {"offset": np.zeros(block.indices.shape)} | block.parameters
    result = np.empty((count, block.part.stop - block.part.start, 2 * masses))
    for n, place in enumerate(np.ndindex(block.indices.shape)):
        b, offset, omega = (numbers[name][place] for name in ("b", "offset", "omega"))
        low = offset - b if stops != "right" else -np.inf
        high = offset + b if stops != "left" else np.inf
        middle = offset if b >= 0 else high - abs(b) if stops == "right" else low + abs(b)
        draw = np.random.Generator(np.random.Philox(key=seed, counter=[0, 0, 0, int(block.indices[place])]))
        states = np.empty((each, 2 * masses))
        again = np.ones(each, bool)
        for _ in range(ATTEMPTS):
            shares = draw.uniform(-1.0, 1.0, (np.count_nonzero(again), 2 * masses))
            drawn = shares * abs(b)
            drawn[:, 0::2] += middle
            drawn[:, 1::2] *= omega
            for i, least, most in ranges:
                drawn[:, i] = least + (shares[:, i] + 1) / 2 * (most - least)
            states[again] = drawn
            gap = states[:, 0::2] @ along
            again = (gap < low) | (gap > high)
            if not again.any():
                break
        else:  # the masses lie around the middle of the stops, their gap does not: it is moved there
            bottom = low if high == np.inf else max(low, high - 2 * abs(b))
            top = high if low == -np.inf else min(high, low + 2 * abs(b))
            target = draw.uniform(bottom, top, each)
            states[again, 0::2] += np.outer(target - gap, along / (along @ along))[again]
        result[n] = states[block.part]
    return result
