"""The program `vibro-sweep`: its commands, its messages and its exit status.

Commands import what they need when they run, so that `--help` answers at once.
"""

import contextlib
import os
import shlex
import sys
import tempfile
from pathlib import Path
from typing import Annotated

import typer

BAD_POINTS, BAD_INPUT, INTERRUPTED = 1, 2, 130

app = typer.Typer(
    help="Parameter sweeps of the two-degree-of-freedom impact oscillator, with Lyapunov exponents.",
    add_completion=False,
    no_args_is_help=True,
    rich_markup_mode=None,
    pretty_exceptions_enable=False,
    context_settings={"help_option_names": ["-h", "--help"]},
)

SceneFile = Annotated[Path, typer.Argument(metavar="SCENE.yaml", exists=True, dir_okay=False)]
DataFile = Annotated[Path, typer.Argument(metavar="FILE.h5", exists=True, dir_okay=False)]


class InputError(ValueError):
    """The command line asks for something that cannot be done."""


def main(argv: list[str] | None = None) -> int:
    """Run the program with `argv`, by default the arguments of the process; return its exit status."""
    try:
        app(args=argv, prog_name="vibro-sweep")
    except SystemExit as stop:
        return stop.code or 0
    return 0


def program() -> None:
    """`main` as a process, which it ends."""
    status = main()
    if status == INTERRUPTED:  # threads may be in the middle of a block, which may be long: do not wait for them
        sys.stdout.flush()
        sys.stderr.flush()
        os._exit(status)
    sys.exit(status)


def _positive(text: str) -> int:
    if not text.isdecimal() or int(text) < 1:
        raise typer.BadParameter(f"{text!r} is not a whole number >= 1")
    return int(text)


def _show_version(wanted: bool):
    if wanted:
        from . import __version__

        typer.echo(f"vibro-sweep {__version__}")
        raise typer.Exit


@app.callback()
def _program(
    version: Annotated[
        bool, typer.Option("--version", callback=_show_version, is_eager=True, help="Print the version.")
    ] = False,
):
    pass


@app.command()
def run(
    scene_file: SceneFile,
    output: Annotated[
        Path | None,
        typer.Option("-o", "--output", metavar="FILE.h5", help="By default SCENE.h5 in the current folder."),
    ] = None,
    workers: Annotated[
        int | None,
        typer.Option(parser=_positive, metavar="N", help="Threads; by default one for each core."),
    ] = None,
    scheduler: Annotated[
        str | None,
        typer.Option(metavar="ADDRESS", help="Compute on the workers of a dask scheduler instead."),
    ] = None,
    resume: Annotated[bool, typer.Option("--resume", help="Continue an interrupted run.")] = False,
    overwrite: Annotated[bool, typer.Option("--overwrite", help="Replace an existing file.")] = False,
    plot: Annotated[bool, typer.Option("--plot", help="Draw the result, next to the file.")] = False,
    quiet: Annotated[bool, typer.Option("--quiet", help="Print nothing but errors.")] = False,
):
    """Compute a scene and write its HDF5 file."""
    from .scene import SceneError, load_scene

    with _input_errors(SceneError):
        scene = load_scene(scene_file)
        output = output or Path(f"{scene_file.stem}.h5")
        _check_output(output, scene_file, resume, overwrite)

    from . import sweep
    from .progress import progress_bar
    from .store import StoreError

    mode = "resume" if resume else "overwrite" if overwrite else "new"
    again = ["vibro-sweep", "run", str(scene_file), "-o", str(output), "--resume"]
    again += ["--scheduler", scheduler] if scheduler else ["--workers", str(workers)] if workers else []
    with _input_errors(StoreError):
        try:
            with _executor(scheduler) as executor, progress_bar(scene.n_points, quiet) as progress:
                report = sweep.run(scene, output, workers, executor, progress, mode)
        except KeyboardInterrupt:
            typer.echo(f"vibro-sweep: interrupted; to continue: {shlex.join(again)}", err=True)
            raise typer.Exit(INTERRUPTED) from None
        except sweep.RunError as error:
            text = f"{error}. Nothing that was computed is lost; to continue: {shlex.join(again)}"
            raise InputError(text) from None
    if not quiet:
        typer.echo(_summary(output, report))
    if plot:
        _draw(output, None, None, quiet)
    if report.bad:
        raise typer.Exit(BAD_POINTS)


@app.command("plot")
def plot_command(
    file: DataFile,
    output: Annotated[
        Path | None,
        typer.Option("-o", "--output", metavar="FIGURE.png|.svg|.pdf", help="By default FILE.png."),
    ] = None,
    kind: Annotated[str | None, typer.Option(help="One kind of picture that the file has data for.")] = None,
):
    """Draw what a file holds."""
    _draw(file, output, kind, quiet=False)


@app.command()
def info(file: DataFile):
    """Say what a file holds, how it was made, how far it is.

    Also how accurate it says it is.
    """
    from .store import StoreError, describe

    with _input_errors(StoreError):
        text = describe(file)
    typer.echo(text)


@app.command()
def check(scene_file: SceneFile):
    """Validate a scene; say what it computes, its size and time."""
    from .scene import SceneError, load_scene

    with _input_errors(SceneError):
        scene = load_scene(scene_file)

    from .compute import RunError
    from .cost import estimate

    with _input_errors(RunError):
        cost = estimate(scene)
    typer.echo(f"{scene_file}: {scene}")
    typer.echo(f"  file      {_points(cost.points)}, {_bytes(cost.bytes)}")
    typer.echo(f"  work      {cost.orbits:,} orbits, {cost.periods:,} forcing periods in all")
    typer.echo(f"  time      about {_duration(cost.seconds)} here, once compiled")


