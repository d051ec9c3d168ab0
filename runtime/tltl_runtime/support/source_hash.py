"""What stands for the code of compiler and runtime, which versions alone do not: in a clone they stay the same."""

from __future__ import annotations

import hashlib
from functools import lru_cache
from importlib.util import find_spec
from pathlib import Path
from typing import Final

_PACKAGES: Final = ("tltlc", "tltl_runtime")


@lru_cache(maxsize=1)
def sources_hash() -> str:
    """SHA-256, in hexadecimal, of all modules of compiler and runtime and of their names; line ends do not count.

    It is computed once, so that it speaks of the code that this process may have loaded.
    """
    digest = hashlib.sha256()
    for package in _PACKAGES:
        found = find_spec(package)
        assert found is not None and found.origin is not None
        folder = Path(found.origin).parent
        for path in sorted(folder.rglob("*.py")):
            name = f"{package}/{path.relative_to(folder).as_posix()}"
            content = path.read_bytes().replace(b"\r\n", b"\n")
            digest.update(f"{name}\0{len(content)}\0".encode() + content)
    return digest.hexdigest()
