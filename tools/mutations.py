"""Lines of ROOMS, drawn by a seed, are changed one at a time: the first test that fails with each.

python tools/mutations.py --work FOLDER [--lines 60] [--seed 28] [--only 3 17] [--log FILE]

FOLDER gets a copy of the checkout, its compiled kernels, and what each fast test calls: these are run once for that.
Then tests run in order of nearness to the changed line, until one fails; one that does not end fails, too
(`chosen_tests.py`). Where no fast test fails come the slow ones of the line's subject. Lines that no kernel contains
come first. A copy of FOLDER with `--only` other lines can be used by a second process.
"""

import argparse
import ast
import contextlib
import io
import json
import os
import random
import re
import shutil
import signal
import subprocess
import sys
import tokenize
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
RUN = str(ROOT / "tools" / "chosen_tests.py")
ROOMS = ("analysis", "driver", "engine", "oscillator", "tables")  # of the package
FIRST = 40  # tests that are collected first
FAST, SLOW = "not slow", "slow"
SUBJECTS = {  # folders of the slow tests of a room
    "analysis": ("orbits",), "driver": ("sweeps", "files", "commands"),
    "engine": ("accuracy", "engine", "orbits", "sweeps"),
    "oscillator": ("scenes", "accuracy"), "tables": ("scenes", "files"),
}  # fmt: skip
OF_PYTHON = {
    "functools.cache",
    "cache",
    "memoised",
    "dataclass",
    "property",
    "np.errstate",
    "contextlib.contextmanager",
}
CHANGES = {
    "+": ["-"], "-": ["+"], "*": ["/"], "/": ["*"], "//": ["/"], "+=": ["-="], "-=": ["+="], "*=": ["/="], "/=": ["*="],
    "<": ["<=", ">"], "<=": ["<", ">="], ">": [">=", "<"], ">=": [">", "<="], "==": ["!="], "!=": ["=="],
    "and": ["or"], "or": ["and"], "not": [""], "is": ["is not"], "in": [],
}  # fmt: skip
HASH = (
    "from vibro_sweep.engine.simd.kernel_cache import source_hash as s; print(s())"  # and makes the folder of kernels
)


def changes(text: str) -> dict[int, list[tuple[int, str, str]]]:
    """Line -> [(column, what stands there, what to put in its place)], of lines with an operator or a comparison."""
    found, numbers, before = {}, {}, None
    for token in tokenize.generate_tokens(io.StringIO(text).readline):
        word, (row, column) = token.string, token.start
        if word == "not" and before.string == "is":
            found[row][-1:] = [(before.start[1], "is not", "is")]
        unpacks = word == "*" and not (before.type == tokenize.NUMBER or re.search(r"[\w)\]]$", before.string))
        if token.type == tokenize.NUMBER:
            value = ast.literal_eval(word)
            new = [value + 1, value - 1] if isinstance(value, int) else [1.001 * value if value else 1e-3]
            numbers.setdefault(row, []).extend((column, word, repr(n)) for n in new)
        elif token.type in (tokenize.OP, tokenize.NAME) and word in CHANGES and not unpacks:
            found.setdefault(row, []).extend((column, word, new) for new in CHANGES[word])
        before = token
    return {row: sorted(places + numbers.get(row, [])) for row, places in found.items() if places}


def drawn(home: Path, count: int, seed: int) -> list[tuple[str, int, int, str, str]]:
    """File, line, column, what stands there and what to put in its place."""
    files = sorted(p for room in ROOMS for p in (home / "vibro_sweep" / room).rglob("*.py"))
    lines = {(f.relative_to(home).as_posix(), row): c for f in files for row, c in changes(f.read_text()).items()}
    rng = random.Random(seed)
    return [(*line, *rng.choice(lines[line])) for line in rng.sample(list(lines), count)]


