"""What newcomers write by mistake, and what must be said to it: what to write instead, and where."""

import pytest

from vibro_sweep.cli.commands import main
from vibro_sweep.scene import SceneError, parse_scene
from vibro_sweep.scene.slips import meant, number_in_text

NUMBERS = "mu_m: 10, mu_k: 5, zeta: 0.05, f2: 0, omega: 0.63, R: 0.8, b: 6.6"
BLOCK = "system:\n  mu_m: 10\n  mu_k: 5\n  zeta: {zeta}\n  f2: 0\n  omega: 0.63\n  {R}\n  b: 6.6\n"
PHYSICAL = "M1: 4, M2: 10, K1: 1, K2: 5, C1: 0.1, C2: 0.5, P1: 2, P2: 0, Omega: 0.63, R: 0.8, B: 6"
ORBIT = "orbit: {transient: 2, record: 3}\n"


def scene(more="", numbers=NUMBERS, orbit=ORBIT):
    return f"system: {{{numbers}}}\n{orbit}{more}\n"


def number(old, new):
    return scene(numbers=NUMBERS.replace(old, new))


def physical(more="", numbers=PHYSICAL):
    return f"system: {{physical: {{{numbers}}}}}\n{ORBIT}{more}\n"


SCENES = {
    # slip: (the text, what must be said); every text with a key has "(line n)" behind it
    "no space after the colon, in braces": (number("R: 0.8", "R:0.8"), ["write `R: 0.8`", "(line 1)"]),
    "no space after the colon": (
        BLOCK.format(zeta=0.05, R="R:0.8") + ORBIT,
        ["line 7 needs a space after the colon: `R: 0.8`"],
    ),
    "decimal comma, in braces": (
        number("0.63", "0,63"),
        ["system.63", "a decimal number has a point: 0.63", "(line 1)"],
    ),
    "decimal comma": (BLOCK.format(zeta="0,05", R="R: 0.8") + ORBIT, ["system.zeta", "has a point: 0.05", "(line 4)"]),
    "equals signs": (scene(numbers=NUMBERS.replace(": ", "=")), ["write `mu_m: 10`", "write `b: 6.6`", "(line 1)"]),
    "semicolons": (scene(numbers=NUMBERS.replace(", ", "; ")), ["line 1", "a comma is missing"]),
    "tabs": ("system:\n\tmu_m: 10\n", ["line 2", "spaces, not with tabs"]),
    "wrong indentation": ("system:\n  mu_m: 10\n   mu_k: 5\n", ["line 3", "indented more"]),
    "open brace": ("system: {" + NUMBERS + "\n" + ORBIT, ["begins in line 1 is not closed"]),
    "list for a scene": ("- system\n- orbit\n", ["must be a mapping with the keys system"]),
    "per cent": (number("R: 0.8", "R: 80%"), ["system.R", "write 0.8", "(line 1)"]),
    "fraction": (number("0.05", "1/20"), ["system.zeta", "write 0.05", "(line 1)"]),
    "quotes": (number("R: 0.8", "R: '0.8'"), ["system.R", "write 0.8 without quotes"]),
    "yes": (number("R: 0.8", "R: yes"), ["system.R", "must be a number, not text"]),
    "pi": (scene(numbers=f"{NUMBERS}, tau: pi/2"), ["system.tau", "pi is 3.14159265"]),
    "unit": (physical(numbers=PHYSICAL.replace("M1: 4", "M1: 4 kg")), ["physical.M1", "numbers have no units"]),
    "thousands": (scene(orbit="orbit: {transient: 1_000, record: 3}\n"), ["orbit.transient", "write 1000", "(line 2)"]),
    "Omega for omega": (number("omega", "Omega"), ["system.Omega", "did you mean `omega`?", "(line 1)"]),
    "w for omega": (number("omega", "w"), ["system.w", "did you mean `omega`?"]),
    "frequency for omega": (number("omega", "frequency"), ["did you mean `omega`?"]),
    "B for b": (number("b: 6.6", "B: 6.6"), ["system.B", "did you mean `b`?"]),
    "gap for b": (number("b: 6.6", "gap: 6.6"), ["system.gap", "did you mean `b`?"]),
    "r for R": (number("R: 0.8", "r: 0.8"), ["system.r", "did you mean `R`?"]),
    "e for R": (number("R: 0.8", "e: 0.8"), ["system.e", "did you mean `R`?"]),
    "Greek letters": (number("zeta", "ζ"), ["system.ζ", "did you mean `zeta`?"]),
    "frequency 0": (number("0.63", "0"), ["system.omega = 0: must be a finite number > 0 (line 1)"]),
    "R above 1": (number("0.8", "1.5"), ["system.R = 1.5: must be a finite number from 0 to 1 (line 1)"]),
    "negative mass": (number("10", "-1"), ["system.mu_m = -1: must be a finite number > 0 (line 1)"]),
    "stops by place": (scene(numbers=f"{NUMBERS}, stops: {{left: -6}}"), ["write stops: left", "is said by b"]),
    "stops as a list": (scene(numbers=f"{NUMBERS}, stops: [left, right]"), ["write stops: both"]),
    "stops of nothing": (scene(numbers=f"{NUMBERS}, stops: [[], left]"), ["write stops: left"]),
    "two stops": (scene(numbers=f"{NUMBERS}, stops: two"), ["did you mean `both`?"]),
    "number of stops": (scene(numbers=f"{NUMBERS}, stops: 2"), ["did you mean `both`?"]),
    "physical numbers without the word": (
        f"system: {{{PHYSICAL}}}\n{ORBIT}",
        ["M1, M2, K1, K2, C1, C2, P1, P2, Omega, B are physical quantities; write system: {physical:", "(line 1)"],
    ),
    "frequency in Hz": (
        physical(numbers=PHYSICAL.replace("Omega: 0.63", "f: 4.5")),
        ["physical.f = 4.5", "if it is in Hz write Omega: 28.27433388"],
    ),
    "a frequency in Hz beyond all floats": (
        physical(numbers=PHYSICAL.replace("Omega: 0.63", "f: 1" + 400 * "0")),
        ["physical.f", "write Omega: inf"],
    ),
    "Hz swept in SI": (
        f"system: {{type: chain, m: [1], k: [1, 0], force: [1], R: 1, b: 1, units: SI}}\n{ORBIT}\n"
        "sweep: {Hz: {start: 20, stop: 30, num: 3}}",
        ["sweep.Hz", "omega is swept, in rad/s: 20 Hz is omega = 125.664", "(line 4)"],
    ),
    "Hz swept of physical numbers": (
        physical("sweep: {f: {values: [20]}}"),
        ["omega is swept, here in units of 0.5 rad/s: 20 Hz is omega = 251.327"],
    ),
    "a mass of one_mass": (
        f"system: {{type: one_mass, m: 2, zeta: 0, F: 1, omega: 1, R: 1, b: 1}}\n{ORBIT}",
        ["system.m = 2", "the mass of one_mass is 1", "`vibro-sweep new one_mass_si`"],
    ),
    "one mass among physical numbers": (
        physical(numbers=PHYSICAL.replace("M2: 10, ", "")),
        ["one mass in kg and N/m is a chain of one"],
    ),
    "gap among physical numbers": (physical(numbers=PHYSICAL.replace("B:", "gap:")), ["did you mean `B`?"]),
    "omega among physical numbers": (physical(numbers=PHYSICAL.replace("Omega", "omega")), ["did you mean `Omega`?"]),
    "Omega swept": (
        physical("sweep: {Omega: {values: [0.6, 0.7]}}"),
        ["sweep.Omega", "write omega = Omega sqrt(M1/K1) = 2 Omega, and its values", "(line 3)"],
    ),
    "B swept": (physical("sweep: {B: {values: [5, 6]}}"), ["sweep.B", "write b = B K1/(P1 + P2) = 0.5 B"]),
    "mass swept": (physical("sweep: {M1: {values: [5, 6]}}"), ["sweep.M1", "mu_m = M2/M1"]),
    "num with step": (
        scene("sweep: {b: {start: 6, stop: 7, step: 0.1, num: 3}}"),
        ["sweep.b.step", "exclude each other"],
    ),
    "from, to, n": (
        scene("sweep: {b: {from: 6, to: 7, n: 3}}"),
        ["3 problems", "did you mean `start`?", "did you mean `stop`?", "did you mean `num`?"],
    ),
    "min and max": (
        scene("sweep: {b: {min: 6, max: 7, num: 3}}"),
        ["2 problems", "did you mean `start`?", "did you mean `stop`?"],
    ),
    "neither num nor step": (scene("sweep: {b: {start: 6, stop: 7}}"), ["step or num must be given", "(line 3)"]),
    "axis as a list": (scene("sweep: {b: [6, 7]}"), ["write b: {values: [6, 7]}, or {start: 6, stop: 7, num: 101}"]),
    "axis as a number": (scene("sweep: {b: 6}"), ["a number that does not vary stands in system"]),
    "axis as a text": (scene("sweep: {b: 6..7}"), ["write b: {start: 6.5, stop: 6.9, num: 401}"]),
    "axis as a call": (scene("sweep: {b: linspace(6, 7, 11)}"), ["write b: {start:"]),
    "one value": (scene("sweep: {b: {values: 6}}"), ["write values: [6]"]),
    "values without brackets": (scene("sweep: {b: {values: 6, 7}}"), ["write values: [6]", "a comma separates"]),
    "sweep as a word": (scene("sweep: b"), ["write sweep: {b: {start: 6.5, stop: 6.9, num: 401}}"]),
    "sweep as a list": (scene("sweep: [omega, b]"), ["write sweep: {omega: {start:"]),
    "step of the wrong sign": (scene("sweep: {b: {start: 7, stop: 6, step: 0.1}}"), ["wrong sign", "< 0", "(line 3)"]),
    "three swept numbers": (
        scene("sweep: {b: {values: [6, 7]}, R: {values: [0.7]}, f2: {values: [0]}}"),
        ["one key or two", "(line 3)"],
    ),
    "start at rest": (scene("start: rest"), ["write start: {x1: 0, v1: 0, x2: 0, v2: 0}, or leave it out"]),
    "start as a list": (scene("start: [1, 0, 2, 0]"), ["write start: {x1: 1, v1: 0, x2: 2, v2: 0}"]),
    "start as a word": (scene("start: random"), ["write start: {random: 16, seed: 1}"]),
    "start that follows": (scene("start: follow"), ["write start: {follow: up}"]),
    "follow yes": (scene("start: {follow: yes}\nsweep: {b: {values: [6, 7]}}"), ["up, down, both", "(line 3)"]),
    "state without numbers": (scene("start: {x: 1}"), ["start.x", "did you mean `x1`?"]),
    "observe one word": (scene("observe: lyapunov"), ["write observe: [lyapunov]", "(line 3)"]),
    "observe as a mapping": (scene("observe: {lyapunov: true}"), ["write observe: [lyapunov]"]),
    "observe exponents": (scene("observe: [exponents]"), ["observe[0]", "did you mean `lyapunov`?", "(line 3)"]),
    "observe the Poincare section": (scene("observe: [poincare]"), ["did you mean `section`?"]),
    "orbit as a number": (scene(orbit="orbit: 1000\n"), ["write orbit: {transient: 1000, record: 200}", "(line 2)"]),
    "transients": (scene(orbit="orbit: {transients: 2, record: 3}\n"), ["did you mean `transient`?"]),
    "no orbit": (f"system: {{{NUMBERS}}}", ["orbit: missing"]),
    "section as a word": (scene("section: impact"), ["write section: {kind: impact}"]),
    "side of a section": (scene("section: {kind: impact, side: right}"), ["did you mean `stop`?"]),
    "trajectory yes": (scene("trajectory: true"), ["write trajectory: {periods: 4, samples: 400}"]),
    "dynamics: mapping": (scene("dynamics: mapping"), ["did you mean `map`?"]),
    "System": (scene().replace("system", "System"), ["did you mean `system`?", "(line 1)"]),
    "parameters": (scene().replace("system", "parameters"), ["did you mean `system`?"]),
}


