"""Makes the golden record anew, or compares all of it: see the words of the package `golden`."""

import sys

from golden import records, texts
from golden.checking import COMPARED, compared

from tools.golden import births, compliant, front, making, simulated, sweeps
from tools.golden.table import table

MADE = {  # kind -> its records, made now; in the order in which one kind needs another
    "branches": making.all_branches,
    "curves": lambda report: making.all_curves(list(records.read("branches").values()), report),
    "searches": making.all_searches,
    "windows": sweeps.all_windows,
    "sweeps": front.all_sweeps,
    "files": front.all_files,
    "figure_data": front.all_figure_data,
    "figures": front.all_figures,
    "answers": front.all_answers,
    "simulations": simulated.all_simulations,
    "exponents": lambda report: simulated.all_exponents(list(records.read("simulations").values()), report),
    "maps": simulated.all_maps,
    "texts": lambda _: [texts.record_of(command) for command in texts.commands()],
    "compliant_branches": compliant.all_branches,
    "compliant_curves": lambda report: compliant.all_curves(list(records.read("compliant_branches").values()), report),
    "compliant_searches": compliant.all_searches,
    "compliant_windows": sweeps.all_compliant_windows,
    "births": births.all_births,
    "onsets": births.all_onsets,
}


def report(line: str) -> None:
    print(line, flush=True)


def make(kinds) -> None:
    for kind in kinds:
        records.write(kind, MADE[kind](report))
    (records.FOLDER / "golden.log").write_text(table())


def check(kinds) -> None:
    for kind in kinds:
        for name, record in records.read(kind).items():
            for line in compared(kind, record):
                report(f"{kind}: {name}: {line}")


if __name__ == "__main__":
    if sys.argv[1:2] == ["check"]:
        check(sys.argv[2:] or COMPARED)
    else:
        make(sys.argv[1:] or MADE)
