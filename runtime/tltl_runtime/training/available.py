"""What settings name that must be there: classes, and a device."""

from __future__ import annotations

from typing import Any

import torch
from rsl_rl.utils import resolve_callable

from tltlc.diagnostics.diagnostic import Diagnostic, TltlError


def class_of(setting: str, name: str, base: type) -> Any:
    """The class of a name, a subclass of ``base``; TLT0862 where it is none."""
    try:
        found = resolve_callable(name)
        why = "" if isinstance(found, type) and issubclass(found, base) else f"it is no subclass of {base.__name__}"
    except (ImportError, AttributeError, ValueError) as error:
        why = str(error)
    if why:
        title = f"wrong class for `classes.{setting}`, `{name}`: {why}"
        help_ = f'expected "package.module:Class", a subclass of {base.__module__}:{base.__qualname__}'
        raise TltlError([Diagnostic("TLT0862", title, help=help_)])
    return found


def device_of(device: str) -> str:
    """The device; TLT0862 where torch has none of that name."""
    count = torch.cuda.device_count() if torch.cuda.is_available() else 0
    if device.startswith("cuda") and int(device.partition(":")[2] or 0) >= count:
        title = f"there is no device `{device}` here, or torch was built without it"
        raise TltlError([Diagnostic("TLT0862", title, help='train on the "cpu"')])
    return device
