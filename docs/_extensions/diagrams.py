"""Diagrams that move: the page of a scene, as `vibro-sweep page` makes it, below the text, loaded when it is opened."""

from pathlib import Path
from tempfile import TemporaryDirectory

from docutils import nodes
from sphinx.application import Sphinx
from sphinx.util.docutils import SphinxDirective

import vibro_sweep as vs

FOLDER = "_diagrams"  # of the site
LOAD = "const frame = this.querySelector('iframe'); frame.src ||= frame.dataset.address"
FRAME = """
<details class="diagram" ontoggle="{load}">
<summary>Move it: this diagram, computed in your browser as you turn its numbers</summary>
<iframe data-address="{address}" title="The diagram {name}, with sliders"></iframe>
<a href="{address}">In a window of its own</a></details>
"""


class Diagram(SphinxDirective):
    """```{diagram} NAME, and below it a scene, or the path of one from this page."""

    required_arguments = 1
    has_content = True

    def run(self) -> list[nodes.Node]:
        [name], text = self.arguments, "\n".join(self.content)
        output = Path(self.env.app.outdir, FOLDER, f"{name}.html")
        output.parent.mkdir(parents=True, exist_ok=True)
        if text.endswith(".yaml"):
            source, file = self.env.relfn2path(text)
            self.env.note_dependency(source)
            vs.page(file, output, overwrite=True)
        else:
            with TemporaryDirectory() as folder:
                scene = Path(folder, f"{name}.yaml")
                scene.write_text(text)
                vs.page(scene, output, overwrite=True)
        address = "../" * self.env.docname.count("/") + f"{FOLDER}/{name}.html"
        return [nodes.raw("", FRAME.format(load=LOAD, name=name.replace("_", " "), address=address), format="html")]


def setup(app: Sphinx) -> dict[str, bool]:
    app.add_directive("diagram", Diagram)
    return {"parallel_read_safe": True}
