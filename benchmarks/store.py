"""The results in a JSON file with a line for each record, written after each measurement so that a run can resume."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Callable, Iterable, Mapping
from pathlib import Path
from typing import Any

ROOT = Path(__file__).resolve().parent.parent
RESULTS = Path(__file__).with_name("results.json")

Record = dict[str, Any]


class Store:
    """Records by section and key, in the order in which they were measured."""

    def __init__(self, path: Path = RESULTS) -> None:
        self._path = path
        self._content: dict[str, Any] = {}
        if path.exists():
            self._content = json.loads(path.read_text(encoding="utf-8"))

    def discard(self, section: str | None) -> None:
        """Forget the records of a section, or all; the file keeps them until the next one is put."""
        self._content = {name: kept for name, kept in self._content.items() if section not in (None, name)}

    def section(self, name: str) -> dict[str, Record]:
        """The records of a section by key."""
        records: dict[str, Record] = self._content.get(name, {})
        return records

    def put(self, section: str, key: str, record: Record) -> None:
        """Keep a record and write the file, whole or not at all."""
        self._content.setdefault(section, {})[key] = record
        partial = self._path.with_suffix(".partial")
        partial.write_text(_text(self._content), encoding="utf-8")
        partial.replace(self._path)


def _text(content: Mapping[str, Mapping[str, Record]]) -> str:
    """The content as JSON, each record on a line of its own."""
    sections = (
        f"{json.dumps(name)}: {{\n"
        + ",\n".join(f" {json.dumps(key)}: {json.dumps(record)}" for key, record in records.items())
        + "\n}"
        for name, records in content.items()
    )
    return "{\n" + ",\n".join(sections) + "\n}\n"


def measure_missing(
    store: Store,
    section: str,
    names: Iterable[str],
    measured: Callable[[str], Record],
    say: Callable[[str], None],
    *,
    done: str = "steps_per_s",
    like: Record | None = None,
) -> None:
    """Put the record of each name that has no ``done`` in the store yet, or other values than ``like``: it was not
    measured, failed, or is of another time.
    """
    for name in names:
        kept = store.section(section).get(name, {})
        if done not in kept or any(kept.get(key) != value for key, value in (like or {}).items()):
            record = measured(name)
            store.put(section, name, record)
            say(f"{name}: {json.dumps(record)}")


def source_digest(*places: str) -> str:
    """Twelve hexadecimal digits that stand for these Python files of the project, and those of these folders."""
    digest = hashlib.sha256()
    for place in places:
        path = ROOT / place
        for file in [path] if path.is_file() else sorted(path.rglob("*.py")):
            digest.update(file.relative_to(ROOT).as_posix().encode() + b"\0" + file.read_bytes())
    return digest.hexdigest()[:12]
