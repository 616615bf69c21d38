"""One HTML file: the live page's own drawing and controls, workers in place of its server, and the kernel's module."""

import base64
import gzip
import json
import re
from pathlib import Path
from typing import Any

from vibro_sweep.engine.records import Kind
from vibro_sweep.standalone.formulas import LAWS, STOPS
from vibro_sweep.standalone.kernel_arguments import layout_of

LIVE, OWN = Path(__file__).parents[1] / "live" / "page", Path(__file__).parent / "parts"
IMPORT = re.compile(r'^import \{ ([^}]*) \} from "\./([a-z_]+\.js)";\n', re.M)
EXPORT = re.compile(r"^export (?=(?:async )?(?:function\*?|class|const) (\w+))", re.M)


def html_of(formulas: list[tuple[str, int]], kind: Kind, module: bytes, page: dict[str, Any], title: str) -> str:
    """The text of the file. page: all that the page knows of its oscillator, for JSON."""
    sources = {path.name: path.read_text() for folder in (LIVE, OWN) for path in folder.glob("*.js")}
    sources["oscillator.js"] = oscillator_of(formulas, kind)
    title = _escaped(title)
    text = (LIVE / "index.html").read_text()
    for old, new in (
        ('<link rel="stylesheet" href="style.css">', f"<style>\n{(LIVE / 'style.css').read_text()}</style>"),
        ('  <script type="module" src="main.js"></script>\n', ""),
        ("<title>vibro-sweep explore</title>", f"<title>{title}</title>"),
        ("<h1>vibro-sweep <span>explore</span></h1>", f"<h1>{title}</h1>"),
        (" w asks why its window ends,", ""),
        ("upper half of both.</p>", f"upper half of both. {CERTIFIED}</p>"),
    ):
        assert old in text, old
        text = text.replace(old, new)
    data = json.dumps(page | {"layout": layout_of(kind)}, separators=(",", ":"))
    scripts = {name: bundled(f"{name}.js", sources).encode() for name in ("main", "worker")}
    packed = {"page": data.encode(), **scripts, "module": module}
    parts = [f'<script type="text/plain" id="{name}">{_packed(content)}</script>' for name, content in packed.items()]
    return text.replace("</body>", "\n".join([*parts, f"<script>{LOADER}</script>"]) + "\n</body>")


def _packed(content: bytes) -> str:
    return base64.b64encode(gzip.compress(content, 9, mtime=0)).decode()


CERTIFIED = (
    "Computed here, by the kernels of vibro-sweep as WebAssembly: impacts are certified by the same bounds, and none "
    "is missed. Last digits differ from those of its own runs, and so do chaotic columns, one by one. Where dampers "
    "couple modes there are no exponents here."
)
LOADER = (OWN / "loader.js").read_text()


def oscillator_of(formulas: list[tuple[str, int]], kind: Kind) -> str:
    """The module of the oscillator's numbers: those of `machine_of`, and then its stops and their laws."""
    n = kind.masses
    assert len(formulas) == 3 * n * n + n + 1 + 3 * n + 1 + len(STOPS) + len(LAWS)
    return (
        f"export const MASSES = {n};\n"
        f"export const NORMAL = {3 * n * n}; // place of the normal among the numbers\n"
        f"export const STOPS = {len(formulas) - len(STOPS) - len(LAWS)};\n"
        f"export const powers = {json.dumps([power for _, power in formulas])};\n"
        f"export const numbersOf = (v) => [{', '.join(text for text, _ in formulas)}];\n"
    )


def bundled(name: str, sources: dict[str, str]) -> str:
    """A module and all that it imports as one script: each is a function that returns what it exports."""
    order: list[str] = []

    def visit(one: str) -> None:
        for _, other in IMPORT.findall(sources[one]):
            if other not in order:
                visit(other)
        order.append(one)

    visit(name)
    return "const modules = {};\n" + "".join(_as_function(one, sources[one]) for one in order)


def _as_function(name: str, text: str) -> str:
    exported = EXPORT.findall(text)
    text = IMPORT.sub(lambda found: f'const {{ {found[1].replace(" as ", ": ")} }} = modules["{found[2]}"];\n', text)
    text = EXPORT.sub("", text)
    assert not re.search(r"^(import|export)\b", text, re.M), name
    return f'modules["{name}"] = (() => {{\n{text}return {{ {", ".join(exported)} }};\n}})();\n'


def _escaped(text: str) -> str:
    return text.replace("&", "&amp;").replace("<", "&lt;")
