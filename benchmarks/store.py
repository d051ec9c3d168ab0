"""Store results in a JSON file, a line for each record. Each measurement writes the file, so a run can resume."""

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
        """Forget the records of a section, or all if it is None; the file changes with the next :meth:`put`."""
        self._content = {name: record for name, record in self._content.items() if section not in (None, name)}

    def section(self, name: str) -> dict[str, Record]:
        """Return the records of a section by key."""
        records: dict[str, Record] = self._content.get(name, {})
        return records

    def put(self, section: str, key: str, record: Record) -> None:
        """Store a record, and write the file as a whole or not at all."""
        self._content.setdefault(section, {})[key] = record
        partial = self._path.with_suffix(".partial")
        partial.write_text(_text(self._content), encoding="utf-8")
        partial.replace(self._path)


def _text(content: Mapping[str, Mapping[str, Record]]) -> str:
    """Return the content as JSON, with each record on a line of its own."""
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
    measure: Callable[[str], Record],
    say: Callable[[str], None],
    *,
    field: str = "steps_per_s",
    current: Record | None = None,
) -> None:
    """Measure each name whose stored record lacks ``field``, or differs from a value in ``current``.

    Such a record is missing, failed, or was made by other code.
    """
    for name in names:
        record = store.section(section).get(name, {})
        if field not in record or any(record.get(key) != value for key, value in (current or {}).items()):
            record = measure(name)
            store.put(section, name, record)
            say(f"{name}: {json.dumps(record)}")


def source_digest(*places: str) -> str:
    """Return a hash, as 12 hexadecimal digits, of Python files and of all Python files in folders of the project."""
    digest = hashlib.sha256()
    for path_name in places:
        path = ROOT / path_name
        for file in [path] if path.is_file() else sorted(path.rglob("*.py")):
            digest.update(file.relative_to(ROOT).as_posix().encode() + b"\0" + file.read_bytes())
    return digest.hexdigest()[:12]
