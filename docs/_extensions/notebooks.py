"""Pages that are executed: commands of a terminal look as one types them, and each page is a notebook to download."""

import posixpath
import re
from pathlib import Path

import nbformat
from docutils import nodes
from sphinx.application import Sphinx

MAGIC = "%%bash\n"
LINK = re.compile(r"\]\((?!\w+:|#)([^)\s#]*)")


def _terminal(app: Sphinx, document: nodes.document) -> None:
    """Cells of commands without the line that tells Jupyter so."""
    for block in document.findall(nodes.literal_block):
        if block.astext().startswith(MAGIC):
            block.rawsource = block.astext().removeprefix(MAGIC)
            block.children, block["language"] = [nodes.Text(block.rawsource)], "bash"


def _source(app: Sphinx, page: str) -> Path:
    """The notebook that MyST-NB has made of a page, if it is one."""
    return Path(app.env.mystnb_config.output_folder, f"{page}.ipynb")


def _offer(app: Sphinx, page: str, template: str, context: dict, doctree: object) -> None:
    if _source(app, page).is_file():
        context["notebook"] = f"{page.rpartition('/')[2]}.ipynb"


def _with_addresses(text: str, folder: str, docs: str) -> str:
    return LINK.sub(lambda link: f"]({docs}{posixpath.normpath(posixpath.join(folder, link[1]))}", text)


def _write(app: Sphinx, failed: Exception | None) -> None:
    """The notebooks beside their pages, without outputs, each link with the address of the page that it leads to."""
    docs = app.config.html_theme_options["github_url"] + "/blob/main/docs/"
    for page in app.env.found_docs if app.builder.format == "html" and not failed else ():
        if (source := _source(app, page)).is_file():
            notebook = nbformat.read(source, as_version=4)
            for cell in notebook.cells:
                if cell.cell_type == "code":
                    cell.outputs, cell.execution_count = [], None
                else:
                    cell.source = _with_addresses(cell.source, posixpath.dirname(page), docs)
            nbformat.write(notebook, Path(app.outdir, f"{page}.ipynb"))


def setup(app: Sphinx) -> dict[str, bool]:
    app.connect("doctree-read", _terminal)
    app.connect("html-page-context", _offer)
    app.connect("build-finished", _write)
    return {"parallel_read_safe": True}
