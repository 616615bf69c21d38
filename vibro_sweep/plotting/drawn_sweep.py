"""What a picture needs from a result file: the sweep, what is computed, the system's numbers."""

from typing import NamedTuple

import numpy as np

from vibro_sweep.checks.errors import ArgumentError
from vibro_sweep.checks.refusals import shown
from vibro_sweep.files.file_errors import StoreError
from vibro_sweep.oscillator.catalogue import OF_A_SYSTEM
from vibro_sweep.oscillator.contact_laws.compliant import StopLaw
from vibro_sweep.oscillator.stops import NUMBERS, compliance_of
from vibro_sweep.plotting.measured import draw_measured
from vibro_sweep.plotting.picture_files import PlotError
from vibro_sweep.plotting.plot_options import PlotOptions
from vibro_sweep.plotting.settings import settings_of
from vibro_sweep.plotting.source import sweep_read
from vibro_sweep.plotting.style import axis_name, equation, in_formula
from vibro_sweep.tables.coordinates import MOST_MASSES
from vibro_sweep.tables.exponents import CERTAIN, sign_of
from vibro_sweep.tables.outcomes import NOT_COMPUTED, NOT_SETTLED
from vibro_sweep.tables.parameters import CYCLES, FREQUENCY
from vibro_sweep.tables.units import shown_unit, unit_text, without_factor

LONGEST_LINE = 150  # letters of TeX


_SIDES = {1: "right", -1: "left"}


class Point(NamedTuple):
    """One orbit of the file: its place in the arrays, its place in the sweep, and what to call it."""

    index: tuple[int, ...]
    place: tuple[int, ...]
    label: str


