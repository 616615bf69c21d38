"""The site of vibro_sweep: pip install '.[docs]' && python -m sphinx -W -b html docs site

Every notebook page and every picture of the gallery is computed at each build; an error in one ends it.
"""

import sys
from functools import partialmethod
from pathlib import Path

from nbclient import NotebookClient

sys.path.append(str(Path(__file__).parent / "_extensions"))

from vibro_sweep import __version__

project = "vibro_sweep"
author = "vibro_sweep developers"
project_copyright = author
version = release = __version__

extensions = [
    "myst_nb",
    "sphinx.ext.autodoc",
    "sphinx.ext.autosummary",
    "sphinx.ext.duration",
    "sphinx_copybutton",
    "sphinx_design",
    "sphinx_gallery.gen_gallery",
    "sphinx-mathjax-offline",  # no page needs a network
    "docstrings",  # this one and the next two are in _extensions/, and so is gallery_figures
    "notebooks",
    "diagrams",
]
exclude_patterns = ["gallery", "auto_gallery/**.ipynb", "auto_gallery/**.zip", "auto_gallery/**.json"]
nitpicky = False

templates_path = ["_templates"]
default_role = "py:obj"
autodoc_typehints_format = "short"
python_use_unqualified_type_names = True
maximum_signature_line_length = 100

myst_enable_extensions = ["amsmath", "attrs_inline", "colon_fence", "deflist", "dollarmath", "html_image"]
myst_heading_anchors = 4

nb_execution_mode = "force"
nb_execution_raise_on_error = True
nb_execution_in_temp = True
nb_execution_timeout = 900
nb_execution_show_tb = True
# Output that comes in several pieces is joined; `nb_merge_streams` would break lines where they meet.
NotebookClient.__init__ = partialmethod(NotebookClient.__init__, coalesce_streams=True)
nb_output_stderr = "remove"  # of a first run: that kernels are being compiled

sphinx_gallery_conf = {
    "examples_dirs": "gallery",
    "gallery_dirs": "auto_gallery",
    "within_subsection_order": "FileNameSortKey",
    "image_scrapers": ("matplotlib", "gallery_figures"),
    "capture_repr": ("_repr_html_",),
    "doc_module": ("vibro_sweep",),
    "backreferences_dir": "auto_gallery/backreferences",
    "write_computation_times": False,  # its table loads scripts from another host
    "show_memory": False,
    "show_signature": False,
    "default_thumb_file": None,
}

html_theme = "pydata_sphinx_theme"
html_title = "vibro_sweep"
html_static_path = ["_static"]
html_css_files = ["site.css"]
html_show_sourcelink = False
html_sidebars = {"**": ["map"]}
html_theme_options = {
    "github_url": "https://github.com/vibro-sweep/vibro_sweep",
    "show_toc_level": 2,
    "navbar_center": [],  # the map is beside each page
    "article_header_end": ["download_notebook"],
    "navigation_with_keys": False,
    "footer_start": ["copyright"],
    "footer_end": [],
}
html_context = {"default_mode": "auto"}
copybutton_exclude = ".linenos, .gp, .go"


def setup(app):
    """Pages are read in two processes; the extension that brings MathJax copies files at the end, and nothing else."""
    app.extensions["sphinx-mathjax-offline"].parallel_read_safe = True
    app.parallel = 2
