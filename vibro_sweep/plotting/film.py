"""The motion of one orbit as a film: the masses between their stops, time history and phase portrait in step."""

import tempfile
from collections.abc import Sequence
from pathlib import Path

import numpy as np
from matplotlib.animation import FFMpegWriter, FuncAnimation, PillowWriter
from matplotlib.patches import Rectangle

from vibro_sweep.plotting.drawn_sweep import DrawnSweep
from vibro_sweep.plotting.figure import Panels, Picture
from vibro_sweep.plotting.kind import picture
from vibro_sweep.plotting.orbit_pictures import displacements, shows_trajectory
from vibro_sweep.plotting.picture_files import PlotError
from vibro_sweep.plotting.plot_options import PlotOptions
from vibro_sweep.plotting.stored_motion import stored_motion
from vibro_sweep.plotting.style import DASHES, FAINT, INK, SECTION, symbol
from vibro_sweep.results.motion import Motion

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
        """The film as a file of one of `FILMS`. Raises PlotError where there is no ffmpeg for .mp4."""
        if suffix == ".mp4" and not FFMpegWriter.isAvailable():
            raise PlotError("output: .mp4 needs ffmpeg, which is not installed; name a .gif")
        writer = PillowWriter(RATE) if suffix == ".gif" else FFMpegWriter(RATE)
        with tempfile.TemporaryDirectory() as folder:
            place = Path(folder) / f"film{suffix}"
            self.animation().save(place, writer, dpi=self.resolution)
            return place.read_bytes()


class _OfAnOrbit(Film):
    def begin(self, motion: Motion, masses: Sequence[str], unit: str) -> None:
        """motion : without gaps, its t in forcing periods; masses : names of the positions that are shown; unit : of
        the gap"""
        self.times, (name, rate) = motion.t, motion.names
        self.gap, self.rate = values, rates = motion[name], motion[rate]
        grid = self.add_gridspec(2, 2, height_ratios=(1, 2), width_ratios=(3, 2))
        above, left, right = self.add_subplot(grid[0, :]), self.add_subplot(grid[1, 0]), self.add_subplot(grid[1, 1])
        left.plot(self.times, values, color=FAINT, lw=0.6)
        right.plot(values, rates, color=FAINT, lw=0.6)
        for stop in motion.stops.values():
            left.axhline(stop, color=INK, lw=0.8, ls=DASHES)
            right.axvline(stop, color=INK, lw=0.8, ls=DASHES)
        left.set(xlabel="$t / T$ (forcing periods)", ylabel=symbol(name) + unit, xlim=(self.times[0], self.times[-1]))
        right.set(xlabel=symbol(name) + unit)
        rows = {position: motion[position] for position in dict.fromkeys((name, *masses))}
        places = list(motion.stops.values())
        self.boxes, ends = [], np.concatenate([*rows.values(), places])
        low, high = ends.min(), ends.max()
        size = 0.06 * (high - low)
        for row, (each, place) in enumerate(rows.items()):
            self.boxes.append(
                (above.add_patch(Rectangle((0, -row - 0.3), size, 0.6, color=INK if not row else FAINT)), place)
            )
            above.text(low - 2 * size, -row, symbol(each), ha="right", va="center")
        self.stops = []
        for side, stop in motion.stops.items():  # beside the mass or the gap that meets it
            outwards = size / 2 if stop == max(places) and stop > values.mean() else -size / 2
            line = above.plot([stop + outwards] * 2, [-0.45, 0.45], color=INK, lw=3, solid_capstyle="butt")[0]
            self.stops.append((line, stop + outwards + side * motion.force(side)[1]))
        above.set(xlim=(low - 4 * size, high + 2 * size), ylim=(-len(rows) + 0.4, 0.6))
        above.set_axis_off()
        self.size = size
        self.lines = [left.plot([], [], color=INK, lw=1.2)[0], right.plot([], [], color=INK, lw=1.2)[0]]
        self.dots = [ax.plot([], [], "o", color=SECTION, markersize=5)[0] for ax in (left, right)]
        self.show(FRAMES - 1)  # what a still picture has

    def show(self, i: int) -> None:
        at = round(i / (FRAMES - 1) * (len(self.times) - 1))
        for box, place in self.boxes:
            box.set_x(place[at] - self.size / 2)
        for line, place in self.stops:
            line.set_xdata([place[at]] * 2)
        for line, dot, (x, y) in zip(
            self.lines, self.dots, ((self.times, self.gap), (self.gap, self.rate)), strict=True
        ):
            line.set_data(x[: at + 1], y[: at + 1])
            dot.set_data([x[at]], [y[at]])


@picture(shows_trajectory, of_orbits=True)
def film(result: DrawnSweep) -> Panels:
    """The masses between their stops, time history and phase portrait of an orbit; moving in a .gif or .mp4."""
    point = result.points(1)[0]
    title = f"{result.title('Film')}\n{point.label}" if point.label else result.title("Film")
    motion = stored_motion(result, point).joined()
    masses = [name for name in displacements(result) if name != "gap"]

    def draw(figure):
        figure.resolution = result.options.dpi or figure.resolution
        figure.begin(motion, masses, result.unit(motion.names[0]))

    return Panels(title, HEIGHT, draw, figure=_OfAnOrbit)


def film_of(motion: Motion, title: str) -> Film:
    """A film of evenly sampled motion; t in forcing periods."""
    masses = [name for name in motion.states if name.startswith("x")]
    panels = Panels(title, HEIGHT, lambda figure: figure.begin(motion, masses, ""), figure=_OfAnOrbit)
    return PlotOptions().draw(panels)[0].figure
