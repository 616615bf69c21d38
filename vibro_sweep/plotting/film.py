"""The motion of one orbit as a film: the masses between their stops, time history and phase portrait in step."""

import tempfile
from pathlib import Path

import numpy as np
from matplotlib.animation import FFMpegWriter, FuncAnimation, PillowWriter
from matplotlib.patches import Rectangle

from vibro_sweep.plotting import pressed
from vibro_sweep.plotting.orbit_pictures import displacements
from vibro_sweep.plotting.page import Picture, page
from vibro_sweep.plotting.paths import path
from vibro_sweep.plotting.style import DASHES, FAINT, INK, SECTION, symbol
from vibro_sweep.plotting.sweep_result import PlotError, Result
from vibro_sweep.results.motion import Motion

SUFFIXES = (".gif", ".mp4")
FRAMES, RATE = 200, 20  # ten seconds
HEIGHT = 3.8  # inches


class Film(Picture):
    """A figure that moves; `show(i)` draws one of its FRAMES."""

    resolution: float = 80  # pixels an inch of a file

    def show(self, i: int) -> None:
        raise NotImplementedError

    def animation(self) -> FuncAnimation:
        """The film, as matplotlib and notebooks show it."""
        self.draw_without_rendering()
        self.set_layout_engine("none")  # each frame would be laid out anew
        return FuncAnimation(self, self.show, FRAMES, interval=1000 / RATE, repeat=True)

    def encoded(self, suffix: str) -> bytes:
        """The film as a file of one of `SUFFIXES`. Raises PlotError where there is no ffmpeg for .mp4."""
        if suffix == ".mp4" and not FFMpegWriter.isAvailable():
            raise PlotError("output: .mp4 needs ffmpeg, which is not installed; name a .gif")
        writer = PillowWriter(RATE) if suffix == ".gif" else FFMpegWriter(RATE)
        with tempfile.TemporaryDirectory() as folder:
            place = Path(folder) / f"film{suffix}"
            self.animation().save(place, writer, dpi=self.resolution)
            return place.read_bytes()


class _OfAnOrbit(Film):
    def begin(self, t, positions: dict[str, np.ndarray], gap: tuple, stops, unit: str) -> "_OfAnOrbit":
        """t : (n,) in forcing periods; positions : of each mass (n,); gap : its name, values and rates (n,);
        stops : where each stands, and by how much it is pressed in (n,)"""
        self.times, self.positions, self.gap = t, positions, gap
        grid = self.add_gridspec(2, 2, height_ratios=(1, 2), width_ratios=(3, 2))
        above, left, right = self.add_subplot(grid[0, :]), self.add_subplot(grid[1, 0]), self.add_subplot(grid[1, 1])
        name, values, rates = gap
        left.plot(t, values, color=FAINT, lw=0.6)
        right.plot(values, rates, color=FAINT, lw=0.6)
        for stop in stops:
            left.axhline(stop, color=INK, lw=0.8, ls=DASHES)
            right.axvline(stop, color=INK, lw=0.8, ls=DASHES)
        left.set(xlabel="$t / T$ (forcing periods)", ylabel=symbol(name) + unit, xlim=(t[0], t[-1]))
        right.set(xlabel=symbol(name) + unit)
        rows = {name: values} if name not in positions else {}
        rows |= positions
        self.boxes, ends = [], np.concatenate([*rows.values(), list(stops)])
        low, high = ends.min(), ends.max()
        size = 0.06 * (high - low)
        for row, (each, place) in enumerate(rows.items()):
            self.boxes.append(
                (above.add_patch(Rectangle((0, -row - 0.3), size, 0.6, color=INK if not row else FAINT)), place)
            )
            above.text(low - 2 * size, -row, symbol(each), ha="right", va="center")
        self.stops = []
        for stop, moved in stops.items():  # beside the mass or the gap that meets it
            outwards = size / 2 if stop == max(stops) and stop > values.mean() else -size / 2
            line = above.plot([stop + outwards] * 2, [-0.45, 0.45], color=INK, lw=3, solid_capstyle="butt")[0]
            self.stops.append((line, stop + outwards + moved))
        above.set(xlim=(low - 4 * size, high + 2 * size), ylim=(-len(rows) + 0.4, 0.6))
        above.set_axis_off()
        self.size = size
        self.lines = [left.plot([], [], color=INK, lw=1.2)[0], right.plot([], [], color=INK, lw=1.2)[0]]
        self.dots = [ax.plot([], [], "o", color=SECTION, markersize=5)[0] for ax in (left, right)]
        self.show(FRAMES - 1)  # what a still picture has
        return self

    def show(self, i: int) -> None:
        at = round(i / (FRAMES - 1) * (len(self.times) - 1))
        _, values, rates = self.gap
        for box, place in self.boxes:
            box.set_x(place[at] - self.size / 2)
        for line, place in self.stops:
            line.set_xdata([place[at]] * 2)
        for line, dot, (x, y) in zip(self.lines, self.dots, ((self.times, values), (values, rates)), strict=True):
            line.set_data(x[: at + 1], y[: at + 1])
            dot.set_data([x[at]], [y[at]])


def film(result: Result) -> Film:
    """The masses between their stops, time history and phase portrait of an orbit; moving in a .gif or .mp4."""
    if result.ax is not None:
        raise PlotError("ax: a film has a figure of its own")
    point = result.points(1)[0]
    way, names = path(result, point), displacements(result)
    first = names[0]
    rate = "gap_velocity" if first == "gap" else "v1"
    there = np.isfinite(way[first]) & np.isfinite(way["x1"])
    positions = {name: way[name][there] for name in names if name != "gap"}
    title = f"{result.title('Film')}\n{point.label}" if point.label else result.title("Film")
    gap = (first, way[first][there], way[rate][there])
    stops = {
        stop: side * pressed.along(result, point, way, side)[1][there]
        for side, stop in result.stops(point.place).items()
    }
    moving = result.options.page(HEIGHT, title, _OfAnOrbit)
    moving.resolution = result.options.dpi or moving.resolution
    return moving.begin(way.t[there], positions, gap, stops, result.unit(first))


def film_of(motion: Motion, name: str, period: float, title: str) -> Film:
    """A film of evenly sampled motion with the positions of its masses; name : of the gap; period : of the force"""
    stops = {stop: side * motion.force(side)[1] for side, stop in motion.stops.items()}
    gap = name, motion.gap, motion.rate
    return page(HEIGHT, title, kind=_OfAnOrbit).begin(motion.t / period, motion.positions, gap, stops, "")
