"""Check the arguments of a vector environment before any worker starts."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

import numpy as np
from gymnasium.vector import AutoresetMode
from numpy.typing import NDArray


def check_arguments(
    functions: Sequence[Callable[..., Any]],
    workers: int | str | None,
    names: Sequence[str] | None,
    autoreset: AutoresetMode,
    on_death: str,
) -> None:
    """Check the arguments of a ``WorkerVectorEnv``.

    Raises:
        ValueError: an argument has an invalid value.
        TypeError: an argument is of another type.
    """
    if not functions:
        raise ValueError("expected at least one function that makes an environment")
    if not all(map(callable, functions)):
        raise TypeError("expected functions that make environments, not environments: write `[lambda: make()] * 8`")
    if workers not in (None, "ray") and (not isinstance(workers, int) or isinstance(workers, bool)):
        raise TypeError(f"workers must be a whole number or 'ray', not {workers!r:.40}")
    if isinstance(workers, int) and workers < 1:
        raise ValueError(f"at least one worker is needed, not {workers}")
    if names is not None and len(names) != len(functions):
        raise ValueError(f"the number of names must be {len(functions)}, not {len(names)}")
    if autoreset == AutoresetMode.DISABLED:
        raise ValueError("autoreset must be SAME_STEP or NEXT_STEP here, not DISABLED")
    if on_death not in ("stop", "replace"):
        raise ValueError(f"on_death must be `stop` or `replace`, not {on_death!r}")
    if on_death == "replace" and autoreset != AutoresetMode.SAME_STEP:
        raise ValueError("workers can be replaced only with autoreset SAME_STEP: new episodes begin in the same step")


def split_mask(options: dict[str, Any] | None, count: int) -> tuple[NDArray[np.bool_], dict[str, Any] | None]:
    """Split the options of a reset: return the mask ``options["reset_mask"]``, and the other options.

    The mask has a bool for each of ``count`` environments: whether to reset it. If there is no mask
    in ``options``, the returned mask is True for all environments.

    Raises:
        ValueError: the mask is not an array of one bool per environment, or none of them is true.
    """
    if options is None or "reset_mask" not in options:
        return np.ones(count, dtype=np.bool_), options
    mask = np.asarray(options["reset_mask"])
    if mask.shape != (count,) or mask.dtype != np.bool_ or not mask.any():
        expected = f"a bool array of the shape {(count,)} with at least one True"
        raise ValueError(f"options['reset_mask'] must be {expected}, not {mask!r:.80}")
    return mask, {key: value for key, value in options.items() if key != "reset_mask"}
