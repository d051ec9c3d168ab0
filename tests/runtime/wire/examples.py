"""The examples in the comment at the beginning of each client, and on the page about the protocol."""

from __future__ import annotations

import re
from pathlib import Path

from tests.docs.blocks import ROOT
from tests.runtime.wire.conversation import Game, contains

PAGE = (ROOT / "docs" / "wire.md").read_text(encoding="utf-8")


def code_of_page(language: str, word: str = "recorder") -> str:
    """Return the block of code in this language on the page that contains ``word``."""
    (block,) = (code for code in re.findall(rf"```{language}\n(.*?)```", PAGE, re.DOTALL) if word in code)
    return str(block)


def code_of_comment(client: Path, mark: str, first: str, last: str) -> str:
    """Return the indented lines of a comment, from the one that begins with ``first`` to ``last``.

    ``mark`` begins each line of the comment, such as ``//``.
    """
    lines = [line.removeprefix(mark) for line in client.read_text(encoding="utf-8").splitlines()]
    code = [line[5:] for line in lines if line.startswith("     ") or not line]
    start = next(index for index, line in enumerate(code) if line.startswith(first))
    end = next(index for index, line in enumerate(code) if index > start and line.startswith(last))
    return "\n".join(code[start : end + 1]) + "\n"


def check_example(command: list[str]) -> None:
    """Play the game of a client's comment: it counts moves and ends at 10."""
    with Game(command) as game:
        hello = game.receive()["hello"]
        assert hello["signals"] == {
            "position": {"range": [0, 10]},
            "moves": {"range": [0, None]},
            "at_goal": {"type": "bool"},
        }
        assert "crypt" in game.ask({"reset": {"scene": "crypt"}})["error"]["message"]
        begun = {"signals": {"position": 0, "moves": 0, "at_goal": False}, "ended": False}
        assert contains(game.ask({"reset": {"seed": 3}}), {"state": begun})
        end = {"signals": {"position": 10, "moves": 10, "at_goal": True}, "observation": [10], "ended": True}
        assert contains(game.ask({"step": {"action": 2, "repeat": 99}}), {"state": end})
        game.send({"close": {}})
        assert game.status() == 0


def check_traces_of_page(folder: Path) -> None:
    """Check the one trace that the example of the page has recorded in a folder: it begins after the first tick."""
    (path,) = folder.iterdir()
    header, *lines = path.read_text(encoding="utf-8").splitlines()
    rows = [line.split(",") for line in lines]
    assert header == "time,position,at_goal"
    assert [(float(time), float(position), at_goal) for time, position, at_goal in rows] == [
        (tick / 10, tick + 1, str(tick == 4).lower()) for tick in range(5)
    ]
