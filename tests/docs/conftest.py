from __future__ import annotations

from tests.interfaces.cli.conftest import inside, process, tltlc

__all__ = ["inside", "process", "tltlc"]
