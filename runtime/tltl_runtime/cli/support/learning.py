"""What commands need that learn, or play what was learned, beyond the extra by which they were loaded."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from typing import Final

from tltlc.interfaces.cli import exits

_MODULES: Final = {"torch", "rsl_rl", "tensordict", "safetensors", "tensorboard", "onnx", "onnxscript"}


@contextmanager
def learning_for(command: str) -> Iterator[None]:
    """Within, TLT0730 with the way to install it where a part of the extra ``rl`` is missing."""
    try:
        yield
    except ModuleNotFoundError as error:
        module = (error.name or "").partition(".")[0]
        if module not in _MODULES:
            raise
        raise exits.missing_component(command, module, "tltlc[rl]") from error
