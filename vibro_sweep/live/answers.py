"""The answers to a page's requests. Each is made in the engine's thread, a sweep piece by piece."""

from collections.abc import Callable, Iterator
from typing import Any

import numpy as np

from vibro_sweep.checks.errors import ArgumentError
from vibro_sweep.live.clicked_orbit import Settled, orbit_message, settled
from vibro_sweep.live.frames import Frame, frames
from vibro_sweep.live.messages import binary_message, number, text_message
from vibro_sweep.live.model_words import model_words
from vibro_sweep.live.pace import Pace
from vibro_sweep.live.requests import ClickedOrbit, OfOneOrbit, Open, Save, Sweep, WindowEnds
from vibro_sweep.live.views import height_of, needed, scene_of_view, view_of
from vibro_sweep.live.window_ends import window_message
from vibro_sweep.oscillator.grazing import grazing
from vibro_sweep.scene import Scene

EXPONENTS = ("lyapunov", "lyapunov_error")

Message = str | bytes


class Answers:
    """What one page is answered. It keeps where the orbits of its last diagram have ended."""

    def __init__(self, presets: dict[str, Scene], first: str, pace: Pace):
        self._presets, self._first, self._pace = presets, first, pace
        self._complete: tuple[Any, np.ndarray] | None = None  # view and ends, (columns, starts, 2 N), of the diagram

    def diagram(self, request: Sweep) -> Iterator[Message]:
        """The frames of a diagram."""
        view, scene = request.view, scene_of_view(request.view)
        system = scene.system
        wanted = [*needed(system, view.y), "period", *EXPONENTS, "end"]
        values = next(iter(scene.sweep.values()))
        ends = np.full((len(values), scene.n_starts, 2 * system.masses), np.nan)
        shared = {"columns": len(values), "starts": scene.n_starts, "middle": request.middle, "record": scene.record}
        shared |= _lines(scene)
        self._complete = None
        for frame in frames(scene, variables=wanted, pace=self._pace):
            dots, arrays = _dots(frame, scene, view.y, request.middle)
            if frame.kind == "preview":
                arrays["axis"] = values
            else:
                end = frame.arrays["end"]
                ends[frame.box[0], frame.box[1] if len(frame.box) > 1 else slice(None)] = end.reshape(
                    len(end), -1, end.shape[-1]
                )
            if frame.last:
                self._complete = view, ends
            yield binary_message("frame", request.seq, arrays | dots, **shared, **_place(frame))

    def click(self, request: ClickedOrbit | Open | Save) -> Message:
        """The answer to what takes a moment."""
        if isinstance(request, ClickedOrbit):
            return self.orbit(request)
        return self.opened(request) if isinstance(request, Open) else self.saved(request)

    def orbit(self, request: ClickedOrbit) -> Message:
        """The orbit at a value."""
        settled_orbit, went_on = self._settled(request)
        arrays, words = orbit_message(settled_orbit)
        words |= {"value": request.value, "start": request.start, "went_on": went_on}
        return binary_message("orbit", request.seq, arrays, **words)

    def window(self, request: WindowEnds, progress: Callable[[int, float], None]) -> Message:
        """Why a window ends. progress : called while branches are followed"""
        settled_orbit, _ = self._settled(request)
        arrays, words = window_message(request.view, request.value, settled_orbit, progress)
        return binary_message("window", request.seq, arrays, value=request.value, **words)

    def opened(self, request: Open) -> Message:
        """A scene, or the system of a view, with all that the page shows of it."""
        name = request.name or (self._first if request.view is None else "")
        if name and name not in self._presets:
            raise ArgumentError(f"there is no scene {name!r}")
        view = view_of(self._presets[name]) if name else request.view
        words = {"view": view.model_dump(), "name": name, "presets": [*self._presets]}
        return text_message("model", request.seq, **words, **model_words(scene_of_view(view), view))

    def saved(self, request: Save) -> Message:
        """A view as a scene."""
        return text_message("saved", request.seq, text=scene_of_view(request.view).to_yaml())

    def _settled(self, request: OfOneOrbit) -> tuple[Settled, bool]:
        """The orbit, and whether it goes on from the end of the one in the diagram."""
        (view, ends), column = self._complete or (None, ()), request.column
        if view == request.view and 0 <= column < len(ends):
            end = ends[column, min(request.start, ends.shape[1] - 1)]
            if np.isfinite(end).all():
                return settled(request.view, request.value, request.start, end), True
        return settled(request.view, request.value, request.start, None), False


def _place(frame: Frame) -> dict[str, Any]:
    """Which columns and starts are in a frame."""
    along = frame.box[0]
    starts = frame.box[1] if len(frame.box) > 1 else slice(0, None)
    step = along.step or 1
    place = {"kind": frame.kind, "first": along.start or 0, "step": step, "length": len(frame.arrays["status"])}
    return place | {
        "first_start": starts.start,
        "last": frame.last,
        "exact": frame.exact,
        "ms": round(1e3 * frame.seconds, 2),
    }


def _dots(frame: Frame, scene: Scene, y: str, middle: float) -> tuple[dict[str, np.ndarray], dict[str, np.ndarray]]:
    """Section points, of a periodic orbit the last ones, and how many each orbit has; and what else is drawn."""
    height = height_of(scene.system, y, frame.arrays)
    height = height.reshape(-1, height.shape[-1])
    status = frame.arrays["status"]
    shown = np.isfinite(height)
    arrays = {"status": status.ravel()}
    if frame.kind == "piece":
        period = frame.arrays["period"].ravel()
        if scene.section.kind == "phase":  # one point a forcing period: the last `period` points are all of them
            last = (
                np.arange(height.shape[1]) >= height.shape[1] - np.where(period > 0, period, height.shape[1])[:, None]
            )
            shown &= last
        arrays["period"] = period.astype(np.int32)
        arrays |= {name: frame.arrays[name].astype("f4").ravel() for name in EXPONENTS}
    return {"count": shown.sum(axis=1).astype(np.uint32), "y": (height[shown] - middle).astype("f4")}, arrays


def _lines(scene: Scene) -> dict[str, Any]:
    """The grazing clearances, where the clearance is swept."""
    if "b" not in scene.sweep:
        return {}
    graze = grazing(scene.system)
    clearances = {number(graze.b_right), number(graze.b_left)} - {None}
    return {"b_star": sorted(clearances)}
