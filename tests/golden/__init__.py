"""The golden record: what the package computed and showed in an earlier version, kind by kind.

A kind has a module here, which computes a case with what users use of the package, and nothing inside it, and says in
words what differs from its record; and a maker in `tools/golden/`, which finds the cases:

    PYTHONPATH=tests python -m tools.golden [KIND ...]         # makes tests/data/golden anew (when: docs/development/)
    PYTHONPATH=tests python -m tools.golden check [KIND ...]   # compares all of it with what is computed now

Which of two mirror images comes first was left to rounding, and so to the kind of processor, when the records of
branches and searches were made. It no longer is, and the right one is first in two records that had the left one:
'paper, free motion, in b' and 'paper, free motion'.
"""
