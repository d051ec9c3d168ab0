"""Find the classes and the device that the settings name."""

from __future__ import annotations

from typing import Any

import torch
from rsl_rl.utils import resolve_callable

from tltl_runtime.training.ppo.distributed import process_group
from tltlc.api import Diagnostic, TltlError


def class_of(setting: str, name: str, base: type) -> Any:
    """Return the class called ``name``, such as ``package.module:Class``.

    ``name`` is the value of ``setting``, which is ``runner`` or ``algorithm``. Raises TltlError,
    TLT0862, unless it is a subclass of ``base``.
    """
    try:
        cls = resolve_callable(name)
        reason = "" if isinstance(cls, type) and issubclass(cls, base) else f"it is not a subclass of {base.__name__}"
    except (ImportError, AttributeError, ValueError) as error:
        reason = str(error)
    if reason:
        title = f"wrong class for `classes.{setting}`, `{name}`: {reason}"
        help_ = f'expected "package.module:Class", a subclass of {base.__module__}:{base.__qualname__}'
        raise TltlError([Diagnostic("TLT0862", title, help=help_)])
    return cls


def device_of(device: str) -> str:
    """Return the torch device of this process, for the setting ``device``.

    With several processes, ``cuda`` becomes ``cuda:0`` for the first process on this machine,
    ``cuda:1`` for the second, and so on. Otherwise the device stays as it is.

    Raises TltlError, TLT0862: the device does not exist, the setting names one GPU for several
    processes, or there are more processes than GPUs.
    """
    if not device.startswith("cuda"):
        return device
    group, gpus = process_group(), torch.cuda.device_count() if torch.cuda.is_available() else 0
    if group.count == 1:
        if int(device.partition(":")[2] or 0) >= gpus:
            raise _no_device(f"there is no device `{device}` here, or torch was built without it", 'train on the "cpu"')
        return device
    if device != "cuda":
        title = f"each of {group.count} processes needs its own device, but `{device}` is only one"
        raise _no_device(title, 'write "cuda"; the variable CUDA_VISIBLE_DEVICES chooses which devices they use')
    if group.local_count > gpus:
        count = group.local_count
        need = "the process needs a device" if count == 1 else f"each of {count} processes needs its own device"
        title = f"{need}, but torch finds {gpus} here"
        raise _no_device(title, 'start no more processes than devices, or train on the "cpu"')
    return f"cuda:{group.local_rank}"


def _no_device(title: str, help_: str) -> TltlError:
    return TltlError([Diagnostic("TLT0862", title, help=help_)])
