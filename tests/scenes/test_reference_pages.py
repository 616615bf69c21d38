"""What a user is told of numbers and variables is what systems and files have: docs/reference, `--help`, docstrings."""

import inspect
import re

import numpy as np
import pytest
from support import ROOT
from support.programs import ended
from support.scene_texts import parsed

import vibro_sweep as vs

REFERENCE = ROOT / "docs" / "reference"
PAPER = {"mu_m": 10, "mu_k": 5, "zeta": 0.05, "f2": 0.1, "omega": 0.63, "R": 0.8, "b": 6.6}
SHORT = {"transient": 3, "record": 60}
SOFT = {"R": None, "k_stop": 100.0}
LONGEST_LABEL = 30  # characters, beside an axis

PERIOD = "period approached_period approached_distance approached_factor"
STATES, SPECTRUM = "x1 v1 x2 v2 " + PERIOD, "lyapunov lyapunov_error lyapunov_residual"
VARIABLES = {  # of a file, by what is observed
    "section": STATES,
    "lyapunov": SPECTRUM,
    "multipliers": "multiplier_re multiplier_im multiplier_error " + PERIOD,
    "impacts": "impacts_right impacts_left min_impact_speed contact_error sticking_time",
    "attractors": "attractor attractor_id share average average_error " + PERIOD,
    "convergence": "lyapunov_running",
    "contacts": "contacts_right contacts_left contact_time contact_force_max penetration_max restitution_mean",
    "energy": "impact_power rms_x1 rms_v1 rms_x2 rms_v2 peak_x1 peak_v1 peak_x2 peak_v2",
}


def table(page, heading=""):
    """Rows of the first table behind a heading of a page."""
    text = (REFERENCE / page).read_text().partition(heading or "\n")[2].partition("| --- |")[2].partition("\n\n")[0]
    rows = [re.split(r" *(?<!\\)\| *", line.strip("| "))[:5] for line in text.splitlines()[1:]]
    assert len(rows) > 8
    return {row[0].strip("`"): [cell.replace("\\|", "|") for cell in row[1:]] for row in rows}


@pytest.mark.slow
@pytest.mark.parametrize("changes, without", [({}, "contacts"), (SOFT, "multipliers")], ids=["rigid", "compliant"])
def test_variables_of_a_file_are_those_of_the_reference(changes, without):
    """Description, dimensions, type and unit; and names are short enough for axes."""
    told, dimensions = table("variables.md"), table("variables.md", "## Dimensions\n")
    system = vs.System(**PAPER | changes, units="SI")
    axes, words = {"b": [6.0, 7.0], "omega": [0.6, 0.7]}, [word for word in VARIABLES if word != without]
    start, trajectory = {"random": 2}, {"periods": 2, "samples": 5}
    if "multipliers" in words:
        words.remove("convergence")
    data = vs.sweep(system, axes, observe=words, start=start, trajectory=trajectory, **SHORT)
    compared = 0
    for name, values in data.variables.items():
        assert 0 < len(values.attrs["long_name"]) <= LONGEST_LABEL and values.attrs["description"]
        if name in told:
            compared += 1
            description, dims, kind, unit = told[name]
            own = [dim for dim in values.dims if dim not in (*axes, "start")]
            assert (values.attrs["description"], ", ".join(own)) == (description, dims), name
            assert (values.dtype.str[1:], values.attrs["units"]) == (kind, unit), name
        elif name in dimensions:
            compared += 1
    assert compared > 40 and {"b", "omega", "tau", "b_star", "sample"} <= {*data.variables}


@pytest.mark.slow
@pytest.mark.parametrize("word", VARIABLES)
def test_a_file_has_the_variables_of_its_words(word):
    system = vs.System(**PAPER | (SOFT if word == "contacts" else {}))
    start = {"random": 2} if word == "attractors" else None
    data = vs.sweep(system, {"b": [6.0, 7.0]}, observe=[word], start=start, **SHORT)
    assert {*data.data_vars} == {*VARIABLES[word].split(), "status"}


