"""The program `vibro-sweep`: its commands, its messages and its exit status.

Commands import what they need when they run, so that `--help` answers at once.
"""

from pathlib import Path
from typing import Annotated

import typer

from vibro_sweep.tables.picture_kinds import PICTURES

from . import interrupt
from .computing import Computation, compute, compute_windows
from .console import (
    BAD_INPUT,
    BAD_POINTS,
    EXIT_STATUSES,
    InputError,
    all_is_imported,
    each_of,
    ended,
    input_errors,
    messages,
    say,
)
from .options import display_option, key_and_value, number_in, positive
from .options import output as output_option
from .options import scene_file as scene_argument
from .usage import called

app = typer.Typer(
    help="Parameter sweeps of linear oscillators with impacts, with Lyapunov exponents.",
    epilog=f"Exit status: {'; '.join(f'{one.name} {one.text}' for one in EXIT_STATUSES)}.",
    no_args_is_help=True,
    rich_markup_mode=None,
    pretty_exceptions_enable=False,
    context_settings={"help_option_names": ["-h", "--help"]},
)

SceneFile = Annotated[Path, typer.Argument(metavar="SCENE.yaml", parser=scene_argument, help="- reads standard input.")]
DataFile = Annotated[Path, typer.Argument(metavar="FILE.h5", exists=True, dir_okay=False)]
Scheduler = Annotated[
    str | None, typer.Option(metavar="ADDRESS", help="Compute on the workers of a dask scheduler instead.")
]
Resume = Annotated[bool, typer.Option("--resume", help="Continue an interrupted run.")]
Overwrite = Annotated[bool, typer.Option("--overwrite", help="Replace an existing file.")]
DataFiles = Annotated[list[Path], typer.Argument(metavar="FILE.h5", exists=True, dir_okay=False)]
Json = Annotated[bool, typer.Option("--json", help="Print JSON, an object a file, each in a line.")]
Units = Annotated[
    str | None,
    typer.Option(metavar="NAMES", help="Units of what is shown, as mm,Hz; by default those of the file."),
]
Quiet = Annotated[bool, typer.Option("--quiet", help="Print nothing but warnings and errors.")]


def main(argv: list[str] | None = None) -> int:
    """Run the program with `argv`, by default the arguments of the process; return its exit status."""
    return ended(lambda: called(app, argv))


def _show_version(wanted: bool):
    if wanted:
        from vibro_sweep import __version__

        say(f"vibro-sweep {__version__}")
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
    output: Annotated[Path | None, output_option("FILE.h5", "SCENE.h5 in the current folder")] = None,
    workers: Annotated[
        int | None,
        typer.Option(parser=positive, metavar="N", help="Threads; by default one for each core."),
    ] = None,
    scheduler: Scheduler = None,
    resume: Resume = False,
    overwrite: Overwrite = False,
    plot: Annotated[bool, typer.Option("--plot", help="Draw the result, next to the file.")] = False,
    quiet: Quiet = False,
):
    """Compute a scene and write its HDF5 file."""
    if output is not None and output.suffix.lower() in (".csv", ".txt", ".dat"):
        table = f"`vibro-sweep table FILE.h5 -o {output}` writes a table"
        raise InputError(f"-o {output}: `run` writes HDF5, {output.stem}.h5; {table}")
    unnamed = output is None and scene_file.is_fifo()
    output = output or Path(f"{scene_file.stem}.h5")
    computation = Computation(output, workers, scheduler, resume, overwrite, plot, quiet, ("run", str(scene_file)))
    computation.announce()
    from vibro_sweep.scene import SceneError, load_scene

    with input_errors(SceneError):
        scene = load_scene(scene_file)
    if unnamed:
        raise InputError("a scene that comes out of a pipe has no name from which that of the file follows: add -o")
    computation.check_outputs(scene.inputs)
    bad = compute(computation, scene)
    if plot:
        _draw(output, computation.picture, None, overwrite, quiet)
    if bad:
        raise typer.Exit(BAD_POINTS)