@app.command()
def grazing(scene_file: SceneFile):
    """Theorem 1: the clearance and phase of the double grazing.

    There the non-impacting steady motion just touches both stops. If the scene sweeps what they depend on: the curve.
    """
    from .scene import SceneError, load_scene
    from .system import grazing

    with _input_errors(SceneError):
        scene = load_scene(scene_file)
    along = [key for key in scene.sweep if key in ("mu_m", "mu_k", "zeta", "f2", "omega")]
    if len(along) == 1:
        typer.echo(f"# {along[0]} b* tau*")
        for value in scene.sweep[along[0]].tolist():
            touch = grazing(scene.system.replace(**{along[0]: value}))
            typer.echo(f"{value!r} {touch.b!r} {touch.tau!r}")
        return
    touch = grazing(scene.system)
    _, _, x2, v2 = touch.state
    if along:
        first = ", ".join(f"{key} = {getattr(scene.system, key)!r}" for key in along)
        typer.echo(f"at the first point of the sweep: {first}")
    typer.echo(f"b*    = {touch.b!r}")
    typer.echo(f"tau*  = {touch.tau!r}")
    typer.echo(f"state = x1: {touch.b!r}, v1: 0, x2: {x2!r}, v2: {v2!r}   (right stop; left stop: its negative)")
    holds = "holds" if touch.satisfied else "does not hold"
    typer.echo(f"the existence condition (19) {holds}; determinant (15): {touch.determinant:.6g}")


@app.command()
def schema():
    """Print the JSON Schema of a scene, for editors."""
    import json

    from .scene import json_schema

    typer.echo(json.dumps(json_schema(), indent=2))


@contextlib.contextmanager
def _input_errors(*kinds: type[Exception]):
    """What the user can mend ends in one message and status 2; the rest is a bug and keeps its traceback."""
    try:
        yield
    except (InputError, OSError, MemoryError, *kinds) as error:
        text = str(error) or type(error).__name__
        if isinstance(error, OSError) and error.filename is not None and error.strerror:
            text = f"{error.filename}: {error.strerror}"
        typer.echo(f"vibro-sweep: error: {text}", err=True)
        raise typer.Exit(BAD_INPUT) from None


def _check_output(output: Path, scene_file: Path, resume: bool, overwrite: bool):
    """Raise InputError, before anything is computed, where `output` could not be written in the end."""
    part = Path(f"{output}.part")
    if resume and overwrite:
        raise InputError("--resume and --overwrite exclude each other: continue the old file or replace it")
    if output.is_dir():
        raise InputError(f"--output {output} is a folder; it must be a file")
    if output.exists() and output.samefile(scene_file):
        raise InputError(f"--output {output} is the scene itself")
    if output.exists() and not (resume or overwrite):
        rest = f" ({part} is an interrupted run: --resume continues that)" if part.exists() else ""
        raise InputError(f"{output} exists; --overwrite replaces it, or name another file with -o{rest}")
    if part.exists() and not (resume or overwrite):
        raise InputError(f"{part} is an interrupted run; --resume continues it, --overwrite starts again")
    if not output.parent.is_dir():
        raise InputError(f"--output {output}: there is no folder {output.parent}")
    try:
        with tempfile.TemporaryFile(dir=output.parent):
            pass
    except OSError as error:
        raise InputError(f"--output {output}: cannot write into {output.parent}: {error.strerror}") from None


@contextlib.contextmanager
def _executor(scheduler: str | None):
    if scheduler is None:
        yield None
        return
    try:
        from .cluster import ClusterError, cluster
    except ImportError:
        text = f"--scheduler {scheduler} needs the package dask.distributed: pip install distributed"
        raise InputError(text) from None
    try:
        with cluster(scheduler) as executor:
            yield executor
    except ClusterError as error:
        raise InputError(f"--scheduler {scheduler}: {error}") from None


def _draw(file: Path, output: Path | None, kind: str | None, quiet: bool):
    from .plotting import PlotError, plot
    from .store import StoreError

    with _input_errors(PlotError, StoreError):
        pictures = plot(file, output, kind)
    if not quiet:
        typer.echo("\n".join(str(picture) for picture in pictures))


def _summary(output: Path, report) -> str:
    bad = {name: count for name, count in report.statuses.items() if name != "ok" and count}
    named = ", ".join(f"{name} {count}" for name, count in bad.items())
    state = f"{report.bad} with a bad status ({named})" if report.bad else "all ok"
    return f"{output}: {_points(report.points)} in {_duration(report.seconds)}, {state}"


def _points(count: int) -> str:
    return f"{count:,} point" + "s" * (count != 1)


def _duration(seconds: float) -> str:
    if seconds < 100:
        return f"{seconds:.2g} s"
    return f"{seconds / 60:.0f} min" if seconds < 6000 else f"{seconds / 3600:.3g} h"


def _bytes(size: float) -> str:
    for unit in ("B", "kB", "MB"):
        if size < 1000:
            return f"{size:.3g} {unit}"
        size /= 1000
    return f"{size:.3g} GB"
