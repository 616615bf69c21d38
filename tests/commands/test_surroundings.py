"""What surrounds a program: streams, pipes, settings of other programs; a script that starts workers."""

import subprocess
import sys

import pytest
from support.programs import main
from support.scenes import PAPER

SCENE = f"system: {{{PAPER}}}\nsweep: {{b: {{values: [6.4, 6.5]}}}}\norbit: {{transient: 5, record: 5}}\n"
PROGRAM = [sys.executable, "-m", "vibro_sweep"]
DATA = """
import sys
import vibro_sweep as vs
system = vs.System(mu_m=10, mu_k=5, zeta=0.05, f2=0, omega=0.63, R=0.8, b=4)
data = vs.sweep(system, {"b": [3.0, 4.0]}, transient=500, record=50)
"""


@pytest.fixture
def folder(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "scene.yaml").write_text(SCENE)
    return tmp_path


def run(words, **options):
    return subprocess.run(words, capture_output=True, text=True, check=False, **options)


def test_a_scene_from_the_standard_input(folder):
    for words in ([*PROGRAM, "run", "-", "-o", "piped.h5"], [*PROGRAM, "check", "-"]):
        done = run(words, input=SCENE)
        assert done.returncode == 0 and "2 " in done.stdout, done.stderr
    done = run([*PROGRAM, "run", "-"], input=SCENE)
    assert done.returncode == 2 and "add -o" in done.stderr


def test_a_scene_out_of_a_pipe_that_waits(folder):
    words = f"{sys.executable} -m vibro_sweep run <(sleep 0.5; cat scene.yaml) -o piped.h5"
    assert run(["bash", "-c", words]).returncode == 0 and (folder / "piped.h5").exists()


def test_an_output_in_the_home_folder(folder, monkeypatch):
    (folder / "home").mkdir()
    monkeypatch.setenv("HOME", str(folder / "home"))
    assert main(["run", "scene.yaml", "--output=~/there.h5"]) == 0 and (folder / "home" / "there.h5").exists()


def test_a_backend_of_another_program_is_not_loaded(folder, monkeypatch):
    assert main(["run", "scene.yaml"]) == 0
    monkeypatch.setenv("MPLBACKEND", "no_such_backend")
    assert run([*PROGRAM, "plot", "scene.h5"]).returncode == 0 and (folder / "scene.png").exists()


def test_latex_that_is_wanted_and_missing(folder, monkeypatch):
    """The file is computed; one line says what fails."""
    monkeypatch.setenv("PATH", "")
    monkeypatch.setenv("MPLCONFIGDIR", str(folder))
    (folder / "matplotlibrc").write_text("text.usetex: True\n")
    done = run([*PROGRAM, "run", "scene.yaml", "--plot"])
    assert done.returncode == 2 and done.stderr.count("\n") == 1 and "text.usetex" in done.stderr
    assert (folder / "scene.h5").exists() and not (folder / "scene.png").exists()


def test_numba_without_its_compiler(folder, monkeypatch):
    monkeypatch.setenv("NUMBA_DISABLE_JIT", "1")
    done = run([*PROGRAM, "run", "scene.yaml"])
    assert done.returncode == 2 and done.stderr.count("\n") == 1 and "NUMBA_DISABLE_JIT" in done.stderr


@pytest.mark.parametrize("stream", ["None", "type('Quiet', (), {'write': print, 'flush': print})()"])
def test_a_program_without_a_terminal(folder, stream):
    done = run([sys.executable, "-c", DATA + f"sys.stderr = {stream}\nassert len(vs.windows(data)) == 2"])
    assert done.returncode == 0 and done.stderr == ""


def test_a_script_that_workers_would_run_again(folder):
    (folder / "script.py").write_text(DATA + "vs.windows(data, workers=2)\n")
    done = run([sys.executable, "script.py"])
    assert done.returncode == 1 and done.stderr.count("Error") == 1
    assert 'if __name__ == "__main__":' in done.stderr.splitlines()[-1]
    (folder / "script.py").write_text(
        DATA + 'if __name__ == "__main__":\n    print(len(vs.windows(data, workers=2)))\n'
    )
    assert run([sys.executable, "script.py"]).stdout.split() == ["2"]
