"""The golden record: what periodic orbits, branches, curves, searches and windows were in an earlier version.

    PYTHONPATH=tests python -m support.golden         # makes tests/data/golden anew (when: docs/development/)
    PYTHONPATH=tests python -m support.golden check   # compares all of it with what is computed now

Of the package these modules use what users use, and nothing inside it, so that any later version is compared. Only what
finds the cases (`named`, `drawing`) draws them with other modules of `support`.

Which of two mirror images comes first was left to rounding, and so to the kind of processor, when the record was made.
It no longer is, and the right one is first in two records that had the left one: 'paper, free motion, in b' and
'paper, free motion'.
"""
