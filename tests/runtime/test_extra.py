"""That the extra `rl` is there: where it is not, this one test is skipped in place of all of the runtime's."""

from __future__ import annotations

from importlib import import_module

import pytest

from tests.runtime.conftest import MISSING, NEEDED


@pytest.mark.skipif(bool(MISSING), reason=f"tests/runtime needs the extra `rl`; missing: {', '.join(MISSING)}")
def test_what_the_runtime_needs_can_be_imported() -> None:
    assert [import_module(name).__name__ for name in NEEDED] == list(NEEDED)
