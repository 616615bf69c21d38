"""The oscillators: `Oscillator`, by its matrices or as a model with a name; `System`, the paper's (eqs. 3, 4)."""

from __future__ import annotations  # help() says ArrayLike, and not all that this may be

import inspect
import math
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import replace
from functools import cached_property, partial
from typing import Any, Literal

import numpy as np
from numpy.typing import ArrayLike

from vibro_sweep.checks.arguments import bound, check_type, names_its_arguments
from vibro_sweep.checks.errors import ArgumentError
from vibro_sweep.checks.not_computed import PAGE
from vibro_sweep.checks.real import array_of, number_of
from vibro_sweep.checks.refusals import ParameterError
from vibro_sweep.oscillator import wording
from vibro_sweep.oscillator.checked_model import checked, checked_option
from vibro_sweep.oscillator.checked_numbers import UNITS_ALLOWED, checked_number
from vibro_sweep.oscillator.contact_element import NAMES as CONTACT_NAMES
from vibro_sweep.oscillator.contact_element import Contact, check_left_out, contacts_in
from vibro_sweep.oscillator.contact_laws import OTHER_STOPS, STOP_NUMBERS
from vibro_sweep.oscillator.family import Family
from vibro_sweep.oscillator.linear import Linear
from vibro_sweep.oscillator.models import MODELS, model_named
from vibro_sweep.oscillator.models.declaration import OF_STOPS, STOPS, UNITS, WHICH_STOPS, Model, Option, linear_of
from vibro_sweep.oscillator.models.two_mass import MODEL, PAPER, PARAMETERS
from vibro_sweep.oscillator.modes import Modes, modes
from vibro_sweep.oscillator.other_words import OTHER_WORDS, STANDS_FOR, in_own_numbers
from vibro_sweep.oscillator.paper_motion import KNOWN, resolved, with_phase
from vibro_sweep.oscillator.physical import OMEGA, PHYSICAL, in_numbers
from vibro_sweep.oscillator.reduction import basis_of, matrix_of
from vibro_sweep.oscillator.stops import completed, followers
from vibro_sweep.tables.parameters import CYCLES, PHASE, STOP_LEFT, STOP_RIGHT
from vibro_sweep.tables.quantity import Parameter
from vibro_sweep.tables.units import Units


