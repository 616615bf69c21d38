"""The files of the record: one for each kind, JSON of one record a line, compressed; numbers to the last bit."""

import gzip
import json
from pathlib import Path

from support import ROOT

FOLDER = ROOT / "tests" / "data" / "golden"
KINDS = ("branches", "curves", "searches", "windows")


def read(kind: str, folder: Path = FOLDER) -> dict[str, dict]:
    """Records by their names."""
    lines = gzip.decompress((folder / f"{kind}.jsonl.gz").read_bytes()).decode().splitlines()
    return {record["name"]: record for record in map(json.loads, lines)}


def write(kind: str, records: list[dict], folder: Path = FOLDER) -> None:
    folder.mkdir(parents=True, exist_ok=True)
    text = "".join(json.dumps(record, separators=(",", ":")) + "\n" for record in records)
    (folder / f"{kind}.jsonl.gz").write_bytes(gzip.compress(text.encode(), 9, mtime=0))
