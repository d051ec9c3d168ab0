"""The player of recorded episodes: buttons, a scrubbing bar, and the values at the current moment."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Final

from markupsafe import Markup

from tltl_runtime.game.episode import RecordedEpisode
from tltl_runtime.regression.report.page.markup import element, joined
from tltlc.api import Fspa

_SPEEDS: Final = (1, 2, 4)
_KEYS: Final = "Space plays and pauses, the arrows step, Home and End jump."

_BUTTONS: Final = (
    ("first", "to the start", {"start": "M2,2H5V14H2ZM14,2V14L6,8Z"}),
    ("back", "a step back", {"start": "M12,2V14L4,8Z"}),
    ("play", "play", {"start": "M4,2L14,8L4,14Z", "pause": "M3,2H7V14H3ZM9,2H13V14H9Z"}),
    ("on", "a step on", {"start": "M4,2L12,8L4,14Z"}),
    ("last", "to the end", {"start": "M2,2L10,8L2,14ZM11,2H14V14H11Z"}),
)
"""The class, label and icons of each button.

Icons are SVG paths in a square of 16 units, so that they do not depend on fonts.
"""

_FAILED: Final = {"violation": "broke the spec", "limit": "ran out of time"}
"""How episodes fail, in the words of the map's legend."""


def player_panel(fspa: Fspa, episodes: Mapping[int, RecordedEpisode]) -> Markup:
    """The player of a case.  The page's script loads the episodes into it.  Without episodes, it says so."""
    if not episodes:
        return element("div", element("p", "No episode of this case was recorded."), class_="player")
    options = [
        element("option", "all episodes", value=""),
        *(
            element("option", f"episode {index}: {_outcome(episodes[index])}", value=index)
            for index in sorted(episodes)
        ),
    ]
    return element(
        "div",
        element("label", "Recorded episode ", element("select", *options, class_="which", autocomplete="off")),
        element(
            "div",
            element("div", *_buttons(), class_="buttons"),
            element(
                "input",
                type="range",
                min=0,
                max=0,
                value=0,
                step=1,
                class_="scrub",
                aria_label="Step",
                autocomplete="off",
            ),
            element("div", class_="strip", aria_hidden="true"),
            element("p", class_="moment"),
            element("p", class_="state"),
            element("dl", *map(_bar, ("progress", "health")), class_="bars"),
            _atoms(fspa),
            element("p", _KEYS, class_="hint"),
            class_="controls",
            hidden=True,
        ),
        class_="player",
    )


def _buttons() -> list[Markup]:
    buttons = [
        element("button", *_icons(icons), type="button", class_=name, aria_label=words, title=words)
        for name, words, icons in _BUTTONS
    ]
    speeds = [element("option", f"{speed}×", value=speed) for speed in _SPEEDS]
    return [*buttons, element("select", *speeds, class_="speed", aria_label="Speed", autocomplete="off")]


def _icons(icons: Mapping[str, str]) -> list[Markup]:
    return [
        element("svg", element("path", d=path), class_=f"icon {name}", viewBox="0 0 16 16", aria_hidden="true")
        for name, path in icons.items()
    ]


def _bar(name: str) -> Markup:
    meter = element("meter", min=0, max=1, value=0, class_=name, aria_label=name)
    return joined((element("dt", name), element("dd", meter, " ", element("span", class_="number"))))


def _atoms(fspa: Fspa) -> Markup:
    rows = [
        element(
            "tr",
            element("th", atom.name, scope="row"),
            element("td", element("div", element("div", class_="length"), class_="signed", aria_hidden="true")),
            element("td", class_="number"),
        )
        for atom in fspa.atoms
    ]
    caption = "Robustness of the atoms: those above 0 hold, to the right; those of 0 or less do not"
    return element("table", element("caption", caption), element("tbody", *rows), class_="atoms")


def _outcome(episode: RecordedEpisode) -> str:
    return "succeeded" if episode.success else _FAILED.get(episode.end, "failed")
