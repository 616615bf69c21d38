"""How the Lyapunov exponents of an orbit were found, period by period."""

import numpy as np

from vibro_sweep.plotting.drawn_motion import legend
from vibro_sweep.plotting.drawn_sweep import DrawnSweep
from vibro_sweep.plotting.figure import Panels
from vibro_sweep.plotting.kind import picture
from vibro_sweep.plotting.style import DASHES, INK, exponent, exponent_colour, exponents_name, limits


def shows_convergence(result: DrawnSweep) -> bool:
    """Exponents as they converge."""
    return "lyapunov_running" in result


@picture(shows_convergence, of_orbits=True)
def convergence(result: DrawnSweep) -> Panels:
    """The spectrum as it was computed, period by period: lambda_1 beside zero, and below all of them. Up to two orbits.

    Where the file has them: a dashed line at each final value, around it a band in which zero would not differ from it.
    """
    points = result.points(2)
    grid = {"sharex": True, "sharey": "row", "height_ratios": (1.2, 1)}
    title = result.title("Convergence of the Lyapunov exponents")
    return Panels(title, 5.2, lambda axes: _draw(axes, result, points), 2, len(points), grid)


def _draw(grid, result, points) -> None:
    periods = result.coordinate("elapsed")
    settled = slice(len(periods) // 10, None)
    for (largest, spectrum), point in zip(grid.T, points, strict=True):
        running = np.where(np.isfinite(values := result.at_point("lyapunov_running", point)), values, np.nan)
        for i in range(running.shape[1]):
            spectrum.plot(periods, running[:, i], color=exponent_colour(i), label=exponent(i + 1), zorder=3 - i / 9)
        order = np.argsort(-np.nan_to_num(running[-1], nan=-np.inf))
        largest.plot(periods, running[:, order[0]], color=exponent_colour(order[0]))
        text = point.label
        if "lyapunov" in result:
            text = "\n".join(filter(None, [text, _final_values((largest, spectrum), result, point)]))
        largest.axhline(0, color=INK, lw=0.6)
        largest.set_title(text)
        spectrum.set_xlabel("forcing periods recorded")
        spectrum.set_xlim(0, periods[-1])
    for row, shown in zip(grid, (slice(0, 1), slice(None)), strict=True):
        values = [
            np.sort(result.at_point("lyapunov_running", point)[settled], axis=1)[:, ::-1][:, shown] for point in points
        ]
        finite = np.concatenate([v[np.isfinite(v)] for v in values] + [[0.0]])
        row[0].set_ylim(limits(finite))
    unit = result.unit("lyapunov_running")
    grid[0, 0].set_ylabel(exponents_name(1, unit))
    grid[1, 0].set_ylabel(exponents_name("i", unit))
    legend(grid)


def _final_values(panels, result, point) -> str:
    """Draw the exponents of the file, and how far their errors reach; the first of them as text."""
    final = result.at_point("lyapunov", point)
    known = "lyapunov_error" in result
    reach = result.interval(result.at_point("lyapunov_error", point)) if known else np.full(len(final), np.nan)
    errors = f"± {result.significant:.2g} standard errors"
    for ax, count in zip(panels, (1, len(final)), strict=True):
        for i, (value, spread) in enumerate(list(zip(final, reach, strict=True))[:count]):
            colour = exponent_colour(i)
            if np.isfinite(value):
                ax.axhline(value, color=colour, lw=0.7, ls=DASHES, label="_" if i else "final value")
            if np.isfinite(value) and np.isfinite(spread):
                label = "_" if i else errors
                ax.axhspan(value - spread, value + spread, color=colour, alpha=0.15, lw=0, label=label)
    value = rf"{_scientific(final[0], 2)} \pm {_scientific(reach[0], 0)}" if known else _scientific(final[0], 2)
    return exponent(1, f" = {value}")


def _scientific(value, digits) -> str:
    """A number for mathtext."""
    if not np.isfinite(value) or value == 0:
        return f"{value:.{digits}f}".replace("inf", r"\infty").replace("nan", "?")
    mantissa, exponent = f"{value:.{digits}e}".split("e")
    return rf"{mantissa} \times 10^{{{int(exponent)}}}"
