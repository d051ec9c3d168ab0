"""Floating-point formats: check that numbers fit, and convert values without losing their sign."""

from __future__ import annotations

from collections.abc import Iterable

import torch
from torch import Tensor


def fits(numbers: Iterable[float], dtype: torch.dtype) -> bool:
    """Whether each number is 0 or in the range of the normal numbers of ``dtype``."""
    format_ = torch.finfo(dtype)
    return all(number == 0.0 or format_.tiny <= abs(number) <= format_.max for number in numbers)


def counts_up_to(maximum: float, dtype: torch.dtype) -> bool:
    """Whether ``dtype`` has all whole numbers and halves from 0 to ``maximum``, so that a counter reaches it."""
    return maximum * torch.finfo(dtype).eps <= 0.5


def narrow(values: Tensor, dtype: torch.dtype) -> Tensor:
    """Convert values to ``dtype``, and keep their signs: only 0 becomes 0.

    A value that would round to 0 becomes the smallest normal number with the same sign.
    """
    if values.dtype == dtype:
        return values
    converted = values.to(dtype)
    least = torch.full_like(values, torch.finfo(dtype).tiny).copysign(values).to(dtype)
    return torch.where((converted == 0.0) & (values != 0.0), least, converted)
