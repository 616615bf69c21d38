"""A record compared with what is computed now."""

from golden import (
    answers,
    births,
    branches,
    curves,
    exponents,
    figures,
    files,
    maps,
    onsets,
    searches,
    simulations,
    sweeps,
    texts,
    windows,
)

COMPARED = {  # kind -> what differs between a record and what is computed now, in words; nothing: []
    "branches": branches.differences_from,
    "curves": curves.differences_from,
    "files": files.differences_from,
    "figures": figures.differences_from,
    "searches": searches.differences_from,
    "sweeps": sweeps.differences_from,
    "answers": answers.differences_from,
    "windows": windows.differences_from,
    "simulations": simulations.differences_from,
    "exponents": exponents.differences_from,
    "maps": maps.differences_from,
    "texts": texts.differences_from,
    "compliant_branches": branches.differences_from,
    "compliant_curves": curves.differences_from,
    "compliant_searches": searches.differences_from,
    "compliant_windows": windows.differences_from,
    "births": births.differences_from,
    "onsets": onsets.differences_from,
}


def compared(kind: str, record: dict) -> list[str]:
    """In words what differs; none: []."""
    try:
        return COMPARED[kind](record)
    except (ValueError, LookupError) as error:
        return [f"{type(error).__name__}: {error}"]
