"""Windows of sweeps with compliant stops as records, and what differs from a record. The sweep is computed anew."""

import vibro_sweep as vs
from golden import windows
from golden.scenes import computed


def windows_in(scene: str):
    """Of the sweep of a scene."""
    return vs.windows(computed(scene), workers=1)


def differences_from(record: dict) -> list[str]:
    """Between a record and the windows that are found now."""
    return windows.compared(record, record["result"], windows_in(record["scene"]))
