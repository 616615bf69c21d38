"""What a kind of picture is: what it needs, and what it is made of. `PICTURES` is the table of all."""

from collections.abc import Callable
from typing import NamedTuple

from vibro_sweep.plotting.drawn_sweep import DrawnSweep
from vibro_sweep.plotting.figure import Panels


class Kind(NamedTuple):
    """A kind of picture: whether a result has what it needs, as its docstring says; what it is made of; variables to
    choose among; whether it shows single orbits; and whether b may be relative to b*."""

    shows: Callable[[DrawnSweep], bool]
    panels: Callable[[DrawnSweep], Panels]
    variables: Callable[[DrawnSweep], tuple[str, ...]] = lambda result: ()
    of_orbits: bool = False
    relative: bool = False


def picture(
    shows: Callable[[DrawnSweep], bool],
    variables: Callable[[DrawnSweep], tuple[str, ...]] = lambda result: (),
    of_orbits: bool = False,
    relative: bool = False,
) -> Callable[[Callable[..., Panels]], Callable[..., Panels]]:
    """Makes a function of a result a kind of picture; arguments as of `Kind`."""

    def marked(function: Callable[..., Panels]) -> Callable[..., Panels]:
        function.kind = Kind(shows, function, variables, of_orbits, relative)  # type: ignore[attr-defined]
        return function

    return marked
