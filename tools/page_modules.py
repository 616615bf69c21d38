"""The modules of pages that a published wheel brings: python tools/page_modules.py FOLDER"""

import lzma
import sys
from pathlib import Path

from vibro_sweep.standalone.kernel_module import SHIPPED, kind_named, module_of, shipped_name

MOST = 600_000  # bytes of all together

if __name__ == "__main__":
    folder, total = Path(sys.argv[1]), 0
    folder.mkdir(parents=True, exist_ok=True)
    for name in SHIPPED:
        packed = lzma.compress(module_of(kind_named(name)), preset=9 | lzma.PRESET_EXTREME)
        (folder / shipped_name(name)).write_bytes(packed)
        total += len(packed)
        print(f"{shipped_name(name)}: {len(packed):,} bytes")
    if total > MOST:
        sys.exit(f"{total:,} bytes are more than {MOST:,}")
