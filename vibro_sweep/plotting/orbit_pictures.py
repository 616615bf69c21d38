"""Pictures of single orbits: phase portrait, time history, section points one after another."""

import numpy as np
from matplotlib.ticker import MaxNLocator

from vibro_sweep.plotting import sticking_marks
from vibro_sweep.plotting.drawn_motion import contacts, legend, levels, portrait, walls
from vibro_sweep.plotting.drawn_sweep import DrawnSweep
from vibro_sweep.plotting.figure import Panels
from vibro_sweep.plotting.kind import picture
from vibro_sweep.plotting.stored_motion import GAP, gap_of, stored_motion
from vibro_sweep.plotting.style import (
    DASHES,
    FAINT,
    INK,
    LEFT,
    RIGHT,
    SECTION,
    at_section,
    before_impact,
    limits,
    stop_name,
    stop_names,
    symbol,
)
from vibro_sweep.plotting.sweeps import section_variables
from vibro_sweep.tables.coordinates import MOST_MASSES, state

FINER = 32  # times the samples of a file, where a compliant stop is pressed


def shows_trajectory(result: DrawnSweep) -> bool:
    """A trajectory."""
    return all(name in result for name in ("trajectory_x1", "trajectory_v1", "t_over_T"))


def shows_both_masses(result: DrawnSweep) -> bool:
    """A trajectory with the second mass."""
    return shows_trajectory(result) and "trajectory_x2" in result


def shows_section(result: DrawnSweep) -> bool:
    """Section points."""
    return "x1" in result or "v1" in result


