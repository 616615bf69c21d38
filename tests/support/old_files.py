"""Files that version 0.1 wrote."""

from pathlib import Path

OLD = Path(__file__).parents[1] / "data" / "version_0_1"
