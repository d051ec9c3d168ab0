"""A hash of JSON data that does not depend on the order of keys."""

from __future__ import annotations

import hashlib
import json


def json_hash(document: object) -> str:
    """Return the SHA-256, in hexadecimal, of JSON data; the order of keys does not matter.

    Raises ValueError for numbers that are not finite.
    """
    text = json.dumps(document, sort_keys=True, separators=(",", ":"), ensure_ascii=True, allow_nan=False)
    return hashlib.sha256(text.encode()).hexdigest()