@app.command("windows")
def windows_command(
    file: DataFile,
    output: Annotated[Path | None, output_option("FILE.h5", "FILE.windows.h5 in the current folder")] = None,
    parameter: Annotated[
        str | None, typer.Option(metavar="NAME", help="The swept number, of a plane; by default the first.")
    ] = None,
    workers: Annotated[
        int | None, typer.Option(parser=positive, metavar="N", help="Processes; by default one.")
    ] = None,
    scheduler: Scheduler = None,
    resume: Resume = False,
    overwrite: Overwrite = False,
    plot: Annotated[bool, typer.Option("--plot", help="Draw the sweep with its windows, next to the file.")] = False,
    units: Units = None,
    as_json: Json = False,
    quiet: Quiet = False,
):
    """Find the windows of a sweep and what ends them; write their file.

    A window is an interval on which one periodic orbit is stable. Each takes 15 to 300 ms, and each chaotic point 4000
    periods more, so a plane takes minutes. The sweep's file stays as it is.
    """
    output, display = output or Path(f"{file.name.removesuffix('.h5')}.windows.h5"), display_option(units, as_json)
    command = ("windows", str(file), *(("--parameter", parameter) if parameter else ()))
    computation = Computation(output, workers, scheduler, resume, overwrite, plot, quiet, command)
    computation.announce()
    computation.check_outputs([file])
    compute_windows(computation, file, parameter, display, as_json)
    if plot:
        _draw(file, computation.picture, None, overwrite, quiet or as_json, windows=output, units=units)


@app.command("plot")
def plot_command(
    files: DataFiles,
    output: Annotated[
        Path | None, output_option("FIGURE.png|.jpg|.svg|.pdf|.eps|.gif|.mp4", "FILE.png in the current folder")
    ] = None,
    kind: Annotated[
        str | None,
        typer.Option(
            metavar="KIND",
            help=f"One of {', '.join(PICTURES)} or all; by default the first that the file has data for.",
        ),
    ] = None,
    at: Annotated[
        list[str] | None,
        typer.Option(
            metavar="NAME=VALUE",
            help="Draw single orbits at this value of the sweep, by default into FILE-KIND.png; may be repeated.",
        ),
    ] = None,
    variable: Annotated[
        str | None,
        typer.Option(metavar="NAME", help="What to draw, such as v1, or period on a plane; a wrong one lists them."),
    ] = None,
    xlim: Annotated[
        tuple[str, str] | None, typer.Option(metavar="LOW HIGH", help="Range of the horizontal axis.")
    ] = None,
    ylim: Annotated[
        tuple[str, str] | None,
        typer.Option(metavar="LOW HIGH", help="Range of the vertical axis, of several panels of the first."),
    ] = None,
    size: Annotated[
        tuple[str, str] | None,
        typer.Option(metavar="WIDTH HEIGHT", help="In inches; by default 7 wide."),
    ] = None,
    width: Annotated[
        str | None, typer.Option(metavar="MM", help="Width in mm, as 85 for one column; the height follows.")
    ] = None,
    dpi: Annotated[str | None, typer.Option(metavar="N", help="Pixels an inch; by default 200.")] = None,
    windows: Annotated[
        Path | None,
        typer.Option(
            metavar="FILE.h5",
            exists=True,
            dir_okay=False,
            help="Windows of the sweep, to be shown.",
        ),
    ] = None,
    over: Annotated[
        Path | None,
        typer.Option(metavar="SWEEP.h5", exists=True, dir_okay=False, help="Draw branches or curves over a sweep."),
    ] = None,
    relative: Annotated[
        bool, typer.Option("--relative", help="Of curves and planes: b in parts of the grazing clearance b*.")
    ] = False,
    units: Units = None,
    points: Annotated[
        Path | None,
        typer.Option(
            metavar="FILE.csv", exists=True, dir_okay=False, help="Measured points: columns as frequency and x1."
        ),
    ] = None,
    overwrite: Annotated[
        bool,
        typer.Option("--overwrite", help="Replace an existing file, also one that is not a picture of this program."),
    ] = False,
):
    """Draw what files hold.

    Of a sweep, `vibro-sweep explore FILE.h5` shows the same diagram as a page with sliders.
    """
    options = {"at": dict(key_and_value(text) for text in at or ()), "variable": variable}
    for name, pair in (("xlim", xlim), ("ylim", ylim), ("size", size)):
        options[name] = pair and tuple(number_in(f"--{name}", text) for text in pair)
    for name, text in (("width", width), ("dpi", dpi)):
        options[name] = text and number_in(f"--{name}", text)
    options |= {"windows": windows, "over": over, "relative": relative, "units": units, "points": points}
    from vibro_sweep.plotting.picture_files import default_name

    if output is not None and len(files) > 1:
        raise InputError("--output names one picture; leave it out for several files: each is drawn into FILE.png")
    drawn: dict[str, Path] = {}
    for file in files:
        if (before := drawn.setdefault(default_name(file), file)) != file:
            raise InputError(f"{before} and {file} would both be drawn into {default_name(file)}; name it by --output")
    each_of(drawn.values(), lambda file: _draw(file, output, kind, overwrite, False, **options))