class Oscillator:
    """M x'' + C x' + K x = constant + omega^force_power (force sin(omega t + tau) + force_cos cos(omega t + tau)).

    The stops keep the gap g = n . x, n the contact normal, from offset - b to offset + b; an impact takes g' to -R g'.

    Parameters
    ----------
    M, K : (N, N), symmetric; M positive definite, K positive semidefinite
    C, modal_damping, rayleigh : at most one; a matrix as K, a ratio for each mode, alpha and beta of alpha M + beta K
    force, force_cos, constant, contact_normal : (N,); a force of 0 acts on no mass
    R, R_left : restitution of rigid stops; R_left, of the left one, is R where it is left out
    k_stop, c_stop, preload : of compliant stops, in place of R: in contact the force k_stop delta + c_stop delta' +
        preload acts on the gap, delta the way behind the stop; with `_left` of the left one
    release : displacement, a contact ends where delta = 0; force, where its force is zero
    frequency : in cycles per unit of time, in place of omega = 2 pi frequency
    tau : phase in radians, or "grazing": where the gap of the free motion is largest at t = 0; "cos" is pi/2
    stops : both, right, left; b may be <= 0 where there is one
    stop_right, stop_left : where they stand, in place of b, offset and stops
    units : for labels: SI; {"mass": "kg", "length": "mm", "time": "s"}, or a force in place of one of these; or what a
        mass, a length and a time of 1 are in kg, m and s; left out: nondimensional
    contacts : in place of contact_normal, b, R, ...: a list of `Contact`; several are not computed yet

    Numbers are attributes: `force`, and `force1`, `force2`, ... too. Raises ParameterError for what cannot be.
    `Oscillator.named("chain", m=..., ...)` makes the other models (`vibro-sweep models`).

    Examples
    --------
    A mass on a spring: its motion without stops has the amplitude 1/sqrt((1 - omega^2)^2 + (2 zeta omega)^2).

    >>> import vibro_sweep as vs
    >>> mass = vs.Oscillator([[1]], [[1]], modal_damping=0.05, force=[1], contact_normal=[1], omega=0.8, R=0.7, b=1.5)
    >>> round(vs.grazing(mass).b, 6)
    2.711631
    """

    @names_its_arguments
    def __init__(
        self, M: ArrayLike, K: ArrayLike, C: ArrayLike | None = None, *, modal_damping: ArrayLike | None = None,
        rayleigh: ArrayLike | None = None, force: ArrayLike = 0, force_cos: ArrayLike = 0, constant: ArrayLike = 0,
        force_power: float = 0, contact_normal: ArrayLike | None = None, omega: float | None = None,
        frequency: float | None = None, b: float | None = None, offset: float = 0.0,
        stop_right: float | None = None, stop_left: float | None = None,
        R: float | None = None, R_left: float | None = None, k_stop: float | None = None, c_stop: float | None = None,
        preload: float | None = None, k_stop_left: float | None = None, c_stop_left: float | None = None,
        preload_left: float | None = None, release: Literal["displacement", "force"] = "displacement",
        tau: float | Literal["grazing"] = "grazing",
        stops: Literal["both", "right", "left"] = "both",
        units: Literal["SI"] | Mapping[str, str] | ArrayLike | None = None,
        contacts: Sequence[Contact | Mapping] | None = None,
    ) -> None:  # fmt: skip
        arguments = {name: value for name, value in locals().items() if name != "self"}
        self._set(MODELS["linear"], arguments)

    def _set(self, model: Model, arguments: Mapping[str, Any], others: tuple[Contact, ...] = ()) -> None:
        arguments = dict(arguments)
        if (contacts := arguments.pop("contacts", None)) is not None:
            others = contacts_in(contacts)
            if "contact_normal" in (quantity.name for quantity in model.options):  # the first one is its own
                check_left_out(arguments)
                arguments, others = arguments | vars(others[0]), others[1:]
        vars(self).update(model=model, arguments=checked(model, in_own_numbers(arguments)), others=others)
        for i, contact in enumerate(others, 2):
            if len(contact.contact_normal) != self.masses:
                allowed = f"a list of {self.masses} numbers, one for each mass"
                raise ParameterError(f"contact_normal of contact {i}", [*contact.contact_normal], allowed)

    @classmethod
    def named(cls, name: str, **arguments: Any) -> Oscillator:
        """A model by its name, as it is in a scene; of `two_mass` a System.

        Examples
        --------
        >>> import vibro_sweep as vs
        >>> ball = vs.Oscillator.named(
        ...     "one_mass", k=0, zeta=0, F=1, constant=-0.5, omega=1, R=0.5, b=0, stops="left"
        ... )
        >>> ball.masses, ball.replace(R=0.6).R
        (1, 0.6)
        """
        return _made(model_named(name), arguments)

    @classmethod
    def reduced(
        cls, M: Any, K: Any, C: Any = None, *, modes: int, contact_normal: ArrayLike, force: ArrayLike = 0,
        force_cos: ArrayLike = 0, constant: ArrayLike = 0, modal_damping: ArrayLike | None = None, **options: Any,
    ) -> Oscillator:  # fmt: skip
        """A large model, as a finite-element program writes it, by its lowest modes and the static flexibility at the
        contact: an Oscillator of modes + 1 coordinates, 16 at most.

        M, K, C : (n, n), symmetric, arrays or sparse matrices of SciPy
        modes : how many modes, without damping
        contact_normal, force, force_cos, constant : (n,), by the rows of M
        modal_damping : in place of C, a ratio for all coordinates, or one for each of the modes + 1
        options : omega, R, b, units and the like, as of an Oscillator

        Displacements of the model are `basis @ x`, (n,), of the coordinates x of the oscillator, which has `.basis`.
        Raises ParameterError.

        Examples
        --------
        A bar of 50 elements, free at one end, held at the other, between stops beside the free end.

        >>> import numpy as np
        >>> import vibro_sweep as vs
        >>> steps = np.diff(np.eye(51), axis=0)[:, 1:] * 50
        >>> bar = vs.Oscillator.reduced(
        ...     np.eye(50) / 50, steps.T @ steps / 50, modes=3, contact_normal=np.eye(50)[-1], modal_damping=0.01,
        ...     force=np.eye(50)[-1], omega=1.2, R=0.8, b=1.0,
        ... )
        >>> bar.masses, np.sqrt(np.diag(bar.K))[:2].round(3)
        (4, array([1.555, 4.664]))
        """
        normal = array_of(contact_normal, 1)
        if normal is None:
            raise ParameterError("contact_normal", contact_normal, "a list of finite numbers")
        basis, squares = basis_of(M, K, normal, modes)
        arguments = dict(options)
        for name, value in (("force", force), ("force_cos", force_cos), ("constant", constant)):
            given = array_of(value, 1)
            if given is not None and given.shape != normal.shape:
                raise ParameterError(name, value, f"a list of {len(normal)} numbers, one for each row of M")
            arguments[name] = 0 if number_of(value) == 0 else (basis.T @ given).tolist() if given is not None else value
        if C is not None:
            arguments["C"] = basis.T @ (matrix_of("C", C, len(normal)) @ basis)
            arguments["C"] = ((arguments["C"] + arguments["C"].T) / 2).tolist()
        if modal_damping is not None:
            ratio = number_of(modal_damping)
            arguments["modal_damping"] = modal_damping if ratio is None else [ratio] * len(squares)
        made = Oscillator(np.eye(len(squares)), np.diag(squares), contact_normal=basis.T @ normal, **arguments)
        vars(made)["basis"] = basis
        return made

    def __setattr__(self, name, value):
        raise AttributeError(f"{name}: an Oscillator is not changed; `replace` makes another one")

    def __getattr__(self, name: str):
        if name.startswith("_") or name in ("model", "arguments"):  # while it is unpickled there is nothing yet
            raise AttributeError(name)
        if name in self.arguments:
            return self.arguments[name]
        if name in self.described:
            return self.numbers[name]
        raise AttributeError(f"{name!r} is not a number of the model {self.model.name}")

    def __dir__(self) -> list[str]:
        """The attributes and the numbers, those of lists one by one, for a prompt that completes names."""
        return [*super().__dir__(), *self.arguments, *self.described]

    def __reduce__(self):
        basis = {"basis": self.basis} if "basis" in vars(self) else {}
        return _again, (self.model.name, self.arguments, self.others, basis)

    def __eq__(self, other):
        same = isinstance(other, Oscillator) and self.model.name == other.model.name
        return same and (self.arguments, self.others) == (other.arguments, other.others)

    def __hash__(self):
        return hash((self.model.name, tuple(self.arguments.values()), self.others))

    def __repr__(self) -> str:
        arguments = self.arguments
        if self.others and "contact_normal" in arguments:  # all in one list
            arguments = {name: value for name, value in arguments.items() if name not in CONTACT_NAMES}
        shown, complete = wording.arguments(arguments | ({"contacts": self._listed} if self.others else {}))
        by_call = complete and self.model.name == "linear"
        return f"Oscillator({shown})" if by_call else f"<{self.model.name}: {shown}>"

    @property
    def contacts(self) -> tuple[Contact, ...]:
        """Its contacts; one is computed, an oscillator with several is made, printed and saved alone."""
        numbers_of_first = {name: self.arguments[name] for name in CONTACT_NAMES if name in self.arguments}
        normal = linear_of(self.model, self.arguments).contact.normal
        return Contact(**numbers_of_first | {"contact_normal": normal}), *self.others

    @property
    def _listed(self) -> tuple[Contact, ...]:
        """The contacts that `contacts=` has: all where the model has none of its own."""
        return self.contacts if "contact_normal" in self.arguments else self.others

    @cached_property
    def described(self) -> dict[str, Parameter]:
        """The numbers, those of lists one by one: m1, m2, ..."""
        numbers, units = self.numbers, self.model.depending(self.arguments)
        flat = self.model.flat(self.masses)
        return {
            name: replace(quantity, units=units.get(name, quantity.units))
            for name, quantity in flat.items()
            if name in numbers or name == CYCLES.name
        }

    @property
    def numbers(self) -> dict[str, Any]:
        """Their values, as given; `tau` may be a word, what follows another number None."""
        result = {}
        for quantity in self.model.numbers:
            value = self.arguments[quantity.name]
            if quantity.each:
                result |= {f"{quantity.name}{i}": entry for i, entry in enumerate(value or (), 1)}
            else:
                result[quantity.name] = value
        return result

    @property
    def options(self) -> dict[str, Any]:
        """What is not a number: which stops there are, the units, matrices."""
        return {quantity.name: self.arguments[quantity.name] for quantity in self.model.options}

    @property
    def units(self) -> Units | None:
        """What a mass, a length and a time of 1 are; None: its numbers are nondimensional."""
        return self.arguments["units"]

    @property
    def masses(self) -> int:
        """N."""
        return self.model.masses(self.arguments)

    @property
    def family(self) -> Family:
        """The same oscillator by its numbers, with their derivatives. Raises ArgumentError where it has several
        contacts."""
        _check_one_contact(self)
        return self._family

    @property
    def _family(self) -> Family:
        """The same with all its contacts."""
        build = partial(_build, self.model.name, tuple(self.arguments.items()), self.others)
        return Family(build, completed(self.numbers))

    @cached_property
    def linear(self) -> Linear:
        """The matrices, forces and stops, with the phase resolved."""
        return self.family.linear

    @property
    def gap_is_x1(self) -> bool:
        """Whether the contact is that of mass 1 with a wall."""
        along = self.linear.contact.normal
        return bool(along[0] == 1 and not along[1:].any())

    @property
    def phase(self) -> float:
        """tau in radians, `grazing` resolved."""
        return float(self.linear.tau)

    @property
    def positions(self) -> dict[str, float]:
        """Where the stops stand, by the names that say so: `stop_right`, `stop_left`, as far as there are these."""
        b, offset = self.arguments["b"], self.arguments.get("offset", 0.0)
        both = {STOP_RIGHT.name: offset + b, STOP_LEFT.name: offset - b}
        which = self.options.get("stops", "both")
        return {name: place for name, place in both.items() if which in ("both", name.removeprefix("stop_"))}

    @property
    def frequency(self) -> float:
        """omega/(2 pi): the frequency of the force in cycles per unit of time."""
        return self.omega / (2 * math.pi)

    @property
    def period(self) -> float:
        """The forcing period T = 2 pi/omega."""
        return 2 * math.pi / self.omega

    @property
    def divergence(self) -> float:
        """-tr(M^-1 C): the sum of the Lyapunov exponents of a non-impacting orbit."""
        q = self.linear
        return -float(np.trace(np.linalg.solve(q.M, q.C)))

    def parameters(self) -> dict[str, float]:
        """The numbers by name, `tau` resolved, and those that follow others."""
        known = {name: value for name, value in self.numbers.items() if value is not None}
        return following(self.model, self.numbers) | known | {"tau": self.phase}

    def replace(self, **changes: Any) -> Oscillator:
        """A copy with other numbers. Raises ParameterError, also for a name that is not one of them."""
        replaced = {other for name in changes for other in STANDS_FOR.get(name, ())}
        arguments = {name: value for name, value in self.arguments.items() if name not in replaced}
        if changes.keys() & {STOP_RIGHT.name, STOP_LEFT.name}:  # the other stop stays where it is
            arguments |= self.positions
        for name, value in changes.items():
            if name in self.arguments or name in STANDS_FOR:
                arguments[name] = value
            elif name in self.numbers:
                lists = next(
                    quantity.name
                    for quantity in self.model.numbers
                    if quantity.each and name[len(quantity.name) :].isdecimal() and name.startswith(quantity.name)
                )
                entries = list(arguments[lists])
                entries[int(name[len(lists) :]) - 1] = value
                arguments[lists] = entries
            else:
                known = [quantity.name for quantity in (*self.model.numbers, *self.model.options, *OTHER_WORDS)]
                raise ParameterError(name, value, f"one of {', '.join(known)}")
        made = _made(self.model, arguments, self.others)
        vars(made).update({"basis": self.basis} if "basis" in vars(self) else {})
        return made


