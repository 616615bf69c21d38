"""Runs killed at random moments and resumed (tests/support/kills.py): a Markdown table of what the kills cost.

python benchmarks/kills.py [--kills 102] [--seed 1] [--by "1 worker" "2 workers" Dask]
"""

import argparse
import collections
import signal

import shared  # noqa: F401
from book import table
from support import kills


def report(measured) -> str:
    """Of what `measure` has found for each of the keys of `kills.BY`."""
    rows, notes = [], []
    for by, (found, seconds, same) in measured.items():
        groups = collections.defaultdict(list)
        for kill in found:
            groups[kill.how, kill.when].append(kill)
        for (how, when), group in sorted(groups.items()):
            points, most = [kill.points for kill in group], max(kill.blocks for kill in group)
            rows.append((by, how, when, len(group), sum(points), f"{most:.2f}"))
        points, again = kills.POINTS * len(found), sum(kill.points for kill in found)
        notes.append(
            f"By {by}: {len(found)} runs of {seconds:.1f} s, each killed once. After they were resumed all arrays are "
            f"{'' if same else 'NOT '}equal bit for bit to those of an undisturbed run. Of {points:,} "
            f"points {again:,} were computed again."
        )
    header = ("by", "signal", "killed", "runs", "points computed again", "in blocks, most")
    return "\n".join([table(header, rows), *notes])


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--kills", type=int, default=102, help="of all three kinds together")
    parser.add_argument("--by", nargs="*", choices=kills.BY, default=list(kills.BY))
    parser.add_argument("--seed", type=int, default=1)
    chosen = parser.parse_args()
    if signal.getsignal(signal.SIGINT) == signal.SIG_IGN:  # so is a job in the background born, and its children too
        signal.signal(signal.SIGINT, signal.default_int_handler)
    signal.signal(signal.SIGHUP, signal.SIG_DFL)  # which `nohup` lets nobody hear
    each = -(-chosen.kills // len(chosen.by))
    print(report({by: kills.measure(each, by, chosen.seed + k) for k, by in enumerate(chosen.by)}))


if __name__ == "__main__":
    main()
