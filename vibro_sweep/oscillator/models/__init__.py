"""Oscillators with names: one file each, found by being here. docs/how/models.md says how to add one."""

import difflib
import pkgutil
from importlib import import_module

from vibro_sweep.checks.refusals import ParameterError, cut
from vibro_sweep.oscillator.models.declaration import Model

_ORDER = ("two_mass", "one_mass", "ball_in_cavity", "chain", "linear")  # others follow by name


def _found() -> dict[str, Model]:
    modules = (import_module(f"{__name__}.{file.name}") for file in pkgutil.iter_modules(__path__))
    models = {module.MODEL.name: module.MODEL for module in modules if hasattr(module, "MODEL")}
    return {name: models[name] for name in sorted(models, key=lambda name: (*_ORDER, name).index(name))}


MODELS = _found()
DEFAULT = "two_mass"


def model_named(name: str) -> Model:
    """Raises ParameterError where there is none."""
    if not (isinstance(name, str) and name in MODELS):
        close = difflib.get_close_matches(cut(name), MODELS, n=1) if isinstance(name, str) else ()
        hint = f" (did you mean {close[0]}?)" if close else ""
        raise ParameterError("model", name, f"one of {', '.join(MODELS)}{hint}")
    return MODELS[name]
