"""What scenes of orbits and of branches have in common: their YAML text, and copies with other values."""

import textwrap
from abc import ABC, abstractmethod
from collections.abc import Callable, Collection
from dataclasses import dataclass, field, fields
from pathlib import Path
from typing import Any, Self, TypeVar

from vibro_sweep.checks.refusals import cut
from vibro_sweep.oscillator import wording
from vibro_sweep.oscillator.models import DEFAULT
from vibro_sweep.oscillator.oscillator import Oscillator
from vibro_sweep.oscillator.other_words import own_name

from .problems import SceneError, located, problem
from .written import yaml_of
from .yaml_text import YAMLTextError, lines_of, read_yaml

S = TypeVar("S", bound="AnyScene")


@dataclass(frozen=True, eq=False, repr=False)
class AnyScene(ABC):
    """A scene: what to compute.

    source : the file that it was read from
    as_written : the YAML text that it was read from; None of a copy with other values
    system_file : another scene's file, from which its system is, where it names one
    checked : whether it was made from data, which were checked; `dataclasses.replace` makes one that is not
    """

    name: str
    system: Oscillator
    source: Path | None = field(default=None, kw_only=True)
    as_written: str | None = field(default=None, init=False)
    system_file: Path | None = field(default=None, init=False)
    checked: bool = field(default=False, init=False)

    @abstractmethod
    def data(self) -> dict[str, Any]:
        """The data that its YAML holds; numbers that are the default are left out."""

    @property
    def text(self) -> str:
        """The YAML text that it was read from; of another scene `to_yaml`."""
        return self.to_yaml() if self.as_written is None else self.as_written

    def to_yaml(self) -> str:
        """The scene as YAML, from its numbers; `text` is what it was read from."""
        return yaml_of(self.data())

    @property
    def inputs(self) -> list[Path]:
        """The files that its run must not write to."""
        return [path for path in (self.source, self.system_file) if path]

    def _system_text(self, without: Collection[str]) -> str:
        """The oscillator in a few lines, but for numbers that change."""
        system = self.system
        usual = {"offset": 0.0, "m": 1.0}  # which most oscillators have
        known = {name: value for name, value in system.numbers.items() if value not in (None, usual.get(name))}
        known |= {name: value for name, value in system.options.items() if value is not None}
        known |= {} if system.units is None else {"units": system.units.names}
        changing = {own_name(name) for name in without}
        said = wording.numbers({name: value for name, value in known.items() if name not in changing})
        kind = "" if system.model.name == DEFAULT else f"{system.model.name}: "
        return textwrap.fill(f"  system    {kind}{said}", 88, subsequent_indent=12 * " ", break_long_words=False)

    def _with_origin(self, **attributes: object) -> Self:
        """This scene, of a new one: where it is from, its text, that it was checked. No arguments of the class, since
        `dataclasses.replace` would hand them on to a scene that says something else."""
        vars(self).update(attributes)
        return self

    def _check_names(self, changes: Collection[str]) -> None:
        """Raise SceneError for a name that is no attribute that says what is computed."""
        attributes = [entry.name for entry in fields(AnyScene)]
        known = ["system", *(entry.name for entry in fields(self) if entry.name not in attributes)]
        for key in changes:
            if key not in known:
                raise SceneError(self.name, [f"{cut(key)}: unknown; allowed here: {', '.join(known)}"])


def parsed(text: str, name: str, source: Path | None, scene_of: Callable[[object, str], S]) -> S:
    """The scene of a YAML text; `name` stands in messages, its stem in the scene. Raises SceneError."""
    other = None
    try:
        data = read_yaml(text)
        if isinstance(data, dict) and isinstance(data.get("system"), str) and source is not None:
            other = (Path() if source.parent == Path("/dev") else source.parent) / data["system"]  # of /dev/stdin
            data = data | {"system": _system_in(other, data["system"])}
        scene = scene_of(data, name)
    except YAMLTextError as error:
        raise SceneError(name, [str(error)]) from None
    except SceneError as error:
        raise SceneError(name, located(error.problems, lines_of(text))) from None
    # where the system is that of another file, the scene is kept with its numbers
    return scene._with_origin(as_written=None if other else text, source=source, system_file=other)


def _system_in(path: Path, written: str) -> object:
    """The `system` of another scene's file, whose name is written so. Raises SceneError."""
    try:
        data = read_yaml(path.read_text(encoding="utf-8-sig"))
    except (OSError, UnicodeDecodeError, YAMLTextError) as error:
        why = (
            "it is no text" if isinstance(error, UnicodeDecodeError) else getattr(error, "strerror", None) or str(error)
        )
        text = f"that file cannot be read: {why}; it must be another scene"
        raise SceneError(path.name, [problem("system", written, text)]) from None
    system = data.get("system") if isinstance(data, dict) else None
    if not isinstance(system, dict):
        raise SceneError(path.name, [problem("system", written, "that file must be a scene with a system of its own")])
    return system
