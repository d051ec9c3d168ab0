"""A hash of tltlc's source code, which changes with the code even if the version number stays the same."""

from __future__ import annotations

import hashlib
from functools import lru_cache
from importlib.util import find_spec
from pathlib import Path
from typing import Final

_PACKAGES: Final = ("tltlc", "tltl_runtime")


@lru_cache(maxsize=1)
def sources_hash() -> str:
    """Return the SHA-256, in hexadecimal, of all modules of tltlc and tltl_runtime.

    The hash covers the names and the contents of the modules; line endings do not matter. It is
    computed once per process, because the files may change after the process has loaded them.
    """
    digest = hashlib.sha256()
    for package in _PACKAGES:
        spec = find_spec(package)
        assert spec is not None and spec.origin is not None
        folder = Path(spec.origin).parent
        for path in sorted(folder.rglob("*.py")):
            name = f"{package}/{path.relative_to(folder).as_posix()}"
            content = path.read_bytes().replace(b"\r\n", b"\n")
            digest.update(f"{name}\0{len(content)}\0".encode() + content)
    return digest.hexdigest()
