"""Say which extra of tltlc, such as ``tltlc[rl]``, installs a package that a command needs."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from typing import Final

from tltlc.api import cli

_EXTRAS: Final = {
    **dict.fromkeys(("safetensors", "threadpoolctl", "jinja2", "markupsafe"), "game"),
    **dict.fromkeys(("torch", "rsl_rl", "tensordict", "tensorboard", "onnx", "onnxscript"), "rl"),
}
"""The extra that installs a module, by the module's name."""


@contextmanager
def name_missing_extra(command: str) -> Iterator[None]:
    """Raise TltlError, TLT0730, if the code of a ``with`` block imports a module that is not installed.

    The help of the error says which extra installs the module. ``command`` is the command that
    needs the module. If ``_EXTRAS`` does not list the module, the ModuleNotFoundError propagates.
    """
    try:
        yield
    except ModuleNotFoundError as error:
        module = (error.name or "").partition(".")[0]
        if module not in _EXTRAS:
            raise
        raise cli.exits.missing_component(command, module, f"tltlc[{_EXTRAS[module]}]") from error
