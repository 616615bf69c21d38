"""Figures of `vs.plot` in the gallery: pyplot does not know them, so they are taken as the value of the last line."""

from matplotlib.figure import Figure
from sphinx_gallery.scrapers import figure_rst


def _get_sg_image_scraper():
    """What sphinx-gallery calls for each block of code."""
    return scraper


def scraper(block, block_vars, gallery_conf) -> str:
    """The reStructuredText that shows the figure, which is saved beside the page."""
    figure = block_vars["example_globals"].get("___")
    if not isinstance(figure, Figure):
        return ""
    path = next(block_vars["image_path_iterator"])
    figure.savefig(path)
    return figure_rst([path], gallery_conf["src_dir"])
