"""The hash that identifies a level by its content."""

from __future__ import annotations

from tltl_runtime.stealth.level import StealthLevel
from tltl_runtime.support.json_hash import json_hash
from tltl_runtime.support.record_json import to_json

_LEFT_OUT = ("name", "variant", "doc", "spec", "files", "regions")
"""The fields of a level that cannot change an episode."""


def level_hash(level: StealthLevel) -> str:
    """Return the SHA-256, in hexadecimal, of the content of a level.

    Its name, variant, documentation, spec, files and regions do not count.
    """
    return json_hash({name: value for name, value in to_json(level).items() if name not in _LEFT_OUT})
