"""Laws of contact: one file each, found by being here. docs/development/architecture.md says how to add one."""

import pkgutil
from importlib import import_module

from vibro_sweep.oscillator.contact_laws.contact_law import ContactLaw

_ORDER = ("rigid", "compliant")  # others follow by name


def _found() -> dict[str, ContactLaw]:
    modules = (import_module(f"{__name__}.{file.name}") for file in pkgutil.iter_modules(__path__))
    laws = {module.LAW.name: module.LAW for module in modules if hasattr(module, "LAW")}
    return {name: laws[name] for name in sorted(laws, key=lambda name: (*_ORDER, name).index(name))}


LAWS = _found()
RIGID = LAWS["rigid"]
STOP_NUMBERS = tuple(number for law in LAWS.values() for number in law.numbers_of_both)
OTHER_STOPS = tuple(x for x in STOP_NUMBERS if x not in RIGID.numbers_of_both)  # of stops that are not rigid