class DrawnSweep:
    """A result file, open for reading, or a Dataset; a context manager.

    `sweep`: key -> its values, in order; `starts`: names of the starts (one empty name if there is only one);
    `follow`: they are an upward and a downward branch; `done`: bool, shape (*sweep, starts), which points are
    computed; `failed`: none of them well; `settings`: numbers and words that hold for all points; `significant`: how
    many standard errors tell an exponent from zero, and are drawn.
    Raises `PlotError` where the file is missing or not a result.
    """

    def __init__(self, data, options: PlotOptions):
        self.options = options
        self.measurable: dict[str, None] = {}  # variables of axes in which measured points may lie
        self._open = sweep_read(data, options.display)
        self._source = self._open.__enter__()
        self.path, self.display = self._source.name, self._source.display
        try:
            self._read_frame()
            self._chosen = self._nearest(self.options.at)
        except BaseException as error:
            self._open.__exit__(None, None, None)
            if isinstance(error, (KeyError, TypeError, ValueError)) and not isinstance(error, PlotError):
                raise PlotError(f"{self.path} is damaged ({error})") from error
            raise

    def _read_frame(self):
        names = self._source.keys
        self.sweep = {name: self.coordinate(name).astype(float) for name in names}
        for name, values in self.sweep.items():
            if not np.isfinite(values).all():
                raise PlotError(f"{self.path} is damaged: the axis {name} has values that are not numbers")
        self._one_start = self._source.values("status").ndim == len(names)
        starts = [""] if self._one_start else self.coordinate("start")
        self.starts = [str(start) for start in starts]
        self.follow = self.starts == ["up", "down"]
        codes = self._with_start(self._source.values("status"))
        self.done, self.unsettled = codes != NOT_COMPUTED, codes == NOT_SETTLED
        try:
            self.settings, self._along, self.significant, valid = settings_of(self._source)
        except OSError as error:
            raise PlotError(f"{self.path}: its numbers cannot be read, it is damaged or being written") from error
        self.failed = self.done.any() and not np.isin(codes, valid).any()

    def _nearest(self, at: dict[str, float]) -> dict[int, int]:
        """Axis and index of the values nearest to the given ones."""
        names = list(self.sweep)
        for key, value in at.items():
            if key not in names:
                allowed = ", ".join(name + self.unit(name) for name in names) or "nothing, it is one point"
                raise PlotError(f"at: {shown(key)} is no axis here; allowed: {allowed}")
            if not self.sweep[key].min() <= value <= self.sweep[key].max():
                raise PlotError(f"at: {key} = {value:g} is not allowed; {self.extent(key)}")
        return {names.index(key): int(np.argmin(np.abs(self.sweep[key] - value))) for key, value in at.items()}

    def __enter__(self):
        return self

    def __exit__(self, kind, error, trace):
        self._open.__exit__(None, None, None)

    def __contains__(self, name) -> bool:
        return name in self._source

    def contents(self) -> str:
        """The names of the stored quantities, for a message."""
        return ", ".join(sorted(self._source.names))

    def unit(self, name) -> str:
        """The unit of a quantity, for the name of an axis; of the gap along a trajectory that of the states."""
        letter = {"gap": "x1", "gap_velocity": "v1"}.get(name, name)
        stored_name = next((key for key in (name, letter, f"trajectory_{letter}") if key in self._source), None)
        return "" if stored_name is None else shown_unit(self._source.unit(stored_name))

    def measured_in(self, ax, x: str, y: str) -> bool:
        """Mark measured points in axes of two numbers, where there are such. Whether there are."""
        self.measurable |= {y: None}
        return draw_measured(ax, self.options.points, (x, self._unit_of(x)), (y, self._unit_of(y)))

    def _unit_of(self, name: str) -> str | None:
        return self._source.unit(name) if name in self._source else None

    def axis(self, key) -> str:
        """A swept number as an axis label."""
        return axis_name(key, self.unit(key))

    def extent(self, key) -> str:
        """From where to where a number is swept, in words; of a frequency in rad/s also in Hz."""
        ends, unit = (self.sweep[key].min(), self.sweep[key].max()), self.unit(key)
        hertz = "{:.5g} to {:.5g} Hz".format(*(end / (2 * np.pi) for end in ends))
        also = f", which is {hertz}" if unit == " [rad/s]" else ""
        return f"the sweep has {key} from {ends[0]:g} to {ends[1]:g}{unit}{also}"

    def coordinate(self, name) -> np.ndarray:
        """Values of a dimension."""
        return self._read(name)

    def array(self, name, column: int | None = None) -> np.ndarray:
        """A quantity as floats, shape (*sweep, starts, its own dimensions); NaN where not computed or failed.

        column : of its last dimension, which it has no more; the others are not read
        """
        stored = self._with_start(self._read(name, () if column is None else (..., column)))
        values = stored.astype(float)
        if not self.done.all():
            values[~self.done] = np.nan
        if stored.dtype.kind == "i":
            values[stored == -1] = np.nan
        return values

    def at_point(self, name, point: Point) -> np.ndarray:
        """A quantity at one point, shape (its own dimensions); reads no other point."""
        return self._read(name, point.index[:-1] if self._one_start else point.index)

    def _read(self, name, index=()) -> np.ndarray:
        try:
            return self._source.values(name, index=index)
        except (StoreError, ArgumentError) as error:
            raise PlotError(str(error)) from error
        except (OSError, RuntimeError) as error:
            raise PlotError(f"{self.path}: `{name}` cannot be read, it is damaged or closed") from error

    def _with_start(self, values) -> np.ndarray:
        return np.expand_dims(values, len(self.sweep)) if self._one_start else values

    def repeats(self, points, order) -> np.ndarray:
        """The number of points after which those of a periodic orbit repeat, (values, starts); 0 where they do not.

        points : of the section, (values, starts, samples); order : the places of the values in the sweep
        """
        if "period" not in self:
            return np.zeros(points.shape[:2], int)
        period = np.nan_to_num(self.array("period")[order])
        known = np.isfinite(points).sum(axis=-1)
        if "phase" in self:  # points are impacts; of more than there is room for the file has the first ones
            period = np.where(known < points.shape[-1], np.rint(known * period / (self.number("record") or np.inf)), 0)
        return np.where(known >= period, period, 0).astype(int)

    def number(self, name, place=()) -> float | None:
        """A number of the system, or b*, at a place in the sweep; None where the file does not say."""
        if name in self.sweep:
            return float(self.sweep[name][place[list(self.sweep).index(name)]])
        if name in self._along:
            keys, values = self._along[name]
            return float(values[tuple(at for at, key in zip(place, self.sweep, strict=True) if key in keys)])
        value = self.settings.get(name)
        return None if value is None else float(value)

    def stops(self, place) -> dict[int, float]:
        """The stops at a place in the sweep: side (+1 right, -1 left) -> the gap there."""
        b, offset = self.number("b", place), self.number("offset", place) or 0.0
        return {} if b is None else {side: offset + side * b for side in self.sides}

    def compliance(self, side: int, place) -> StopLaw | None:
        """The law of the stop on this side (+1 right, -1 left); None of a rigid one."""
        return compliance_of({name: self.number(name, place) for name in NUMBERS}, _SIDES[side])

    @property
    def rigid(self) -> tuple[int, ...]:
        """The sides of rigid stops."""
        return tuple(side for side in self.sides if self.compliance(side, (0,) * len(self.sweep)) is None)

    @property
    def meeting(self) -> str:
        """What masses have at the stops, where it is one word for all of them."""
        return "impact" if self.rigid else "contact"

    @property
    def sides(self) -> tuple[int, ...]:
        """The stops that there are."""
        return {"right": (1,), "left": (-1,)}.get(self.settings.get("stops"), (1, -1))

    @property
    def masses(self) -> int:
        """The number of masses that have a displacement in the file; two where it has none."""
        names = (f"{of}x{n}" for n in range(1, MOST_MASSES + 1) for of in ("", "trajectory_"))
        return max((int(name.partition("x")[2]) for name in names if name in self), default=2)

    @property
    def contact_normal(self) -> np.ndarray | None:
        """n of the gap n.x, (N,); None where that is x1."""
        normal = np.asarray(self.settings.get("contact_normal", [1]), float)
        return None if normal[0] == 1 and not normal[1:].any() else normal

    def grazing(self, key) -> dict[str, np.ndarray]:
        """Clearances at which the free motion touches the stops, at each value of a swept key, if they depend on no
        other: name -> (n,). b* where it is that of both."""
        clearances = {}
        for name in ("b_star", *(f"b_{'right' if side > 0 else 'left'}" for side in self.sides)):
            if name in self._along:
                keys, values = self._along[name]
                clearances |= {name: values} if keys == (key,) else {}
            elif (value := self.number(name)) is not None:
                clearances[name] = np.full(len(self.sweep[key]), value)
        return clearances

    def interval(self, error) -> np.ndarray:
        """The distance from zero at which an exponent with this standard error differs from zero."""
        return self.significant * np.asarray(error)

    def without_contact(self) -> np.ndarray | None:
        """Whether the orbits met no stop in their record; bool, shape (*sweep, starts). None: not every contact is
        counted."""
        needed = [("impacts" if side in self.rigid else "contacts") for side in self.sides]
        names = [f"{kind}_{_SIDES[side]}" for kind, side in zip(needed, self.sides, strict=True)]
        if not all(name in self for name in names):
            return None
        return np.all([self.array(name) == 0 for name in names], axis=0)

    def is_chaotic(self) -> np.ndarray:
        """Whether lambda_1 > 0 beyond its errors, if they are stored; bool, shape (*sweep, starts)."""
        return self._sign_of(self.array("lyapunov", 0)) > 0

    def largest_exponent(self) -> np.ndarray:
        """lambda_1, and 0 where it does not differ from that by more than its errors; shape (*sweep, starts)."""
        largest = self.array("lyapunov", 0)
        return np.where((self._sign_of(largest) == 0) & np.isfinite(largest), 0.0, largest)

    def _sign_of(self, largest: np.ndarray) -> np.ndarray:
        known = "lyapunov_error" in self
        error, certain = (self.array("lyapunov_error", 0), self.significant) if known else (0.0, CERTAIN)
        return sign_of(largest, error, certain)

    def model(self) -> str:
        """The text on what was iterated, for a title: nothing where it is the oscillator itself."""
        if self.settings.get("dynamics") != "map":
            return ""
        at = self.settings.get("expand_at")
        where = "" if at is None else f", expanded at $b = {at:.8g}$"
        return f"discontinuity mapping of order {self.settings['order']}{where}"

    def points(self, most=4) -> list[Point]:
        """Up to `most` computed orbits, evenly spread over the sweep, two starts at a place if there are."""
        starts = _spread(range(len(self.starts)), 2 if self.sweep else most)
        places = [tuple(map(int, place)) for place in np.argwhere(self.done[..., starts].any(axis=-1))]
        places = [place for place in places if all(place[axis] == i for axis, i in self._chosen.items())]
        return [
            Point((*place, start), place, self._label(place, start))
            for place in _spread(places, max(1, most // len(starts)))
            for start in starts
            if self.done[(*place, start)]
        ]

    def _label(self, place, start) -> str:
        values = [f"{equation(key, self.number(key, place))} {unit_text(self._unit_of(key))}" for key in self.sweep]
        name = self.starts[start]
        return ", ".join([*map(str.strip, values), *([name if self.follow else f"start {name}"] if name else [])])

    def title(self, subject="") -> str:
        """The title: what is shown, the numbers that are the same at every point, and how much is there if not all."""
        numbers = self._numbers()
        if (stops := self.settings.get("stops")) in ("right", "left"):
            numbers.append(f"{stops} stop only")
        if self.settings.get("release") == "force":
            numbers.append("release by force")
        missing = "" if self.done.all() else f"{self.done.sum()} of {self.done.size} points computed"
        kind = str(self.settings.get("type", "")).replace("_", " ")
        return "\n".join(
            [*filter(None, ["; ".join(filter(None, [subject, kind, self.model(), missing]))]), *_lines(numbers)]
        )

    def _numbers(self) -> list[str]:
        """The numbers of the system as equations; without what has its default, and lists as one."""
        equations, lists = [], {}
        settings = self.settings
        if CYCLES.name in settings or CYCLES.name in self.sweep:  # in place of omega
            settings = {name: value for name, value in settings.items() if name != FREQUENCY.name}
        incomplete = {_list_of(key) for key in self.sweep}
        for key, quantity in OF_A_SYSTEM.items():
            if key in settings and quantity.each and _list_of(key) not in incomplete:
                lists.setdefault(_list_of(key), []).append(settings[key])
            elif key in settings and (quantity.default is None or settings[key] != quantity.default):
                factor, unit = self._unit_of_number(key, settings[key])
                equations.append(f"{equation(key, factor * settings[key] if factor != 1.0 else settings[key])}{unit}")
        for name, values in lists.items():
            if any(value != OF_A_SYSTEM[f"{name}1"].default for value in values):
                letter = OF_A_SYSTEM[f"{name}1"].symbol.removesuffix("_{1}").removesuffix("{}")
                factor, unit = self._unit_of_number(f"{name}1", max(values, key=abs))
                listed = ", ".join(in_formula(factor * value, 4) for value in values)
                equations.append(f"${letter} = {listed}${unit}")
        return equations

    def _unit_of_number(self, name: str, size: float) -> tuple[float, str]:
        """What a number in the title is multiplied by, and the unit behind it; one with a factor is none to read."""
        unit = self._source.unit(name) or ""
        factor, unit = without_factor(size, unit) if unit[:1].isdecimal() and unit_text(unit) else (1.0, unit)
        text = unit_text(unit)
        return factor, f" {text}" if text else ""


def _list_of(key: str) -> str:
    """The name of the list that a number is of."""
    return key.rstrip("0123456789")


def _lines(items: list[str]) -> list[str]:
    """The items in lines that a page has room for."""
    lines = [""]
    for item in items:
        if len(lines[-1]) + len(item) > LONGEST_LINE:
            lines.append("")
        lines[-1] += f", {item}" if lines[-1] else item
    return [line for line in lines if line]


def _spread(items, most) -> list:
    items = list(items)
    at = np.linspace(0, len(items) - 1, min(most, len(items))).round().astype(int)
    return [items[i] for i in at]
