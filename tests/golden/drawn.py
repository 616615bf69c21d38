"""What a matplotlib figure shows, as values of JSON: words, limits, and summaries of the arrays that are drawn."""

import numpy as np
from matplotlib.colors import to_hex

LISTED = 12  # lines, collections and patches of an axes that are told one by one; of the others their number
VALUES = 5  # of an array, evenly spread


def described(figure) -> dict:
    figure.canvas.draw()  # which makes ticks
    return {
        "size": figure.get_size_inches().tolist(),
        "dpi": float(figure.dpi),
        "title": figure.get_suptitle(),
        "texts": [text.get_text() for text in figure.texts],
        "legends": [_legend(legend) for legend in figure.legends],
        "axes": [_axes(ax) for ax in figure.axes],
    }


def _axes(ax) -> dict:
    result = {
        "visible": ax.get_visible(),
        "titles": [ax.get_title(loc=place) for place in ("left", "center", "right")],
        "labels": [ax.get_xlabel(), ax.get_ylabel()],
        "scales": [ax.get_xscale(), ax.get_yscale()],
        "xlim": [_number(limit) for limit in ax.get_xlim()],
        "ylim": [_number(limit) for limit in ax.get_ylim()],
        "xticks": _ticks(ax.xaxis),
        "yticks": _ticks(ax.yaxis),
        "legend": _legend(ax.get_legend()),
        "texts": [_text(text) for text in ax.texts],
    }
    for name, describe in (("lines", _line), ("collections", _collection), ("patches", _patch), ("images", _image)):
        artists = list(getattr(ax, name))
        result[name] = {"count": len(artists), "first": [describe(artist) for artist in artists[:LISTED]]}
    return result


def _ticks(axis) -> list[str]:
    """The texts that are seen."""
    return [label.get_text() for label in axis.get_ticklabels() if label.get_visible() and label.get_text()]


def _legend(legend) -> dict | None:
    if legend is None:
        return None
    return {"title": legend.get_title().get_text(), "texts": [text.get_text() for text in legend.get_texts()]}


def _text(text) -> dict:
    return {"text": text.get_text(), "at": [_number(value) for value in text.get_position()]}


def _line(line) -> dict:
    return {
        "label": _label(line), "style": line.get_linestyle(), "marker": str(line.get_marker()),
        "colour": to_hex(line.get_color(), keep_alpha=True), "width": float(line.get_linewidth()),
        "x": array(line.get_xdata()), "y": array(line.get_ydata()),
    }  # fmt: skip


def _collection(artist) -> dict:
    paths = [path.vertices for path in artist.get_paths()]
    values = artist.get_array()
    return {
        "class": type(artist).__name__, "label": _label(artist), "paths": len(paths),
        "vertices": array(np.concatenate(paths) if paths else []), "offsets": array(artist.get_offsets()),
        "values": None if values is None else array(values), "colours": _colours(artist.get_facecolor()),
        "edges": _colours(artist.get_edgecolor()),
    }  # fmt: skip


def _patch(patch) -> dict:
    face = to_hex(patch.get_facecolor(), keep_alpha=True)
    return {"class": type(patch).__name__, "label": _label(patch), "colour": face, "path": array(_outline(patch))}


def _outline(patch):
    return patch.get_patch_transform().transform(patch.get_path().vertices)


def _image(image) -> dict:
    return {
        "values": array(image.get_array()), "extent": [_number(value) for value in image.get_extent()],
        "clim": [_number(value) for value in image.get_clim()], "colours": image.get_cmap().name,
    }  # fmt: skip


def _label(artist) -> str:
    """Without those that matplotlib makes up."""
    label = str(artist.get_label())
    return "" if label.startswith("_") else label


def _colours(colours) -> list[str]:
    """Each once, in their order."""
    return list(dict.fromkeys(to_hex(colour, keep_alpha=True) for colour in colours))


def array(values) -> dict:
    """Shape, how many are missing, bounds, and some of its values."""
    values = np.ma.filled(np.ma.asarray(values, float), np.nan)
    flat = values.ravel()
    finite = flat[np.isfinite(flat)]
    chosen = flat[np.unique(np.linspace(0, max(len(flat) - 1, 0), VALUES).astype(int))] if len(flat) else flat
    bounds = [float(finite.min()), float(finite.max())] if len(finite) else []
    return {
        "shape": list(values.shape), "missing": len(flat) - len(finite), "bounds": bounds,
        "values": [_number(value) for value in chosen],
    }  # fmt: skip


def without_arrays(value):
    """A description of which only words, limits and counts are kept."""
    if isinstance(value, dict):
        return {key: without_arrays(inner) for key, inner in value.items() if not _is_array(inner)}
    return [without_arrays(inner) for inner in value] if isinstance(value, list) else value


def _is_array(value) -> bool:
    return isinstance(value, dict) and "shape" in value


def _number(value) -> float | None:
    """To eight digits, of which six are compared."""
    return None if value is None or not np.isfinite(value) else float(f"{value:.8g}")
