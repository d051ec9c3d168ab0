from __future__ import annotations

from tests.cli.conftest import inside, process, tltlc

__all__ = ["inside", "process", "tltlc"]
