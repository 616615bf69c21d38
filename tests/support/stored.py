"""Small sweeps of three and six points, and a run of one that is broken off."""

import pytest

import vibro_sweep as vs
from support.oscillators import PAPER_NUMBERS
from support.scene_texts import parsed

SYSTEM = f"system: {{{PAPER_NUMBERS}, b: 6.6}}\norbit: {{transient: 3, record: 4}}\n"
SWEEP = "sweep: {b: {values: [6.5, 6.6, 6.7]}}\n"
PLANE = "sweep: {R: {values: [0.7, 0.8]}, b: {values: [6.5, 6.6, 6.7]}}\n"
ALL = "observe: [section, lyapunov, impacts]\n"
SECTION = {"x1", "v1", "x2", "v2", "period", "approached_period", "approached_distance", "approached_factor"}
LYAPUNOV = {"lyapunov", "lyapunov_residual", "lyapunov_error"}
IMPACTS = {"impacts_right", "impacts_left", "min_impact_speed", "contact_error", "sticking_time"}


def scene_of(text):
    return parsed(SYSTEM + text, "some/folder/the_scene.yaml")


class Interruption(Exception):  # noqa: N818
    pass


def broken_off(scene, path, mode="new"):
    """The file of a run that ends after its first block."""

    def progress(done, _):
        if done:
            raise Interruption

    with pytest.raises(Interruption):
        vs.run(scene, path, workers=1, progress=progress, mode=mode, block=1)
    return path