def _portraits(result, subject, draw) -> Panels:
    """A panel for each orbit; draw(ax, point)."""
    points = result.points()
    columns = min(len(points), 2)
    rows = -(-len(points) // columns)

    def draw_all(axes):
        for ax in axes.flat[len(points) :]:
            ax.set_axis_off()
        for ax, point in zip(axes.flat, points, strict=False):
            draw(ax, point)
            ax.set_title(point.label)
        legend(axes)

    return Panels(result.title(subject), 3.0 * rows + 0.7 if columns > 1 else 5.0, draw_all, rows, columns)


def _histories(result, subject, draw, label) -> Panels:
    """The orbits below each other; draw(ax, point). label : of the common abscissa"""
    points = result.points()

    def draw_all(axes):
        for ax, point in zip(axes[:, 0], points, strict=True):
            draw(ax, point)
            ax.set_title(point.label)
        axes[-1, 0].set_xlabel(label)
        legend(axes)

    height = 1.5 * len(points) + 0.9 if len(points) > 1 else 3.2
    return Panels(result.title(subject), height, draw_all, len(points), grid={"sharex": True})


def displacements(result: DrawnSweep) -> tuple[str, ...]:
    """The displacements that a trajectory of the file has; first the gap where that is not x1."""
    gap = ("gap",) if result.contact_normal is not None else ()
    names = (f"x{n}" for n in range(1, MOST_MASSES + 1))
    return (*gap, *(name for name in names if f"trajectory_{name}" in result and f"trajectory_v{name[1:]}" in result))


def _velocity(name: str) -> str:
    """The name of the velocity of a displacement."""
    return "gap_velocity" if name == "gap" else f"v{name[1:]}"


def _symbol(name: str) -> str:
    return r"$\dot g$" if name == "gap_velocity" else symbol(name)


@picture(shows_trajectory, displacements, of_orbits=True)
def phase_portrait(result: DrawnSweep) -> Panels:
    """x1 and v1 between the stops, or another displacement and its velocity, one panel an orbit; impacts, and the state
    at each forcing period. Where the gap is not x1, that and its velocity."""
    x_name = result.options.variable or displacements(result)[0]
    v_name = _velocity(x_name)

    def draw(ax, point):
        motion = stored_motion(result, point)
        first = x_name == motion.names[0]
        motion = motion if first or result.contact_normal is not None else motion.joined()
        if first and motion.laws and not len(motion.impacts):
            motion = motion.joined().finer(FINER)
        portrait(ax, motion, x_name, v_name)
        if first:
            walls(ax, motion.stops, motion.laws, stop_names(result))
        _mark_sections(ax, result, point, x_name, v_name)
        ax.set(xlabel=_symbol(x_name) + result.unit(x_name), ylabel=_symbol(v_name) + result.unit(v_name))

    return _portraits(result, "Phase portrait", draw)


@picture(shows_both_masses, of_orbits=True)
def configuration(result: DrawnSweep) -> Panels:
    """The first two masses' displacements against each other (the paper's figure 4), one panel an orbit."""

    def draw(ax, point):
        motion = stored_motion(result, point).joined()
        portrait(ax, motion, "x1", "x2")
        if result.contact_normal is None:
            walls(ax, motion.stops, motion.laws, stop_names(result))
        elif not result.contact_normal[2:].any():
            _slanted_walls(ax, result, motion)
        _mark_sections(ax, result, point, "x1", "x2")
        ax.set(xlabel=symbol("x1") + result.unit("x1"), ylabel=symbol("x2") + result.unit("x2"))

    return _portraits(result, "Configuration plane", draw)


def _slanted_walls(ax, result, motion):
    """The stops of a contact between masses 1 and 2: n1 x1 + n2 x2 = gap."""
    frame = ax.get_xlim(), ax.get_ylim()
    n1, n2 = result.contact_normal[:2]
    for side, stop in motion.stops.items():
        style = {"color": FAINT, "lw": 0.8, "ls": "-" if side > 0 else DASHES, "zorder": 1}
        if n2:
            ax.plot(frame[0], (stop - n1 * np.array(frame[0])) / n2, label=stop_name(result, side), **style)
        else:
            ax.axvline(stop / n1, label=stop_name(result, side), **style)
    ax.set(xlim=frame[0], ylim=frame[1])


def shows_poincare(result: DrawnSweep) -> bool:
    """Section points with a displacement and its velocity; of impacts the phase and the velocity."""
    return bool(abscissae(result))


def abscissae(result: DrawnSweep) -> tuple[str, ...]:
    """The abscissae of a Poincare plot, the default first; the ordinate is the velocity."""
    if "phase" in result:
        return ("phase",) if "v1" in result and not result.model() else ()  # the map has one phase
    return tuple(f"x{n}" for n in range(1, MOST_MASSES + 1) if f"x{n}" in result and f"v{n}" in result)


@picture(shows_poincare, abscissae, of_orbits=True)
def poincare(result: DrawnSweep) -> Panels:
    """Section points in the plane of x1 and v1, or of x2 and v2; of impacts of phase and v1. One panel an orbit."""
    x_name = result.options.variable or abscissae(result)[0]
    v_name = "v1" if x_name == "phase" else _velocity(x_name)

    def draw(ax, point):
        x, v = (result.at_point(name, point) for name in (x_name, v_name))
        size = np.clip(60 / np.sqrt(_different(x)), 2, 8)
        ax.plot(x, v, ".", color=SECTION, markersize=size, markeredgewidth=0, rasterized=True)
        if np.isfinite(x).any():
            least = 0.01 * abs(result.number("b", point.place) or 0.0)
            ax.set(xlim=limits(x, least), ylim=limits(v, least))
        if x_name == "x1" and result.contact_normal is None:
            stops = result.stops(point.place)
            walls(ax, stops, [side for side in stops if result.compliance(side, point.place)], stop_names(result))
        name = before_impact if "phase" in result else at_section
        phase = r"$\omega t$ mod $2\pi$" if x_name == "phase" else None
        ax.set(xlabel=phase or name(x_name) + result.unit(x_name), ylabel=name(v_name) + result.unit(v_name))

    return _portraits(result, "Poincaré section", draw)


def _different(values) -> int:
    """The number of points that one can distinguish, at least 1."""
    known = values[np.isfinite(values)]
    return len(np.unique(np.round(known / (np.ptp(known) or 1.0), 3))) if len(known) else 1


def _mark_sections(ax, result, point, x_name, y_name):
    if "trajectory_section_x1" in result:
        names = state(result.masses)
        here = {
            name: result.at_point(f"trajectory_section_{name}", point) for name in names if _at_section(name) in result
        }
        if result.contact_normal is not None:
            here |= {name: gap_of(here, result.contact_normal, letter) for name, letter in GAP.items()}
        x, y = here[x_name], here[y_name]
        ax.plot(x, y, "o", color=SECTION, markersize=3.5, label=r"$t = 0$ mod $T$", zorder=3)


def _at_section(name: str) -> str:
    return f"trajectory_section_{name}"


def coordinates(result: DrawnSweep) -> tuple[str, ...]:
    """The coordinates that a trajectory of the file has."""
    return tuple(name for name in state(MOST_MASSES) if f"trajectory_{name}" in result)


@picture(shows_trajectory, coordinates, of_orbits=True)
def history(result: DrawnSweep) -> Panels:
    """All displacements over time, or one coordinate, one panel an orbit, the stops as lines."""
    chosen = result.options.variable
    gap = [] if result.contact_normal is None else ["gap"]
    names = [chosen] if chosen else [*gap, *(name for name in coordinates(result) if name.startswith("x"))]
    styles = [{"color": INK}, {"color": RIGHT, "ls": (0, (4, 1))}, {"color": LEFT, "ls": (0, (1, 1))}, {"color": FAINT}]

    def draw(ax, point):
        motion = stored_motion(result, point)
        for i, name in enumerate(names):
            jumps = name.startswith("v") and (name == "v1" or result.contact_normal is not None)
            shown = motion if jumps else motion.joined()
            ax.plot(shown.t, shown[name], label=_symbol(name), **styles[min(i, len(styles) - 1)])
            if name == motion.names[0]:
                sticking_marks.along(ax, shown, "t", name)
                contacts(ax, shown, "t", name)
        if motion.names[0] in names:
            levels(ax, motion, stop_names(result))
        ax.margins(x=0)
        ax.set_ylabel((symbol(chosen) if chosen else "displacement") + result.unit(names[0]))

    return _histories(result, "Time history", draw, "$t / T$ (forcing periods)")


@picture(shows_section, section_variables, of_orbits=True)
def iteration(result: DrawnSweep) -> Panels:
    """The section's coordinate over the iterations (the paper's figures 7 and 8), one panel an orbit."""
    at_impact = "phase" in result
    name = result.options.variable or section_variables(result)[0]
    transient = result.number("transient")
    after = "" if transient is None else f" after {transient:.0f} periods of transient"
    most = 1

    def draw(ax, point):
        nonlocal most
        values = result.at_point(name, point)
        ax.plot(values, "-", color=FAINT, lw=0.3)
        ax.plot(values, ".", color=INK, markersize=np.clip(60 / np.sqrt(len(values)), 3, 8), markeredgewidth=0)
        ax.set_ylabel((before_impact if at_impact else symbol)(name) + result.unit(name))
        ax.xaxis.set_major_locator(MaxNLocator(integer=True, min_n_ticks=1, steps=[1, 2, 2.5, 5, 10]))
        if np.isfinite(values).any():
            ax.set_ylim(limits(values))
            most = max(most, np.flatnonzero(np.isfinite(values))[-1] + 1)
        margin = max(0.5, 0.01 * most)
        ax.set_xlim(-margin, most - 1 + margin)  # of all orbits, which share it

    label = ("impact" if at_impact else "iteration") + " $n$" + after
    return _histories(result, "Iteration of the section", draw, label)