@pytest.mark.parametrize("section, phase", [("", False), ("section: {kind: impact, stop: left}\n", True)])
def test_the_phase_belongs_to_sections_at_impacts(section, phase, tmp_path):
    text = "system: {mu_m: 10, mu_k: 5, zeta: 0.05, f2: 0.1, omega: 0.63, R: 0.8, b: 6}\n"
    vs.run(parsed(f"{text}orbit: {{transient: 3, record: 5}}\n{section}observe: [section]\n"), tmp_path / "a.h5")
    with vs.open(tmp_path / "a.h5") as data:
        assert ("phase" in data) == phase


def test_each_parameter_has_its_text_and_its_range():
    """The same in the docstring, in the reference, and in the signature."""
    told = table("scenes.md", "## Numbers of two masses, and of a start\n")
    names = [name for name in inspect.signature(vs.System).parameters if name not in ("stops", "units", "release")]
    assert [name for name in told if not name.startswith(("start_", "b_"))] == names and len(names) == 17
    for name in names:
        assert f"{name} : {told[name][0]}; {told[name][1]}" in vs.System.__doc__, name


@pytest.mark.parametrize("name", ["mu_m", "mu_k", "zeta", "f2", "omega", "b", "R", "offset", "R_left", "mu_c"])
def test_clearances_of_grazing_are_coordinates_along_what_they_follow_from(name):
    """Theorem 1: along a number on which the free motion does not depend they are attributes of the file."""
    system = vs.System(**PAPER)
    values = system.parameters()[name] + np.array([0.0, 0.05])
    first, second = (vs.grazing(system.replace(**{name: value})) for value in values)
    data = vs.sweep(system, {name: values}, transient=1, record=1, observe=["section"])
    there = {"b_star", "b_right", "b_left"} & {*data.variables, *data.attrs}
    along = there & {*data.variables}
    assert there and bool(along) == ((first.b_right, first.b_left) != (second.b_right, second.b_left))


def test_each_command_and_option_is_in_the_reference():
    commands = re.findall(r"^  (\w+)  ", ended("--help").out.partition("Commands:")[2].partition("Exit")[0], re.M)
    text, compared = (REFERENCE / "commands.md").read_text(), 0
    for command in commands:
        section, told = (
            text.partition(f"## `vibro-sweep {command}`\n")[2].partition("\n## ")[0],
            ended(command, "-h").out,
        )
        options = {*re.findall(r"(?<![\w-])(--[a-z-]+)", told.partition("Options:")[2])} - {"--help"}
        assert told.splitlines()[2].strip() in section
        assert [option for option in options if option not in section] == [], command
        compared += len(options)
    assert len(commands) == 12 and compared == 45


def test_each_outcome_that_is_not_good_says_what_to_do():
    """Below its name and its meaning."""
    lines = (REFERENCE / "statuses.md").read_text().splitlines()
    names = {k: match[1] for k, line in enumerate(lines) if (match := re.match(r"- \*\*`(\w+)`", line))}
    without = {name for k, name in names.items() if not re.match(r"  \S", lines[k + 1])}
    assert without == {"ok", "in_a_window", "chaos", "curve", "closed"} and len(names) > 45
    status = vs.sweep(vs.System(**PAPER), {"b": [6.0]}, transient=1, record=1, observe=["section"]).status
    assert {*status.attrs["flag_meanings"].split()} <= {*names.values()}


def test_common_messages_are_those_of_the_program():
    """`... part of a message ...` on the page is in a module that prints it."""
    parts = re.findall(r"^- \*\*\.\.\. (.*) \.\.\.\*\*", (REFERENCE / "statuses.md").read_text(), re.M)
    sources = [path.read_text() for path in (ROOT / "vibro_sweep").rglob("*.py")]
    assert len(parts) > 5 and [part for part in parts if not any(part in source for source in sources)] == []
