"""Observations as a network reads them: tensors by key, for every kind of observation space."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
import torch
from numpy.typing import NDArray
from tensordict import TensorDict
from torch import Tensor

from tltl_runtime.policies.spaces.layouts import SpaceLayouts
from tltl_runtime.policies.spaces.values import observation_arrays


class ObservationEncoding:
    """Converts observations to tensors by key.

    Without ``layouts``, an observation is a mapping of arrays, and all tensors are float32. With
    ``layouts``, an observation is a value of the space that they describe. Images and grids of
    bytes then stay uint8, which takes a quarter of the memory of float32.
    """

    def __init__(self, layouts: SpaceLayouts | None) -> None:
        self._layouts = layouts

    def batch(self, observation: Any, count: int, device: str = "cpu") -> TensorDict:
        """Convert a batch of ``count`` observations to tensors [count, ...] on a torch device."""
        tensors = {key: self._tensor(values).to(device) for key, values in self._arrays(observation, count).items()}
        return TensorDict(tensors, batch_size=[count], device=device)

    def stacked(self, observations: Sequence[Any]) -> Mapping[str, NDArray[Any]]:
        """Convert n observations, each of one environment, to arrays [n, ...] by key; n is at least 1."""
        rows = [self._arrays(observation, None) for observation in observations]
        return {key: np.stack([row[key] for row in rows]) for key in rows[0]}

    def tensors(self, arrays: Mapping[str, NDArray[Any]]) -> TensorDict:
        """Convert arrays [n, ...] by key, such as :meth:`stacked` returns, to tensors."""
        count = len(next(iter(arrays.values())))
        return TensorDict({key: self._tensor(values) for key, values in arrays.items()}, batch_size=[count])

    def _arrays(self, observation: Any, count: int | None) -> Mapping[str, NDArray[Any]]:
        if self._layouts is None:
            arrays: Mapping[str, NDArray[Any]] = observation
            return arrays
        return observation_arrays(self._layouts.observation, observation, count)

    def _tensor(self, values: NDArray[Any]) -> Tensor:
        tensor = torch.from_numpy(values)
        return tensor.to(torch.float32) if self._layouts is None else tensor
