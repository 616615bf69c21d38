"""The files of the record: one for each kind, JSON of one record a line, compressed; numbers to the last bit."""

import gzip
import json
from pathlib import Path

from support import ROOT

FOLDER = ROOT / "tests" / "data" / "golden"
RENAMED = {  # since the record was made
    '"limit"': '"boundary"',
    '"along":': '"contact_normal":',
    '"unseen":': '"unvisited":',
    '"missed":': '"other_attractor":',
    "recorded periods; NaN without impacts": "recorded periods; 0 where chatter ended in a rest; NaN without impacts",
}


def read(kind: str, folder: Path = FOLDER) -> dict[str, dict]:
    """Records by their names."""
    text = gzip.decompress((folder / f"{kind}.jsonl.gz").read_bytes()).decode()
    for before, now in RENAMED.items():
        text = text.replace(before, now)
    return {record["name"]: record for record in map(json.loads, text.splitlines())}


def write(kind: str, records: list[dict], folder: Path = FOLDER) -> None:
    folder.mkdir(parents=True, exist_ok=True)
    text = "".join(json.dumps(record, separators=(",", ":")) + "\n" for record in records)
    (folder / f"{kind}.jsonl.gz").write_bytes(gzip.compress(text.encode(), 9, mtime=0))
