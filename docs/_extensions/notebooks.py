"""Every page that is executed can be downloaded as a notebook, without its outputs: it lies beside the page."""

from pathlib import Path

import nbformat
from sphinx.application import Sphinx


def _source(app: Sphinx, page: str) -> Path:
    """The notebook that MyST-NB has made of a page, if it is one."""
    return Path(app.env.mystnb_config.output_folder, f"{page}.ipynb")


def _offer(app: Sphinx, page: str, template: str, context: dict, doctree: object) -> None:
    if _source(app, page).is_file():
        context["notebook"] = f"{page.rpartition('/')[2]}.ipynb"


def _write(app: Sphinx, failed: Exception | None) -> None:
    for page in app.env.found_docs if app.builder.format == "html" and not failed else ():
        if (source := _source(app, page)).is_file():
            notebook = nbformat.read(source, as_version=4)
            for cell in notebook.cells:
                if cell.cell_type == "code":
                    cell.outputs, cell.execution_count = [], None
            nbformat.write(notebook, Path(app.outdir, f"{page}.ipynb"))


def setup(app: Sphinx) -> dict[str, bool]:
    app.connect("html-page-context", _offer)
    app.connect("build-finished", _write)
    return {"parallel_read_safe": True}