class Line:
    """What has to be known of a line to choose tests."""

    def __init__(self, home: Path, name: str, row: int):
        body = ast.parse((home / name).read_text()).body
        blocks = [n for n in body if isinstance(n, ast.FunctionDef | ast.ClassDef)]
        block = next((n for n in blocks if n.lineno <= row <= n.end_lineno), None)
        jitted = {ast.unparse(d).partition("(")[0] for d in getattr(block, "decorator_list", [])} - OF_PYTHON
        constant = block is None or any(
            re.search(rf"\b{block.name}\(", ast.unparse(n)) for n in body if n not in blocks
        )
        self.compiled = "engine/" in name and bool(jitted or constant or "/simd/" in name)
        functions = [n for n in ast.walk(block or ast.Module([])) if isinstance(n, ast.FunctionDef)]
        function = [n for n in functions if n.lineno <= row <= n.end_lineno and not self.compiled][:1]
        self.function = [f"{name}:{min(n.lineno for n in [f, *f.decorator_list])}" for f in function]
        texts = {p.relative_to(home).as_posix(): p.read_text() for p in home.glob("vibro_sweep/**/*.py")}
        self.users, new = {name: 0}, [name]  # modules that reach this one by imports, and in how many steps
        for module in new:
            package, _, last = module.removesuffix(".py").replace("/", ".").rpartition(".")
            said = re.compile(rf"from {package}( import (\([^)]*|[^(\n]*)\b{last}\b|\.{last} import)")
            direct = [other for other, text in texts.items() if other not in self.users and said.search(text)]
            self.users |= dict.fromkeys(direct, self.users[module] + 1)
            new += direct
        stale = {Path(module).stem for module in self.users if self.compiled}
        self.unchanged = {
            Path(module).stem for module in texts
        } - stale  # modules whose kernels do not contain the line

    def order(self, tests: dict) -> list[str]:
        """Tests that call the function; others of their files; then those that call what imports its module."""
        callers = {test for test, one in tests.items() if {*self.function} & {*one["calls"]}}
        files = {test.partition("::")[0] for test in callers}

        def place(test):
            used = {c.partition(":")[0] for c in tests[test]["calls"] if self.compiled == c.endswith("kernel")}
            near = min((steps for module, steps in self.users.items() if module in used), default=99)
            return test not in callers, test.partition("::")[0] not in files, near, tests[test]["seconds"]

        return sorted(tests, key=place)


def started(command: list[str], work: Path, cache: str) -> tuple[int, str]:
    """Exit status of a program that imports the copy (below 0: a signal ended it), and what it prints."""
    env = os.environ | {"PYTHONPATH": str(work / "checkout"), "NUMBA_CACHE_DIR": str(work / cache)}
    with (work / "output.txt").open("w") as out:
        options = {"cwd": work / "checkout", "env": env, "stdout": out, "stderr": out, "start_new_session": True}
        process = subprocess.Popen([sys.executable, *command], **options)
        try:
            process.wait()
        finally:
            with contextlib.suppress(ProcessLookupError):
                os.killpg(process.pid, signal.SIGKILL)  # and programs that a test had started
    return process.returncode, (work / "output.txt").read_text().strip()


def slow_tests(work: Path) -> list[str]:
    """Their names."""
    command = ["-m", "pytest", "--collect-only", "-q", "-n", "0", "-m", SLOW, "-p", "no:cacheprovider", "tests"]
    return [line for line in started(command, work, "cache")[1].splitlines() if line.startswith("tests/")]


def of_subject(tests: list[str], name: str) -> list[str]:
    """The tests of the subject of a file of the package, those with words of its name first."""
    folders, words = SUBJECTS[name.split("/")[1]], [word for word in Path(name).stem.split("_") if len(word) > 3]
    near = [test for test in tests if any(word in test.removeprefix("tests/") for word in words)]
    return near + [test for test in tests if test.split("/")[1] in folders and test not in near]


