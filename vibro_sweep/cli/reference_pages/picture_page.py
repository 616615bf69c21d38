"""Kinds of pictures."""

from collections.abc import Iterator

from vibro_sweep.plotting import KINDS

from .markdown import head, summary, table


def page() -> Iterator[str]:
    yield from head(
        "Kinds of pictures",
        "`vs.plot(data, kind)` and `vibro-sweep plot FILE.h5 --kind KIND` draw what a file holds. The default is the\n"
        "scene's `picture`, else the first kind that the file can show. The [gallery](../auto_gallery/index.rst) has\n"
        "examples.",
    )
    rows = ((f"`{kind}`", summary(one.draw), summary(one.shows)) for kind, one in KINDS.items())
    yield from table(("kind", "what it shows", "needs"), rows)
    single = ", ".join(f"`{kind}`" for kind, one in KINDS.items() if one.of_orbits)
    yield (
        f"`--at NAME=VALUE` draws single orbits at that value of the sweep, by default into FILE-KIND.png; the kinds\n"
        f"{single}\n"
        "show these. `--variable NAME` draws another variable (a wrong name lists those of the file),\n"
        "`--xlim LOW HIGH` and `--ylim LOW HIGH` a part, `--size WIDTH HEIGHT` (inches),\n"
        "`--width MM` (85: one column of a journal) and `--dpi N` set how large it is. All options are\n"
        "those of [the command](commands.md#vibro-sweep-plot)."
    )
