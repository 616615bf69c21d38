"""Every command and snippet of README and docs, page by page in order, in a folder of its own.

Cells of notebook pages and scripts of the gallery run in the build of the site alone (test_site.py). What a command
does when it is repeated, commands/test_cli.py says.
"""

import os
import re
import shutil
import subprocess
import sys
import textwrap
from pathlib import Path

import pytest
from support import ROOT

PAGES = {
    str(path.relative_to(ROOT)): [
        (language, textwrap.dedent(text))
        for language, text in re.findall(
            r"(?<!-->\n)^ *```(sh|python)\n(.*?)^ *```$", path.read_text(), re.MULTILINE | re.DOTALL
        )
    ]
    for path in [ROOT / "README.md", *sorted((ROOT / "docs").rglob("*.md"))]
}
SLOW = (
    "README.md",
    "docs/how/many_machines.md",
    "docs/development/architecture.md",
)
ENDING = "for job in $(jobs -p | tac); do kill $job; wait $job || true; done"  # a worker waits 8 s for its scheduler
NETWORK = "ip link set lo up\nip addr add dev lo 10.0.0.1\n"  # the address of docs/how/many_machines.md

# What these pages take from other packages, where these are not installed; workers of this machine in their place.
STAND_INS = {
    "dask_jobqueue.py": """
from distributed import LocalCluster

class SLURMCluster(LocalCluster):
    def __init__(self, **_):
        super().__init__(
            n_workers=0, threads_per_worker=1, processes=False, protocol="tcp://", dashboard_address="127.0.0.1:0"
        )

    def scale(self, jobs):
        super().scale(2)

    def wait_for_workers(self, n_workers):
        super().wait_for_workers(2)
""",
    "mpi4py/__init__.py": "",
    "mpi4py/futures.py": """
from concurrent.futures import ProcessPoolExecutor
from multiprocessing import get_context

def MPIPoolExecutor():
    return ProcessPoolExecutor(2, get_context("spawn"))
""",
}


def command_of(language, text):
    """A bash script; installing and testing are what whoever runs this test has done and is doing."""
    if language == "python":
        return f"cat > script.py <<'END'\n{text}END\npython script.py\n"
    lines = [re.sub(r"^pip install \S+( && )?", "", line) for line in text.splitlines()]
    lines = [line for line in lines if not line.startswith("pytest")]
    background = [place for place, line in enumerate(lines) if line.endswith("&")]
    if background:
        lines.insert(background[-1] + 1, "sleep 5")  # for what is in the background to listen
    return "\n".join(lines)


def marked(name):
    return pytest.param(name, marks=pytest.mark.slow if name in SLOW else (), id=name)


@pytest.mark.parametrize("name", [marked(name) for name, snippets in PAGES.items() if snippets])
def test_page(tmp_path, name):
    for folder in ("configs", "docs"):
        shutil.copytree(ROOT / folder, tmp_path / folder)
    shutil.copy(ROOT / "CITATION.cff", tmp_path)
    for file, text in STAND_INS.items():
        place = tmp_path / "stand_ins" / file
        place.parent.mkdir(parents=True, exist_ok=True)
        place.write_text(text)
    namespace = ["unshare", "--net", *([] if os.geteuid() == 0 else ["--map-root-user"])]
    if not shutil.which("unshare") or subprocess.run([*namespace, "true"], check=False).returncode:
        namespace = []  # then the ports of the page must be free here
        if NETWORK.split()[-1] in str(PAGES[name]):
            pytest.skip("no network namespace here, in which this machine has the address of the page")
    environment = os.environ | {
        "PATH": os.pathsep.join([str(Path(sys.executable).parent), os.environ["PATH"]]),
        "PYTHONPATH": str(tmp_path / "stand_ins"),
    }
    for language, text in PAGES[name]:
        network = NETWORK if namespace else ""
        ending = f"trap '{ENDING}' EXIT"
        script = f"set -e\n{network}{ending}\n{command_of(language, text)}\n"
        done = subprocess.run(
            [*namespace, "bash", "-c", script],
            cwd=tmp_path,
            env=environment,
            capture_output=True,
            text=True,
            check=False,
        )
        assert done.returncode == 0, f"{text}\n{done.stdout}\n{done.stderr}"
        assert_as_said(text, done.stdout)


def assert_as_said(text, printed):
    """`6.7...` in a comment is the beginning of a number that is printed."""
    for number in re.findall(r"(-?\d+\.\d+)\.\.\.", "".join(re.findall(r"#.*", text))):
        assert re.search(rf"(?<![\d.]){re.escape(number)}", printed), (number, printed)


def test_setting_up_is_two_commands():
    install, test = PAGES["README.md"][0][1].splitlines()
    assert install.startswith("pip install . && vibro-sweep run configs/quickstart.yaml --plot")
    assert test.startswith("pip install '.[test]' && pytest")


SHOWN = ("diff", "text", "yaml", "toml", "bibtex")  # nothing of these could be executed
NOT_RUN = "<!-- not run: "  # above a block, with the reason


@pytest.mark.parametrize("path", [ROOT / "README.md", *(ROOT / "docs").rglob("*.md")], ids=lambda path: path.name)
def test_every_block_is_executed(path):
    """Here (sh, python), by the build of the site (code-cell), or it says why not."""
    lines = path.read_text().splitlines()
    fences = [(place, line.strip()) for place, line in enumerate(lines) if re.match(r" *(```+|~~~+|:::+)", line)]
    opened = [(place, re.match(r"[`~:]+ *(.+)", line).group(1)) for place, line in fences if line.strip("`~: ")]
    plain = [place for place, language in opened if language in ("sh", "python")]
    for place, language in opened:
        directive = re.match(r"\{([\w:-]+)\}", language)
        shows_code = directive and directive.group(1) in ("code", "code-block", "sourcecode")
        executed = place in plain or (directive and not shows_code) or language in SHOWN
        marked = place and lines[place - 1].strip().startswith(NOT_RUN)
        assert executed or marked, f"{path}:{place + 1}: {language}"
    name = str(path.relative_to(ROOT))
    assert len(plain) - sum(lines[place - 1].strip().startswith(NOT_RUN) for place in plain) == len(PAGES[name])


def test_the_pictures_are_those_that_pages_show():
    """One by the README; others by pages of the site."""
    assert re.findall(r'src="docs/([^"]+)"', (ROOT / "README.md").read_text()) == ["quickstart.png"]
    shown = {
        (page.parent / target).resolve()
        for page in (ROOT / "docs").rglob("*.md")
        for target in re.findall(r"(?:\]\(|\{image\} )([\w./-]+\.(?:png|svg|gif))", page.read_text())
    }
    drawn = {path for path in (ROOT / "docs").iterdir() if path.suffix in (".png", ".svg", ".gif")}
    assert drawn <= shown and len(drawn) > 2
    assert (ROOT / "docs" / "oscillator.svg").read_text().startswith("<?xml")
