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

from .problems import SceneError, located
from .written import yaml_of
from .yaml_text import YAMLTextError, lines_of, read_yaml

S = TypeVar("S", bound="AnyScene")


@dataclass(frozen=True, eq=False, repr=False)
class AnyScene(ABC):
    """A scene: what to compute.

    source : the file that it was read from
    given : the YAML text that it was read from; None of a copy with other values
    checked : whether it was made from data, which were checked; `dataclasses.replace` makes one that is not
    """

    name: str
    system: Oscillator
    source: Path | None = field(default=None, kw_only=True)
    as_written: str | None = field(default=None, init=False)
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
        return [self.source] if self.source else []

    def _system_text(self, without: Collection[str]) -> str:
        """The oscillator in a few lines, but for numbers that change."""
        system = self.system
        usual = {"offset": 0.0}  # which most oscillators have
        known = {name: value for name, value in system.numbers.items() if value not in (None, usual.get(name))}
        known |= {name: value for name, value in system.options.items() if value is not None}
        said = wording.numbers({name: value for name, value in known.items() if name not in without})
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
    try:
        scene = scene_of(read_yaml(text), name)
    except YAMLTextError as error:
        raise SceneError(name, [str(error)]) from None
    except SceneError as error:
        raise SceneError(name, located(error.problems, lines_of(text))) from None
    return scene._with_origin(as_written=text, source=source)
