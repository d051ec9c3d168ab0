"""The panel that plays recorded episodes: buttons, a slider, and the values at the moment shown."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Final

from markupsafe import Markup

from tltl_runtime.game.episode import RecordedEpisode
from tltl_runtime.regression.report.page.render import render
from tltlc.api import Fspa

_FAILED: Final = {"violation": "broke the spec", "limit": "ran out of time"}
"""How a failed episode ended, in the words of the map's legend, by its ``end``."""


def player_panel(fspa: Fspa, episodes: Mapping[int, RecordedEpisode], values: Sequence[str]) -> Markup:
    """Return the playback panel of a case as HTML; the page's script loads the ``episodes`` into it.

    ``values`` are the names of values that the panel shows as bars, besides ``progress``. If there are
    no episodes, the panel says so.
    """
    return render(
        "player_panel.html",
        outcomes=[(index, _outcome(episodes[index])) for index in sorted(episodes)],
        bars=("progress", *values),
        atoms=[atom.name for atom in fspa.atoms],
    )


def _outcome(episode: RecordedEpisode) -> str:
    return "succeeded" if episode.success else _FAILED.get(episode.end, "failed")
