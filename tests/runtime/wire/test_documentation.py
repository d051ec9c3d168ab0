"""The messages on the page about the protocol are read by tltlc, and written by it."""

from __future__ import annotations

import json
import re
import shutil
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from tests.docs.blocks import ROOT, blocks
from tests.interfaces.cli.conftest import Outcome, tltlc
from tltl_runtime.gymnasium_games.outline_reader import read_outline
from tltl_runtime.wire import answers, requests
from tltl_runtime.wire.answers import StateReader
from tltl_runtime.wire.clients import tltl_client
from tltl_runtime.wire.hello import hello_from
from tltl_runtime.wire.outline import outline_from
from tltl_runtime.wire.spaces import space_from
from tltl_runtime.wire.wire_game import START_S, STEP_S
from tltlc.api.fileio import limits

__all__ = ["tltlc"]

PAGE = (ROOT / "docs" / "wire.md").read_text(encoding="utf-8")


def messages() -> list[dict[str, Any]]:
    """Return the messages in the blocks of JSON, in order."""
    decoder = json.JSONDecoder()
    messages = []
    for block in re.findall(r"```json\n(.*?)```", PAGE, re.DOTALL):
        text = block.strip()
        while text:
            message, end = decoder.raw_decode(text)
            messages.append(message)
            text = text[end:].strip()
    return messages


def test_each_message_has_an_example_that_is_read() -> None:
    (hello, reset, step, state, snapshot, restore, answer, release, released, *others) = messages()
    (screenshot, picture, outline, walls, close, error, agreement) = others
    declared = hello_from(hello)
    read = StateReader(declared).read(state)
    assert read.positions["guard_1"] == (0, 2) and declared.params == {"key_count": 3}
    assert reset == requests.ResetRequest("crypt", "v0", 7).message()
    assert step == requests.StepRequest(2, 4).message()
    assert snapshot == requests.SnapshotRequest().message() and restore == requests.RestoreRequest(3).message()
    assert answers.snapshot_id(answer) == 3
    assert release == requests.ReleaseRequest(3).message()
    answers.released(released, 3)
    assert screenshot == requests.ScreenshotRequest().message()
    assert answers.screenshot(picture).tolist() == [[[255, 0, 0], [0, 255, 0], [0, 0, 255]]]
    assert outline == requests.OutlineRequest().message()
    drawn = read_outline(outline_from(walls), ROOT)
    assert [box.name for box in drawn.boxes] == ["wall", "wall", "chest"] and drawn.image is not None
    assert close == requests.CloseRequest().message()
    assert list(error) == ["error"] and agreement["hello"]["encoding"] == "msgpack"


def test_each_space_of_the_page_is_read() -> None:
    documents = re.findall(r"^\| `(\{\"type\".*?\})` \|", PAGE, re.MULTILINE)
    assert len(documents) == 6
    inner = '{"type": "discrete", "n": 2}'
    for document in documents:
        space_from(json.loads(document.replace("…", inner)), "space")


def test_limits_and_deadlines_are_those_of_the_code() -> None:
    text = " ".join(PAGE.split())
    assert f"at most {limits.WIRE_MESSAGE.size >> 20} MiB" in text
    assert f"`hello` at most {limits.WIRE_HELLO.size >> 20} MiB" in text
    assert (
        f"at most {limits.WIRE_HELLO.depth} levels" in text and f"at most {limits.WIRE_HELLO.values:,} numbers" in text
    )
    assert f"the last {limits.WIRE_STDERR.values} lines" in text
    assert f"| `start_s` | {START_S:g} s |" in text and f"| `step_s` | {STEP_S:g} s |" in text


def test_each_client_has_a_row() -> None:
    folder = Path(tltl_client.__file__).parent
    assert f"`{folder.relative_to(ROOT).as_posix()}/`" in PAGE
    for path in folder.glob("*[Cc]lient*.*"):
        assert f"| `{path.name}` |" in PAGE


def test_the_game_of_the_page_is_checked_as_shown(
    tltlc: Callable[..., Outcome],
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    page_blocks = blocks(ROOT / "docs" / "wire.md")
    for block in page_blocks:
        if name := re.match(r"(?:#|//) (counter\.\S+)\n", block.text):
            (tmp_path / name[1]).write_text(block.text)
    shutil.copy(tltl_client.__file__, tmp_path)
    monkeypatch.chdir(tmp_path)
    checked = tltlc("check", "--game", "counter.game.toml")
    (shown,) = (block.text for block in page_blocks if block.text.startswith("$ tltlc check --game counter"))
    steady = re.sub(r"[\d,]+ steps a second", "8,000 steps a second", checked.out + checked.err)
    assert f"$ tltlc check --game counter.game.toml\n{steady}" == shown