def first_to_fail(work: Path, change: tuple, tests: dict, slow: list[str], minutes: float) -> str:
    """With the change: a test, and how it ended."""
    name, row, column, before, after = change
    path, line, cache = work / "checkout" / name, Line(work / "checkout", name, row), "cache"
    _, kernels = started(["-c", HASH], work, cache) if "engine/" in name else (0, "")
    text, stat = path.read_text(), path.stat()
    lines = text.splitlines(keepends=True)
    lines[row - 1] = lines[row - 1][:column] + after + lines[row - 1][column + len(before) :]
    path.write_text("".join(lines))
    try:
        if "engine/" in name:  # kernels get a new folder, with those that do not contain what is changed
            cache, (status, new) = "mutant", started(["-c", HASH], work, "mutant")
            for kernel in (work / "cache" / kernels).glob("*/*"):
                if status == 0 and kernel.name.partition(".")[0] in line.unchanged:
                    (work / cache / new / kernel.parent.name).mkdir(exist_ok=True)
                    os.link(kernel, work / cache / new / kernel.parent.name / kernel.name)
        order = line.order(tests)
        for chosen, mark in ((order[:FIRST], FAST), (order[FIRST:], FAST), (of_subject(slow, name), SLOW)):
            if not chosen:
                continue
            (work / "outcome.txt").unlink(missing_ok=True)
            (work / "order.json").write_text(json.dumps([chosen, minutes, mark]))
            status, printed = started([RUN, str(work / "order.json"), str(work / "outcome.txt")], work, cache)
            said = (work / "outcome.txt").read_text() if (work / "outcome.txt").exists() else ""
            if said.startswith("fails"):
                return said[6:]
            if status < 0:
                return f"{said[5:]} ({signal.Signals(-status).name})"
            if not said:
                return f"no test can be run: {printed.splitlines()[-1]}"
        return "NONE" if status == 0 else f"NONE in {minutes:g} minutes"
    finally:
        path.write_text(text)
        os.utime(path, ns=(stat.st_atime_ns, stat.st_mtime_ns))
        shutil.rmtree(work / "mutant", ignore_errors=True)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--work", type=Path, required=True, metavar="FOLDER")
    parser.add_argument("--lines", type=int, default=60, help="how many are drawn")
    parser.add_argument("--seed", type=int, default=28)
    parser.add_argument("--only", type=int, nargs="*", metavar="N", help="these of them alone")
    parser.add_argument("--minutes", type=float, default=20, help="for the tests of a change")
    parser.add_argument("--log", type=Path, default=os.devnull, help="the table is appended to it")
    options = parser.parse_args()
    signal.signal(signal.SIGTERM, lambda *_: sys.exit(1))  # so that the changed file gets its old text again
    work = options.work.resolve()
    home = work / "checkout"
    if not home.exists():
        shutil.copytree(ROOT, home, ignore=shutil.ignore_patterns(".git", "__pycache__"))
    if not (work / "calls.json").exists():
        (work / "order.json").write_text(json.dumps([None, None, FAST]))
        started([RUN, str(work / "order.json"), str(work / "calls.json")], work, "cache")
    tests = json.loads((work / "calls.json").read_text())
    slow = slow_tests(work)
    numbers = options.only or range(1, options.lines + 1)
    chosen = [(n, c) for n, c in enumerate(drawn(home, options.lines, options.seed), 1) if n in numbers]
    for n, change in sorted(chosen, key=lambda pair: Line(home, *pair[1][:2]).compiled):
        name, row, column, before, after = change
        line = (home / name).read_text().splitlines()[row - 1]
        line = f"{line[:column]}{{{before} -> {after}}}{line[column + len(before) :]}".strip()
        outcome = first_to_fail(work, change, tests, slow, options.minutes)
        said = f"{n:2d}  {name.removeprefix('vibro_sweep/')}:{row}  {line}  | {outcome}\n"
        print(said, end="", flush=True)
        with options.log.open("a") as log:
            log.write(said)


if __name__ == "__main__":
    main()