@app.command()
def info(files: DataFiles, units: Units = None, as_json: Json = False):
    """Say what files hold, how they were made, how far they are.

    Also how accurate they say they are.
    """
    from vibro_sweep.files.file_errors import StoreError

    display = display_option(units, as_json)
    if as_json:
        from .as_json import description_of
    else:
        from .info import description_of

    def describe(file: Path) -> None:
        with input_errors(StoreError):
            text, damaged = description_of(file) if as_json else description_of(file, display)
        say(text if as_json or file is files[0] else f"\n{text}")
        if damaged:
            raise SystemExit(BAD_INPUT)

    each_of(files, describe)


@app.command()
def table(
    file: DataFile,
    output: Annotated[Path | None, output_option("FILE.csv", "the terminal")] = None,
    variable: Annotated[
        list[str] | None,
        typer.Option(metavar="NAME", help="What to write, such as x1; may be repeated."),
    ] = None,
    units: Units = None,
    overwrite: Overwrite = False,
):
    """Write what a file holds as a table, with commas between the numbers.

    Of a sweep a row for each orbit; with --variable x1 for each of its section points. Of branches a row for each
    point, of windows for each window.
    """
    from vibro_sweep.files.file_errors import StoreError

    from .table import table_of

    if output is not None and output.exists() and not overwrite:
        raise InputError(f"-o {output}: exists; --overwrite replaces it, or name another file")
    with input_errors(StoreError):
        text = table_of(file, variable or (), display_option(units))
    if output is None:
        say(text.removesuffix("\n"))
    else:
        output.write_text(text, encoding="utf-8")
        say(str(output))


@app.command()
def check(
    scene_file: SceneFile,
    quick: Annotated[bool, typer.Option("--quick", help="Compute and compile nothing: the time is not told.")] = False,
):
    """Validate a scene; say what machine it describes, what it computes, its size and time.

    Orbits are measured for that: kernels that are not there yet are compiled first.
    """
    from vibro_sweep.scene import Scene, SceneError, load_scene

    with input_errors(SceneError):
        scene = load_scene(scene_file)

    from vibro_sweep.driver.compute import RunError
    from vibro_sweep.driver.cost import estimate

    from .described_machine import description
    from .summaries import cost_text

    say("\n".join([f"{scene_file}: {scene}", *description(scene)]))
    if quick:
        return
    all_is_imported()
    with input_errors(RunError), messages(quiet=False):
        cost = estimate(scene) if isinstance(scene, Scene) else None
    say("  time      of branches and curves is not known before" if cost is None else cost_text(cost))


