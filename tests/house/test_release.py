"""What a release says of itself, in one way everywhere."""

import re
import tomllib

import yaml
from support import ROOT

import vibro_sweep

PROJECT = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]


def test_the_version_is_declared_in_one_place():
    assert PROJECT["dynamic"] == ["version"] and "version" not in PROJECT
    newest = re.search(r"^## (\S+)", (ROOT / "CHANGELOG.md").read_text(), re.MULTILINE)[1]
    assert vibro_sweep.__version__ in (newest, f"{newest}.dev0")
    assert "version" not in yaml.safe_load((ROOT / "CITATION.cff").read_text())
    declared = re.compile(r"^\s*(__version__|version)\s*=\s*[\"']\d", re.MULTILINE)
    found = [path for path in (ROOT / "vibro_sweep").rglob("*.py") if declared.search(path.read_text())]
    assert found == [ROOT / "vibro_sweep" / "__init__.py"]


def test_classifiers_and_readme_name_the_same_platforms():
    readme = (ROOT / "README.md").read_text()
    tested = re.search(r"\*\*Tested\*\* on (.+?) with Python ([\d., and]+) \(", readme)
    assert tested is not None
    named = [line.rpartition(" ")[2] for line in PROJECT["classifiers"] if re.search(r"Python :: 3\.\d+$", line)]
    assert re.findall(r"3\.\d+", tested[2]) == named
    systems = [line.rpartition(" ")[2] for line in PROJECT["classifiers"] if line.startswith("Operating System")]
    assert systems == ["Linux"] and "Linux" in tested[1]
    assert PROJECT["requires-python"] == f">={named[0]}"


def test_the_description_is_one():
    cited = yaml.safe_load((ROOT / "CITATION.cff").read_text())["abstract"]
    first = vibro_sweep.__doc__.splitlines()[0]
    assert PROJECT["description"] == cited.rstrip(".") == first.rstrip(".")
    assert "any linear oscillator" in (ROOT / "README.md").read_text().lower()


def test_links_of_contributing_lead_somewhere():
    text = (ROOT / "CONTRIBUTING.md").read_text()
    for target in re.findall(r"\]\(([^)#]+)", text):
        assert (ROOT / target).exists(), target
    headings = [
        line.lstrip("# ").lower().replace(" ", "-") for line in (ROOT / "docs/development/architecture.md").open()
    ]
    for anchor in re.findall(r"architecture\.md#([\w-]+)", text):
        assert f"{anchor}\n" in headings, anchor
    for path in re.findall(r"`((?:vibro_sweep|tables|model|engine|analysis|plotting|tests|benchmarks)/[\w/.]*)`", text):
        assert (ROOT / path).exists() or (ROOT / "vibro_sweep" / path).exists(), path
