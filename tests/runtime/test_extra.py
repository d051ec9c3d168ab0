"""The extra `rl` is installed. If it is not, this test is skipped, and no other test of the runtime is collected."""

from __future__ import annotations

from importlib import import_module

import pytest

from tests.runtime.conftest import MISSING, NEEDED


@pytest.mark.skipif(bool(MISSING), reason=f"tests/runtime needs the extra `rl`; missing: {', '.join(MISSING)}")
def test_the_modules_that_the_runtime_needs_can_be_imported() -> None:
    assert [import_module(name).__name__ for name in NEEDED] == list(NEEDED)
