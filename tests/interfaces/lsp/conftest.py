from __future__ import annotations

from collections.abc import Iterator
from importlib.util import find_spec
from pathlib import Path

import pytest

if find_spec("pygls") is None:
    # Without the extra `lsp` nothing can be tested; the extra `dev` includes it.
    collect_ignore_glob = ["test_*.py"]


@pytest.fixture
def client(tmp_path: Path) -> Iterator[object]:
    from tests.interfaces.lsp.client import Client

    started = Client(tmp_path)
    yield started
    if started.process.poll() is None:
        started.kill()
    # Unexpected errors of the server would be printed there.
    assert not started.errors, "".join(started.errors)
