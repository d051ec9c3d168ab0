"""The cache of results between runs: a result, with a hash of everything that it depends on."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Sequence
from pathlib import Path
from typing import Any, TypeVar

from tltl_runtime.support.record_json import from_json, to_json
from tltl_runtime.support.source_hash import sources_hash
from tltlc.api import fileio

T = TypeVar("T")


def inputs_hash(parts: Sequence[Any]) -> str:
    """Return the SHA-256, in hexadecimal, of ``parts`` and of the source code of tltlc.

    ``parts`` is JSON data: all that a cached result depends on.
    """
    return hashlib.sha256(json.dumps([*parts, sources_hash()], sort_keys=True).encode()).hexdigest()


def cache_text(inputs: str, content: object) -> str:
    """Return the text of a cache file: JSON with ``content`` and ``inputs``.

    ``inputs`` is the hash of everything that the content depends on: see :func:`inputs_hash`.
    """
    return json.dumps({"identity": inputs, "content": to_json(content)}, ensure_ascii=False) + "\n"


def read_cache(kind: type[T], path: Path, inputs: str) -> T | None:
    """Read the content of a cache file, a value of type ``kind``.

    None if the file does not exist, cannot be read, or was written with another hash than ``inputs``.
    The caller then computes the content again.
    """
    if not fileio.may_be_file(path):
        return None
    try:
        document = fileio.load_json(path, fileio.limits.REPORT)
        return from_json(kind, document["content"], "content") if document["identity"] == inputs else None
    except (OSError, ValueError, KeyError, TypeError, RecursionError):
        return None
