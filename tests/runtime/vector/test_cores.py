from __future__ import annotations

import pytest

from tltl_runtime.vector.cores import torchrun_variable
from tltlc.diagnostics.diagnostic import TltlError


def test_the_variable_of_torchrun_is_read(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.delenv("WORLD_SIZE", raising=False)
    assert torchrun_variable("WORLD_SIZE", 1) == 1
    monkeypatch.setenv("WORLD_SIZE", "4")
    assert torchrun_variable("WORLD_SIZE", 1) == 4


@pytest.mark.parametrize("text", ["", "x", "0", "-1", "1.5", "²", "9" * 5000])
def test_invalid_values_are_rejected(text: str, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("WORLD_SIZE", text)
    with pytest.raises(TltlError, match=r"TLT0862: the environment variable WORLD_SIZE is `.{0,20}`"):
        torchrun_variable("WORLD_SIZE", 1)
