"""Families of oscillators: those with parameters that have names, their derivatives by each, and stacks of them."""

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import cached_property
from operator import attrgetter
from typing import Any

import numpy as np

from vibro_sweep.checks.errors import ArgumentError, ArgumentTypeError
from vibro_sweep.checks.refusals import not_allowed
from vibro_sweep.oscillator.linear import FORCED, STEP, Linear, grazing_phase, grazing_phase_slope, mapped
from vibro_sweep.oscillator.other_words import with_omega
from vibro_sweep.oscillator.steady import gap_responses, grazing_phases, steady_amplitudes
from vibro_sweep.oscillator.stops import why_rigid
from vibro_sweep.tables.parameters import CYCLES, FREQUENCY

RANKS = dict.fromkeys(("M", "K", "C"), 2) | dict.fromkeys(("contact.normal", "constant", "sine", "cosine"), 1)


@dataclass(frozen=True)
class Family:
    """Oscillators with parameters that have names: `build(**numbers)` gives a `Linear`.

    `build` must accept complex numbers and be analytic in them: derivatives are taken by a complex step.

    Examples
    --------
    A periodic orbit of a family has the derivatives that its `build` has.

    >>> import vibro_sweep as vs
    >>> system = vs.System(mu_m=10, mu_k=5, zeta=0.05, f2=0, omega=0.63, R=0.8, b=4)
    >>> family = system.family
    >>> float(family.derivative("b").contacts[0].high), family.replace(b=5.0).numbers["b"]
    (1.0, 5.0)
    """

    build: Callable[..., Linear]
    numbers: dict

    @property
    def free(self) -> dict[str, float]:
        """The numbers that have a value, those that may be changed along a branch; and the frequency."""
        known = {name: value for name, value in self.numbers.items() if isinstance(value, (int, float))}
        if FREQUENCY.name not in known or CYCLES.name in known:
            return known
        return known | {CYCLES.name: known[FREQUENCY.name] / (2 * math.pi)}

    def replace(self, **changes) -> "Family":
        """The same family with other numbers."""
        return Family(self.build, self.numbers | with_omega(changes, self.numbers))

    def built_with(self, changes: Mapping[str, Any]) -> Linear:
        """The oscillator with other numbers, which may be complex; of arrays the stack."""
        return self.build(**(self.numbers | with_omega(changes, self.numbers)))

    @cached_property
    def built(self) -> Linear:
        """The oscillator; its phase is None where it follows from the motion."""
        return self.build(**self.numbers)

    @cached_property
    def linear(self) -> Linear:
        """The oscillator, its phase resolved."""
        return self.built._replace(tau=grazing_phase(self.built)) if self.built.tau is None else self.built

    def derivative(self, name: str, linear: Linear | None = None) -> Linear:
        """Derivatives of all fields by the parameter `name`, exact to rounding. linear: this one's, if it is known."""
        step = self.built_with({name: self.free[name] + 1j * STEP})
        slope = mapped(_imaginary, step)
        if step.tau is None:
            slope = slope._replace(tau=grazing_phase_slope(linear or self.linear, slope))
        return slope


def _imaginary(name: str, value) -> np.ndarray | float:
    """What the complex step of a derivative has left of a number."""
    if name == "tau":
        return 0.0 if value is None else float(np.imag(value)) / STEP
    return np.imag(value) / STEP if np.iscomplexobj(value) else np.zeros(np.shape(value))


def stack_of(family: Family, shape: tuple[int, ...], changes: dict[str, np.ndarray]) -> Linear:
    """The oscillators of a family with these numbers, arrays that broadcast to `shape`: a stack, phases resolved."""
    built = family.built_with(changes)
    q = mapped(lambda name, x: None if x is None else _everywhere(name, x, shape), built)
    if q.tau is not None:
        return q
    leads = [_lead(name, x) for name, x in zip(FORCED, attrgetter(*FORCED)(built), strict=True)]
    alike = np.broadcast_shapes(*leads)  # of those that differ in stops alone
    forced = mapped(lambda name, x: _everywhere(name, x, alike) if name in FORCED else x, built)
    return q._replace(tau=np.broadcast_to(grazing_phases(gap_responses(forced, steady_amplitudes(forced))), shape))


def _lead(name: str, x: np.ndarray) -> tuple[int, ...]:
    """The shape of the stack of which x is the field `name`."""
    return np.shape(x)[: np.ndim(x) - RANKS.get(name, 0)]


def _everywhere(name: str, x: np.ndarray, shape: tuple[int, ...]) -> np.ndarray:
    return np.broadcast_to(x, shape + np.shape(x)[len(_lead(name, x)) :])


def family_of(system) -> Family:
    """The oscillators that `system` is one of, by the names of its numbers. TypeError for anything else."""
    if isinstance(system, Family):
        return system
    if not isinstance(getattr(system, "family", None), Family):
        raise ArgumentTypeError(not_allowed("system", system, "a System or an Oscillator"))
    return system.family


def rigid_family_of(system, what: str) -> Family:
    """The same, for what is computed with rigid stops alone (`NEEDS_IMPACTS`). Raises ValueError where one is not."""
    family = family_of(system)
    if family.built.compliant:
        raise ArgumentError(not_allowed("system", system, f"with rigid stops: {why_rigid(what)}"))
    return family