@pytest.mark.parametrize("slip", SCENES)
def test_slip_in_a_scene(slip):
    text, words = SCENES[slip]
    with pytest.raises(SceneError) as caught:
        parse_scene(text, "x.yaml")
    message = str(caught.value)
    for word in words:
        assert word in message
    assert "finite, " not in message and "Traceback" not in message


COMMANDS = {
    "good.yaml": ["there is no command 'good.yaml'", "`vibro-sweep run good.yaml`"],
    "data.h5": ["`vibro-sweep plot data.h5`"],
    "run data.h5": ["data.h5", "is a data file, not a scene", "`vibro-sweep info`"],
    "check data.h5": ["is a data file, not a scene"],
    "plot good.yaml": ["good.yaml is a scene", "`vibro-sweep run good.yaml`"],
    "info good.yaml": ["good.yaml is a scene"],
    "run good": ["'good' does not exist", "did you mean good.yaml?"],
    "run goood.yaml": ["did you mean good.yaml?"],
    "run": ["Missing argument 'SCENE.yaml'", "`vibro-sweep run --help`"],
    "run good.yaml -j 4": ["there is no option -j", "did you mean --workers?"],
    "run good.yaml --worker 4": ["did you mean --workers?"],
    "run good.yaml --force": ["did you mean --overwrite?"],
    "run good.yaml --plots": ["did you mean --plot?"],
    "run good.yaml --kind plane": ["there is no option --kind", "`vibro-sweep run --help`"],
    "run good.yaml --workers all": ["--workers", "'all' is not a whole number >= 1"],
    "run good.yaml second.yaml": ["second.yaml"],
    "run good.yaml -o x.png": ["--output x.png", "must not end in .png", "--plot"],
    "run good.yaml -o other.yaml": ["must not end in .yaml"],
    "plot data.h5 -o picture.jpg": ["picture.jpg", ".png, .svg, .pdf"],
    "view data.h5": ["did you mean `vibro-sweep plot`?"],
    "validate good.yaml": ["did you mean `vibro-sweep check`?"],
    "rum good.yaml": ["did you mean `vibro-sweep run`?"],
    "version": ["`vibro-sweep --version`"],
    "help": ["`vibro-sweep --help`"],
    "--verson": ["did you mean --version?"],
    "schema good.yaml": ["good.yaml"],
}


@pytest.mark.parametrize("line", COMMANDS)
def test_slip_on_the_command_line(tmp_path, monkeypatch, capsys, line):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "good.yaml").write_text(scene("sweep: {b: {values: [6.5, 6.6]}}"))
    (tmp_path / "data.h5").write_bytes(b"\x89HDF\r\n\x1a\n")
    assert main(line.split()) == 2
    printed = capsys.readouterr()
    assert printed.out == "" and printed.err.startswith("vibro-sweep: error: ") and printed.err.count("\n") == 1
    for word in COMMANDS[line]:
        assert word in printed.err
    assert {path.name for path in tmp_path.iterdir()} == {"good.yaml", "data.h5"}


@pytest.mark.parametrize(
    "word, options, found",
    [("Omega", ["omega", "b"], "omega"), ("omega", ["Omega", "B"], "Omega"), ("colour", ["omega", "b"], None)],
)
def test_meant(word, options, found):
    assert meant(word, options) == found


@pytest.mark.parametrize(
    "text, said", [("1/0", None), ("1.2.3%", None), ("many", None), ("-1,5e3", "-1.5e3"), (".5", ".5")]
)
def test_number_in_text(text, said):
    found = number_in_text(text)
    assert (found is None) if said is None else said in found
