"""Troubleshooting: what each status means, and what to do."""

from collections.abc import Iterator, Mapping

from vibro_sweep.model.bifurcations import CODIMENSION_TWO, TYPES
from vibro_sweep.model.outcomes import BRANCHES, EDGES, ORBITS, POINTS, REASONS, Outcome
from vibro_sweep.model.status import STATUSES

from ..console import EXIT_STATUSES
from .markdown import head, outcomes

MESSAGES = {  # a part of the message, and what to do
    "that is not complete": "The file is that of a run that was interrupted, or still goes on. Call the same "
    "command with `--resume`, or `mode='resume'` in Python.",
    "--overwrite replaces it": "A result or a picture has this name already. Choose another one by `-o`, or let "
    "`--overwrite` replace it.",
    "is not an HDF5 file, or it is damaged": "Copy the file again. `vibro-sweep info FILE.h5` names what is damaged, "
    "and which numbers are still those that were computed.",
    "did you mean": "A name is misspelt, or from another program. The message has the name that is closest.",
    "needs the package": "An optional package is not installed. The message has its name for `pip install`.",
    "a worker process died": "Most often the system had no memory left. Use fewer workers; `--resume` continues.",
}


def page() -> Iterator[str]:
    yield from head(
        "Troubleshooting by status",
        "What each status means, and what to do about it. Numbers that could not be computed are missing (NaN), never\n"
        "guessed, and a status says why.",
    )
    yield "## A point of a sweep (`status`)\n\nThe same names are the `status` of an orbit of `simulate`.\n"
    yield from outcomes((f"`{one.name}` ({code})", one.text, one.advice) for code, one in STATUSES.items())
    yield from _named("An orbit of a sweep in no window (`orbit_reason`)", REASONS)
    yield from _named("A periodic orbit (`PeriodicOrbit.status`)", ORBITS)
    yield from _named("A branch (`Branch.status`, `branch_status`)", BRANCHES)
    yield from _named("A point of a branch or a curve (`status` of their files)", POINTS)
    yield "## Where a branch or a window ends (`special_type`)\n"
    yield "[Bifurcations](bifurcations.md) has all types, with their marks in pictures.\n"
    yield from outcomes((f"`{one.name}`", one.text, one.advice) for one in TYPES)
    yield "## Where a curve ends\n"
    advice = {one.name: one.advice for one in TYPES}
    ends = (one for one in CODIMENSION_TWO if not one.label)
    yield from outcomes((f"`{one.name}`", one.text, advice[one.name]) for one in ends)
    yield from _named("An edge of a plane (`edge_reason`)", EDGES)
    yield "## Exit status of the program\n"
    yield from outcomes((f"{code}", one.text, one.advice) for code, one in EXIT_STATUSES.items())
    yield "## Common messages\n"
    for part, advice in MESSAGES.items():
        yield f"- **... {part} ...**: {advice}"


def _named(title: str, words: Mapping[str, Outcome]) -> Iterator[str]:
    yield f"## {title}\n"
    yield from outcomes((f"`{name}`", one.text, one.advice) for name, one in words.items())
