"""A sweep of 1 MB in some ten blocks, and a run of it that meets a fault."""

import pytest

import vibro_sweep as vs
from support.oscillators import PAPER_NUMBERS

TEXT = f"""
system: {{{PAPER_NUMBERS}, b: 6.6}}
sweep: {{b: {{start: 6.5, stop: 6.9, num: 400}}}}
orbit: {{transient: 5, record: 60}}
observe: [section, lyapunov, impacts]
"""  # 1 MB
BLOCK = 40  # points of which a worker computes at once


def counted(text):
    """What `info` says: done, missing, failed."""
    words = [line.split() for line in text.splitlines()]
    return tuple(
        int(line[1].replace(",", "")) for line in words if line and line[0] in ("computed", "missing", "failed")
    )


def failing_run(scene, path, words, after=3, fault=lambda: None, mode="new"):
    """The message of a run that meets `fault` after some blocks."""
    seen = []

    def progress(done, _):
        seen.append(done)
        if len(seen) == after + 1:
            fault()

    with pytest.raises(vs.StoreError, match=words) as error:
        vs.run(scene, path, workers=1, progress=progress, mode=mode, block=BLOCK)
    assert "\n" not in str(error.value)
    return str(error.value), seen
