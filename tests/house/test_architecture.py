"""Who may import whom (docs/development/architecture.md)."""

import ast
import graphlib

import pytest
from support import ROOT

HOME = ROOT / "vibro_sweep"
ALLOWED = {
    "checks": set(),
    "tables": {"checks"},
    "oscillator": {"checks", "tables"},
    "engine": {"checks", "tables", "oscillator"},
    "analysis": {"checks", "tables", "oscillator", "engine", "results", "plotting", "driver"},
    "scene": {"checks", "tables", "oscillator"},
    "results": {"checks", "tables", "oscillator", "scene"},
    "files": {"checks", "tables", "oscillator", "scene", "results"},
    "driver": {"checks", "tables", "oscillator", "engine", "analysis", "scene", "files", "results"},
    "plotting": {"checks", "tables", "oscillator", "files", "results"},
    "live": {"checks", "tables", "oscillator", "engine", "analysis", "scene", "files", "results", "driver", "plotting"},
    "standalone": {"checks", "tables", "oscillator", "engine", "scene", "files", "live"},
    "cli": {
        "checks",
        "tables",
        "oscillator",
        "engine",
        "scene",
        "files",
        "results",
        "driver",
        "plotting",
        "live",
        "standalone",
    },
    "types": {"checks", "tables", "oscillator", "analysis", "scene", "driver", "live"},
}
# of analysis/: in this order
FLOORS = ["single", "attractors", "periodic", "continuation", "branches", "curves", "windows"]
EVERYWHERE = {"__version__"}
# of oscillator/: names, and the force of a stop, which follows from stored samples
WITHOUT_PHYSICS = {"catalogue", "contact_laws", "stop_force", "stops"}


def imported(path):
    """Rooms of the package that a module imports, with the lines; those inside of functions too."""
    for node in ast.walk(ast.parse(path.read_text())):
        if isinstance(node, ast.ImportFrom):
            here = ["vibro_sweep", *path.relative_to(HOME).parts[:-1]]
            base = here[: len(here) + 1 - node.level] if node.level else []
            whole = [*base, *(node.module or "").split(".")]
            if whole[0] == "vibro_sweep":
                for name in [whole[1]] if len(whole) > 1 and whole[1] else [alias.name for alias in node.names]:
                    yield name, node
        elif isinstance(node, ast.Import):
            assert not any(alias.name.startswith("vibro_sweep") for alias in node.names), path


@pytest.mark.parametrize("room", ALLOWED)
def test_imports_lead_only_where_the_table_says(room):
    modules = sorted((HOME / room).rglob("*.py"))
    assert modules
    for path in modules:
        for other, node in imported(path):
            assert other in {room, *EVERYWHERE} | ALLOWED[room], f"{path}:{node.lineno} imports {other}"


def test_analysis_stands_on_floors():
    home = HOME / "analysis"
    assert {path.name for path in home.iterdir() if path.is_dir() and path.name != "__pycache__"} == set(FLOORS)
    for floor, name in enumerate(FLOORS):
        for path in (home / name).rglob("*.py"):
            for other, node in imported(path):
                if other == "analysis":
                    assert node.module.split(".")[2] in FLOORS[: floor + 1], f"{path}:{node.lineno}: {node.module}"


@pytest.mark.parametrize("room, other", [("analysis", "plotting"), ("analysis", "driver")])
def test_what_a_method_asks_of_another_room_is_imported_when_it_is_called(room, other):
    for path in (HOME / room).rglob("*.py"):
        for node in ast.parse(path.read_text()).body:
            assert not (isinstance(node, ast.ImportFrom) and other in (node.module or "")), path


def modules_of(room):
    """module -> the modules of these rooms that it imports, and the imports that are not at its beginning."""
    for path in sorted((HOME / room).rglob("*.py")):
        here, body = path.relative_to(HOME.parent).with_suffix("").parts, ast.parse(path.read_text()).body
        found, inside = set(), []
        for top in body:
            for node in ast.walk(top):
                if isinstance(node, ast.ImportFrom):
                    base = [*here[: len(here) - node.level]] if node.level else []
                    whole = [*base, *(node.module.split(".") if node.module else [])]
                    found |= {(*whole, alias.name) for alias in node.names} | {tuple(whole)}
                    inside += [f"{path}:{node.lineno}"] if node is not top and whole[0] == "vibro_sweep" else []
        yield here, found, inside


def between(graph):
    """The imports that lead to modules of the graph."""
    return {module: {one for one in found if one in graph} for module, found in graph.items()}


@pytest.mark.parametrize("room", ["files", "results", "driver", "plotting", "live", "standalone", "cli"])
def test_no_circles_of_imports(room):
    """Nor by imports inside functions, which wait until they are needed."""
    graph = between({module: found for module, found, _ in modules_of(room)})
    assert len([*graphlib.TopologicalSorter(graph).static_order()]) == len(graph) > 5  # CycleError names a circle


def test_no_circles_of_imports_up_to_the_scene():
    """None of these rooms imports one of its own modules, or another room, inside a function or for type checkers."""
    graph = {}
    for room in ("checks", "tables", "oscillator", "scene"):
        for module, found, inside in modules_of(room):
            assert not inside
            graph[module] = found
    assert len(graph) > 60
    graph = between(graph)
    assert [*graphlib.TopologicalSorter(graph).static_order()]  # CycleError names a circle
    with pytest.raises(graphlib.CycleError):
        graph["vibro_sweep", "checks", "errors"].add(("vibro_sweep", "scene", "scene"))
        graphlib.TopologicalSorter(graph).prepare()


def test_pictures_recompute_no_physics():
    """plotting/ has names and checks of the model alone, and of files what reads: no scene is parsed there."""
    for path in (HOME / "plotting").rglob("*.py"):
        for other, node in imported(path):
            if other == "oscillator":
                assert node.module.split(".")[2] in WITHOUT_PHYSICS, f"{path}:{node.lineno} imports {node.module}"


def test_every_room_is_in_the_table():
    rooms = {path.name for path in HOME.iterdir() if path.is_dir() and path.name != "__pycache__"}
    assert rooms == ALLOWED.keys()
    text = (ROOT / "docs" / "development" / "architecture.md").read_text()
    assert all(f"`{room}/`" in text for room in rooms)


def test_the_root_has_packages_only():
    assert {path.name for path in HOME.glob("*.py")} == {"__init__.py", "__main__.py"}


def test_a_files_name_tells_it_apart_from_all_others():
    names = [path.name for path in HOME.rglob("*.py") if path.name != "__init__.py"]
    assert len(names) == len({*names}) > 300


def test_one_room_of_the_core_asks_for_the_law_of_a_contact():
    """Others hand `Problem.compliant` on to it; none imports its question, or compares."""
    asked = set()
    for path in (HOME / "engine" / "continuation").glob("*.py"):
        tree = ast.parse(path.read_text())
        handed = {id(one) for call in ast.walk(tree) if isinstance(call, ast.Call) for one in call.args}
        asked |= {
            path.stem
            for node in ast.walk(tree)
            if (isinstance(node, ast.Attribute) and node.attr == "compliant" and id(node) not in handed)
            or (isinstance(node, ast.Name) and node.id == "is_contact")
        }
    assert asked == {"lasting"}
