"""The golden record: what periodic orbits, branches, curves, searches and windows were in an earlier version.

    PYTHONPATH=tests python -m support.golden         # makes tests/data/golden anew (when: docs/development/)
    PYTHONPATH=tests python -m support.golden check   # compares all of it with what is computed now

Of the package these modules use what users use, and nothing inside it, so that any later version is compared. Only what
finds the cases (`named`, `drawing`) draws them with other modules of `support`.
"""
