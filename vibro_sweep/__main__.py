"""``python -m vibro_sweep`` is the program ``vibro-sweep``."""

from .cli import program

program()