def following(model: Model, numbers: Mapping[str, Any]) -> dict[str, Any]:
    """The numbers of a model that are left out and follow others; numbers : all by name, also arrays."""
    quantities = [quantity for quantity in model.numbers if quantity.follows and quantity not in STOP_NUMBERS]
    return followers(numbers) | {
        quantity.name: numbers[quantity.follows] for quantity in quantities if numbers[quantity.name] is None
    }


def _made(model: Model, arguments: Mapping[str, Any], others: tuple[Contact, ...] = ()) -> Oscillator:
    made = object.__new__(System if model is MODEL else Oscillator)
    made._set(model, arguments, others)
    return made


def _again(name: str, arguments: Mapping[str, Any], others: tuple[Contact, ...], more: Mapping[str, Any]) -> Oscillator:
    made = _made(MODELS[name], arguments, others)
    vars(made).update(more)
    return made


def _check_one_contact(system: Oscillator) -> None:
    if system.others:
        raise ArgumentError(f"system: it has {1 + len(system.others)} contacts; those with one are computed; {PAGE}")


def _build(name: str, arguments: tuple[tuple[str, Any], ...], others: tuple[Contact, ...], /, **numbers) -> Linear:
    q = linear_of(MODELS[name], dict(arguments) | numbers)
    return q._replace(contacts=(*q.contacts, *(one.linear for one in others)))


