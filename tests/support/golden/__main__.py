"""Makes the golden record anew, or compares all of it: see the package's own words."""

import sys

from support.golden import files
from support.golden.checking import compared
from support.golden.making import all_branches, all_curves, all_searches
from support.golden.table import table


def make(kinds) -> None:
    def told(line):
        print(line, flush=True)

    if "branches" in kinds:
        files.write("branches", all_branches(told))
    if "curves" in kinds:
        files.write("curves", all_curves(list(files.read("branches").values()), told))
    if "searches" in kinds:
        files.write("searches", all_searches(told))
    if "windows" in kinds:
        from support.golden.sweeps import all_windows

        files.write("windows", all_windows(told))
    (files.FOLDER / "golden.log").write_text(table())


def check() -> None:
    for kind in files.KINDS:
        for name, record in files.read(kind).items():
            for line in compared(kind, record):
                print(f"{kind}: {name}: {line}", flush=True)


if __name__ == "__main__":
    if sys.argv[1:2] == ["check"]:
        check()
    else:
        make(sys.argv[1:] or files.KINDS)
