"""``python -m vibro_sweep`` is the program ``vibro-sweep``."""

import sys

from .cli import main

sys.exit(main())