POSITIONAL = inspect.Parameter.POSITIONAL_OR_KEYWORD


def _signature(*declared: Parameter | Option, kind=POSITIONAL) -> inspect.Signature:
    """Of a function with these arguments; those after one that may be left out may be so, too."""
    parameters: list[inspect.Parameter] = []
    for quantity in declared:
        optional = quantity.optional or quantity.default is not None
        after = kind is POSITIONAL and parameters and parameters[-1].default is not inspect.Parameter.empty
        default = quantity.default if optional or after else inspect.Parameter.empty
        words = {PHASE.name: float | Literal["grazing"], UNITS.name: Units | None}
        words |= {option.name: Literal[option.words] for option in (WHICH_STOPS, *OF_STOPS)}
        known = words.get(quantity.name, float | None if default is None else float)
        parameters.append(inspect.Parameter(quantity.name, kind, default=default, annotation=known))
    return inspect.Signature(parameters)


def _arguments(name: str, signature: inspect.Signature, /, *values: Any, **named: Any) -> dict[str, Any]:
    """The arguments by name. TypeError where they are not those of the signature."""
    call = bound(name, signature, *values, **named)
    call.apply_defaults()
    return call.arguments


class System(Oscillator):
    """The impact oscillator (3), (4). Raises ParameterError for a parameter outside its range.

    Examples
    --------
    >>> import vibro_sweep as vs
    >>> system = vs.System(mu_m=10, mu_k=5, zeta=0.05, f2=0, omega=0.63, R=0.8, b=4)
    >>> round(system.period, 6), round(system.divergence, 6)
    (9.97331, -0.16)
    """

    __signature__ = _signature(*PAPER, WHICH_STOPS, *PARAMETERS[len(PAPER) :], *OF_STOPS, UNITS)

    def __init__(self, *numbers: float, **arguments: Any) -> None:
        named = in_own_numbers(arguments)
        self._set(MODEL, _arguments("System", System.__signature__, *numbers, **named))

    def __repr__(self) -> str:
        """The call that makes it, without the numbers of compliant stops where there is none."""
        left_out = {quantity.name: None for quantity in OTHER_STOPS} | {
            quantity.name: quantity.default for quantity in OF_STOPS
        }
        arguments = {name: self.arguments[name] for name in System.__signature__.parameters}
        shown = (f"{name}={value!r}" for name, value in arguments.items() if value != left_out.get(name, ...))
        return f"System({', '.join(shown)})"

    @classmethod
    def physical(cls, **arguments: Any) -> System:
        """The system with these physical quantities in SI units: kg, m, s, N (section 2 of the paper). Raises
        `ParameterError`.

        Its `units` say what its own, nondimensional numbers are measured in.
        The stops stand at B0 - B and B0 + B; R_left, of the left one, is R where it is left out. k_stop in N/m, c_stop
        in N s/m and preload in N of compliant stops, in place of R, are as those of a System.

        Examples
        --------
        >>> import vibro_sweep as vs
        >>> system = vs.System.physical(
        ...     M1=2, M2=20, K1=800, K2=4000, C1=4, C2=20, P1=10, P2=0, Omega=12.6, R=0.8, B=0.05
        ... )
        >>> round(system.omega, 6), round(system.b, 6), round(system.zeta, 6)
        (0.63, 4.0, 0.05)
        """
        if (frequency := arguments.pop(CYCLES.name, None)) is not None:
            if arguments.get(OMEGA.name) is not None:
                allowed = "left out where Omega is given, in place of which it stands"
                raise ParameterError(CYCLES.name, frequency, allowed)
            arguments[OMEGA.name] = 2 * math.pi * checked_number(CYCLES, frequency)
        arguments = _arguments("System.physical", _PHYSICAL, **arguments)
        stops = checked_option(WHICH_STOPS, arguments["stops"])
        alike = {name: arguments[name] for name in arguments if name in System.__signature__.parameters}
        return cls(**alike | in_numbers(arguments, stops))

    @property
    def phase(self) -> float:
        """tau in radians, `grazing` resolved."""
        return float(with_phase(self.numbers)["tau"]) if in_closed_form(self) else super().phase

    @property
    def modes(self) -> Modes:
        """The modes of the motion between the stops (eq. 5)."""
        return modes(self.mu_m, self.mu_k)

    @property
    def eta(self) -> np.ndarray:
        """Modal damping eta_j = zeta omega_j^2, (2,), if mu_c = mu_k.

        Non-impacting exponents: -eta_1, -eta_1, -eta_2, -eta_2.
        """
        return self.zeta * self.modes.omega_squared

    def parameters(self) -> dict[str, float]:
        """The numbers by name, `tau` resolved, and R_left and mu_c where they follow."""
        return resolved(self.numbers) if in_closed_form(self) else super().parameters()


