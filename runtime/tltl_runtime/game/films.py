"""Films of a game's episodes."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Iterator, Sequence
from typing import Generic

import numpy as np
from numpy.typing import NDArray

from tltl_runtime.game.recorder import EpisodeT
from tltlc.api import Notation

Picture = NDArray[np.uint8]
"""An RGB picture, (height, width, 3)."""


class Films(ABC, Generic[EpisodeT]):
    """Draws the frames of films of a game's episodes."""

    views: tuple[str, ...]
    """The names of the views that a film can show, the usual one first."""

    @abstractmethod
    def frames(
        self, episode: EpisodeT, times: Sequence[float], view: str, size: tuple[int, int], notation: Notation
    ) -> Iterator[Picture]:
        """Yield a picture of the episode at each of ``times``.

        ``times`` are seconds since the reset, in ascending order. ``view`` is one of ``views``, and
        ``size`` is the width and height in pixels. The pictures may show formulas, in ``notation``.
        """
