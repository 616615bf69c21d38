"""Makes importable what tests and benchmarks share: tests/support/ and tests/reference/."""

import sys
from pathlib import Path

sys.path.append(str(Path(__file__).resolve().parents[1] / "tests"))