_PHYSICAL = _signature(*PHYSICAL, PHASE, WHICH_STOPS, *OF_STOPS, kind=inspect.Parameter.KEYWORD_ONLY)
vars(System)["physical"].__func__.__signature__ = _PHYSICAL.replace(
    parameters=[inspect.Parameter("cls", POSITIONAL), *_PHYSICAL.parameters.values()]
)


def in_closed_form(system: Oscillator, swept: Iterable[str] = ()) -> bool:
    """Whether the paper's formulas hold: it is a System, and none of its numbers that they do not know is given, or
    swept."""
    if not isinstance(system, System):
        return False
    others = [quantity for quantity in PARAMETERS if quantity.name not in KNOWN]
    return not any(quantity.name in swept or system.arguments[quantity.name] != quantity.default for quantity in others)


def checked_system(system: object) -> None:
    """Raise TypeError unless it is a System or an Oscillator."""
    check_type("system", system, Oscillator, "a System or an Oscillator")
    _check_one_contact(system)  # type: ignore[arg-type]


# what `help` shows of the parameters; absent where docstrings are (python -OO)
_said, _, _examples = inspect.cleandoc(System.__doc__ or "").partition("\n\nExamples\n")
if _examples:
    _parameters = [f"{quantity.name} : {quantity.described}; {quantity.range.text}" for quantity in PARAMETERS]
    _parameters += [f"{word.name} : {word.text}" for word in OTHER_WORDS]
    _parameters += [f"stops : {', '.join(STOPS)}", f"units : for labels; {UNITS_ALLOWED}; left out: none"]
    System.__doc__ = "\n".join([_said, "\nParameters\n----------", *_parameters, "\nExamples", _examples])
