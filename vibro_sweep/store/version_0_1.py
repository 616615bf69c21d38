"""Reading files of version 0.1, which hold their numbers only as the text of the scene."""

from typing import Any

from vibro_sweep.scene import SceneError, parse_scene
from vibro_sweep.store import numbers
from vibro_sweep.store.settings import Along

SIGNIFICANT = 2.0  # standard errors that version 0.1 asked of an exponent that differs from zero


def resolved(text: str) -> tuple[dict[str, Any], Along]:
    """The attributes and the coordinates along swept keys that a file of this scene has today.

    Both are empty where the text is not a scene.
    """
    try:
        scene = parse_scene(text)
    except SceneError:
        return {}, {}
    found = numbers.dimensions(scene)
    whole = tuple(slice(None) for _ in numbers.depends_on(scene))
    values = numbers.following(scene, whole) if found else {}
    return numbers.attributes(scene), {name: (keys, values[name]) for name, keys in found.items()}
