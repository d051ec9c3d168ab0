"""Check that the packages of the extra ``rl``, which trained policies need, are installed."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from typing import Final

from tltlc.api import cli

_MODULES: Final = {"torch", "rsl_rl", "tensordict", "safetensors", "tensorboard", "onnx", "onnxscript"}


@contextmanager
def require_learning(command: str) -> Iterator[None]:
    """Raise TltlError, TLT0730, if a package of the extra ``rl`` is missing.

    The help of the error is the command that installs it.
    """
    try:
        yield
    except ModuleNotFoundError as error:
        module = (error.name or "").partition(".")[0]
        if module not in _MODULES:
            raise
        raise cli.exits.missing_component(command, module, "tltlc[rl]") from error
