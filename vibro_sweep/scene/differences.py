"""What differs between two scenes, line by line, for a message."""

import difflib
from itertools import takewhile, zip_longest
from operator import eq

from vibro_sweep.checks.refusals import LONGEST, cut

MOST = 8  # lines
BEFORE = LONGEST // 3  # letters of a long line before the first one that differs


def differences(old: str, new: str) -> str:
    """Lines of the old scene (-) and of the new one (+)."""
    old_lines, new_lines = old.splitlines(), new.splitlines()
    changed = []
    for tag, i, j, k, m in difflib.SequenceMatcher(None, old_lines, new_lines, autojunk=False).get_opcodes():
        for was, now in zip_longest(old_lines[i:j], new_lines[k:m]) if tag != "equal" else ():
            at = sum(takewhile(bool, map(eq, was or "", now or "")))
            changed += [f"  {sign} {_about(line, at)}" for sign, line in (("-", was), ("+", now)) if line is not None]
    return "\n".join(changed[:MOST] + (["  ..."] if len(changed) > MOST else []))


def _about(line: str, at: int) -> str:
    """A line, and of a long one the letters about this place."""
    if len(line) <= LONGEST or at <= BEFORE:
        return cut(line)
    return cut(f"...{line[at - BEFORE :]}")