@app.command()
def grazing(scene_file: SceneFile, units: Units = None):
    """Theorem 1: the clearance and phase of the grazing.

    There the non-impacting steady motion just touches its stops. If the scene sweeps what they depend on: the curve.
    """
    from vibro_sweep.checks.errors import ArgumentError
    from vibro_sweep.scene import SceneError, load_scene

    from .summaries import grazing_of

    display = display_option(units)
    with input_errors(SceneError, ArgumentError):
        scene = load_scene(scene_file)
        text = grazing_of(scene, display)
    say(text)


@app.command()
def models(
    name: Annotated[str | None, typer.Argument(metavar="[NAME]", help="Of a model or a law of contact.")] = None,
):
    """What oscillators and laws of contact there are; of one the equations, a sketch, its numbers."""
    from vibro_sweep.checks.refusals import ParameterError
    from vibro_sweep.oscillator.contact_laws import LAWS
    from vibro_sweep.oscillator.models import model_named

    from .summaries import law_text, model_list, model_text

    with input_errors(ParameterError):
        if name in LAWS:
            say(law_text(LAWS[name]))
        else:
            say(model_list() if name is None else model_text(model_named(name)))


@app.command()
def new(
    name: Annotated[str, typer.Argument(metavar="[NAME]", help="Of an example; another lists all.")] = "quickstart",
):
    """Write an example scene to start from, NAME.yaml, into this folder.

    Without a name the one of the README. Beside it scene.schema.json, by which editors complete and check scenes.
    """
    from .examples import ExampleError, write_example

    with input_errors(ExampleError):
        written = write_example(name)
    for path in written:
        say(str(path))


@app.command()
def schema():
    """Print the JSON Schema of a scene, for editors."""
    from .examples import schema_text

    say(schema_text())


@app.command("explore")
def explore_command(
    file: Annotated[
        Path | None,
        typer.Argument(
            metavar="[SCENE.yaml | FILE.h5]", exists=True, dir_okay=False, help="By default the quickstart scene."
        ),
    ] = None,
    port: Annotated[int, typer.Option(min=0, max=65535, metavar="N", help="By default any that is free.")] = 0,
    no_browser: Annotated[bool, typer.Option("--no-browser", help="Print the address only.")] = False,
):
    """Serve a page on which the diagram moves while you drag a slider.

    For a browser on this machine; the address is printed. Ctrl-C ends it.
    """
    from .exploring import explore

    explore(file, port, not no_browser)


@app.command("page")
def page_command(
    scene_file: Annotated[
        Path,
        typer.Argument(metavar="SCENE.yaml | FILE.h5", exists=True, dir_okay=False, help="A sweep, or its results."),
    ],
    output: Annotated[
        Path | None,
        typer.Option(
            "-o", "--output", metavar="FILE.html", help="By default the name of the scene, ending with .html."
        ),
    ] = None,
    overwrite: Overwrite = False,
    quiet: Quiet = False,
):
    """Write a diagram as one HTML file, which computes where it is opened: no program is needed there.

    Where the installation has no code for its kind of machine, that takes half a minute to make, and the package
    ziglang.
    """
    from vibro_sweep.live.presets import scene_to_explore
    from vibro_sweep.standalone.page_file import check_output, write_page

    path = scene_file.with_suffix(".html") if output is None else output
    all_is_imported()
    with input_errors(ValueError, OSError, ImportError), messages(quiet):
        check_output(path, overwrite)
        write_page(scene_to_explore(scene_file), path, overwrite)
    if not quiet:
        say(str(path))


def _draw(file: Path, output: Path | None, kind: str | None, overwrite: bool, quiet: bool, **options):
    from vibro_sweep.files.file_errors import StoreError
    from vibro_sweep.plotting.picture_files import PlotError
    from vibro_sweep.plotting.plot import write_pictures

    all_is_imported()
    with input_errors(PlotError, StoreError), interrupt.tidied_up(), messages(quiet):
        written = write_pictures(file, output, kind, overwrite, **options)
    if not quiet:
        say("\n".join(str(picture) for picture in written))
