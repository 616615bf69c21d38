"""What several tests share: scenes, oscillators, damaged files."""

from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]  # the checkout; the package that is tested may be installed elsewhere
