"""Messages of games are read strictly: types, ranges, kinds and numbers; unknown keys are ignored."""

from __future__ import annotations

import json
from contextlib import suppress
from math import inf
from random import Random
from typing import Any

import numpy as np
import pytest
from hypothesis import given

from tests.fuzzing import SEEDS, mutated_json, times
from tltl_runtime.wire import answers, json_text, requests
from tltl_runtime.wire.errors import MalformedMessageError
from tltl_runtime.wire.hello import DeclaredSignal, hello_from

HELLO: dict[str, Any] = {
    "hello": {
        "tltl": 1,
        "token": "secret",
        "name": "counter",
        "clock_hz": 10,
        "signals": {"position": {"type": "length", "range": [0, 10]}, "seen": {"type": "bool"}, "moves": {}},
        "params": {"speed": 2},
        "actions": {"type": "discrete", "n": 3},
        "observation": {"type": "box", "low": 0, "high": 10, "shape": [1]},
        "scenes": ["short", {"name": "long", "size": 3}],
        "capabilities": ["seed", "positions", "telepathy"],
        "later": {"unknown": [1]},
    }
}
STATE: dict[str, Any] = {
    "state": {
        "signals": {"position": 3, "seen": False, "moves": 0.5},
        "observation": [3],
        "ended": False,
        "cause": None,
        "positions": {"player": [3, 0]},
        "later": 1,
    },
    "also later": {},
}


def changed(message: dict[str, Any], path: str, value: Any) -> dict[str, Any]:
    copy = json.loads(json.dumps(message))
    *folders, last = path.split("/")
    place = copy
    for folder in folders:
        place = place[folder]
    place[last] = value
    return copy  # type: ignore[no-any-return]


def test_a_hello_is_read() -> None:
    hello = hello_from(HELLO)
    assert (hello.name, hello.token, hello.clock_hz, hello.encoding) == ("counter", "secret", 10.0, "json")
    assert hello.signals == {
        "position": DeclaredSignal("length", 0.0, 10.0),
        "seen": DeclaredSignal("bool", 0.0, 1.0),
        "moves": DeclaredSignal("number", -inf, inf),
    }
    assert hello.scenes == ("short", "long") and hello.params == {"speed": 2.0}
    assert "telepathy" in hello.capabilities and str(hello.actions) == "Discrete(3)"


@pytest.mark.parametrize(
    ("path", "value", "message"),
    [
        ("hello", 1, 'must first send a line such as `{"hello": {"tltl": 1, …}}`, but sent another one'),
        ("hello/tltl", 2, "speaks version 2 of the protocol, and this tltlc speaks version 1"),
        ("hello/tltl", None, "sent `hello.tltl` as null, but it must be the version of the protocol, 1"),
        ("hello/tltl", True, "sent `hello.tltl` as true, but it must be the version of the protocol, 1"),
        ("hello/token", 3, "sent `hello.token` as 3, but it must be a text"),
        (
            "hello/name",
            "a\nb",
            'sent `hello.name` as "a\N{REPLACEMENT CHARACTER}b", '
            "but it must be a text of printable characters, and not empty",
        ),
        ("hello/name", "", 'sent `hello.name` as "", but it must be a text of printable characters, and not empty'),
        ("hello/clock_hz", -1, "sent `hello.clock_hz` as -1, but it must be from 1e-09 to 1e+09"),
        ("hello/encoding", "pickle", 'sent `hello.encoding` as "pickle", but it must be `json` or `msgpack`'),
        ("hello/signals", [], "sent `hello.signals` as a list, but it must be an object"),
        (
            "hello/signals/seen/type",
            "boolean",
            'sent `hello.signals.seen.type` as "boolean", but '
            "it must be one of number, ratio, length, time, speed, angle, int, bool",
        ),
        (
            "hello/signals/moves/range",
            [1, 0],
            "sent `hello.signals.moves.range` as a list, but it must be a list of the least and the greatest value",
        ),
        ("hello/actions", None, "sent `hello.actions` as null, but it must be an object"),
        ("hello/scenes", [3], "sent `hello.scenes[0]` as 3, but it must be a text"),
        ("hello/capabilities", "seed", 'sent `hello.capabilities` as "seed", but it must be a list'),
    ],
)
def test_a_wrong_hello_is_refused_by_its_path(path: str, value: Any, message: str) -> None:
    with pytest.raises(MalformedMessageError) as caught:
        hello_from(changed(HELLO, path, value))
    assert str(caught.value) == message


def test_a_state_is_read() -> None:
    state = answers.StateReader(hello_from(HELLO)).read(STATE)
    assert state.signals == {"position": 3.0, "seen": False, "moves": 0.5}
    assert state.signals["seen"] is False and not state.ended and state.cause is None
    assert np.array_equal(state.observation, np.array([3], np.float32)) and state.positions == {"player": (3.0, 0.0)}


def test_an_entity_without_a_position_is_gone() -> None:
    state = answers.StateReader(hello_from(HELLO)).read(changed(STATE, "state/positions/coin", None))
    assert state.positions == {"player": (3.0, 0.0)}


def test_an_empty_cause_is_an_unknown_one() -> None:
    assert answers.StateReader(hello_from(HELLO)).read(changed(STATE, "state/cause", "")).cause is None


@pytest.mark.parametrize(
    ("path", "value", "message"),
    [
        ("state/signals/position", "3", 'sent `state.signals.position` as "3", but it must be a number'),
        ("state/signals/position", True, "sent `state.signals.position` as true, but it must be a number"),
        ("state/signals/position", 11, "sent 11.0 as the signal `position`, outside its declared range from 0 to 10"),
        ("state/signals/moves", 10**400, "sent a number that is not finite as `state.signals.moves`"),
        ("state/signals/seen", 1, "sent `state.signals.seen` as 1, but it must be true or false"),
        ("state/signals/sen", True, "sent the signal `sen`, which it did not declare; did you mean `seen`?"),
        ("state/signals", {"seen": True}, "did not send the signal `position`, which it declared"),
        ("state/observation", [11], "sent 11 as `state.observation[0]`, outside its declared range from 0 to 10"),
        ("state/ended", 0, "sent `state.ended` as 0, but it must be true or false"),
        ("state/cause", 7, "sent `state.cause` as 7, but it must be a text"),
        (
            "state/positions/player",
            [1],
            "sent `state.positions.player` as a list, but it must be a list of two or three numbers",
        ),
        ("state", [], "sent `state` as a list, but it must be an object"),
    ],
)
def test_a_wrong_state_is_refused_by_the_name_of_its_part(path: str, value: Any, message: str) -> None:
    with pytest.raises(MalformedMessageError) as caught:
        answers.StateReader(hello_from(HELLO)).read(changed(STATE, path, value))
    assert str(caught.value) == message


@pytest.mark.parametrize(
    ("message", "refusal"),
    [
        ([], "sent a list instead of an object"),
        ({"stat": {}}, "sent a message of an unknown kind, with `stat`, instead of `state`; did you mean `state`?"),
        ({"snapshot": {"id": 1}}, "sent a message `snapshot` instead of `state`"),
    ],
)
def test_other_kinds_of_messages_are_refused(message: Any, refusal: str) -> None:
    with pytest.raises(MalformedMessageError) as caught:
        answers.body_of(message, "state")
    assert str(caught.value) == refusal


def test_an_error_of_the_game_is_reported() -> None:
    with pytest.raises(answers.ReportedError, match=r"^there is no scene `crypt`$"):
        answers.body_of({"error": {"message": "there is no scene `crypt`"}}, "state")


@pytest.mark.parametrize(
    ("line", "message"),
    [
        (b'{"state": NaN}\n', "sent the number NaN, and numbers must be finite"),
        (b"[-Infinity]", "sent the number -Infinity, and numbers must be finite"),
        (b"Godot Engine v3\n", "sent a line that is not JSON: `Godot Engine v3`"),
        (b"\xff\xfe\n", "sent a line that is not UTF-8: `\N{REPLACEMENT CHARACTER}\N{REPLACEMENT CHARACTER}`"),
        (b"[" * 100_000, "sent a message that nests too deep"),
        (b"1" * 5000, "sent a line that is not JSON: `" + "1" * 60 + "…`"),
        (b"", "sent a line that is not JSON: ``"),
    ],
)
def test_lines_that_are_not_strict_json_are_refused(line: bytes, message: str) -> None:
    with pytest.raises(MalformedMessageError) as caught:
        json_text.parse(line)
    assert str(caught.value) == message


def test_requests_are_lines_of_json() -> None:
    assert json_text.line(requests.ResetRequest("crypt", "v0", 7).message()) == (
        b'{"reset":{"scene":"crypt","variant":"v0","seed":7}}\n'
    )
    assert json_text.line(requests.ResetRequest(None, "v0", None).message()) == b'{"reset":{"variant":"v0"}}\n'
    assert json_text.line(requests.StepRequest(2).message()) == b'{"step":{"action":2}}\n'
    assert json_text.line(requests.StepRequest([0.5], 4).message()) == b'{"step":{"action":[0.5],"repeat":4}}\n'
    assert json_text.line(requests.RestoreRequest(3).message()) == b'{"restore":{"id":3}}\n'
    empty = (
        requests.SnapshotRequest(),
        requests.ScreenshotRequest(),
        requests.OutlineRequest(),
        requests.CloseRequest(),
    )
    assert [json_text.line(one.message()) for one in empty] == [
        b'{"snapshot":{}}\n',
        b'{"screenshot":{}}\n',
        b'{"outline":{}}\n',
        b'{"close":{}}\n',
    ]


@times(200)
@given(SEEDS)
def test_mutated_messages_are_read_or_refused(seed: int) -> None:
    random = Random(seed)
    reader = answers.StateReader(hello_from(HELLO))
    with suppress(MalformedMessageError):
        hello_from(json_text.parse(mutated_json(random, HELLO).encode("utf-8", "surrogatepass")))
    with suppress(MalformedMessageError, answers.ReportedError):
        reader.read(json_text.parse(mutated_json(random, STATE).encode("utf-8", "surrogatepass")))


def test_a_screenshot_has_three_colours() -> None:
    picture = answers.screenshot({"screenshot": [[[1, 2, 3, 255], [4, 5, 6, 255]]]})
    assert picture.dtype == np.uint8 and picture.tolist() == [[[1, 2, 3], [4, 5, 6]]]
    for wrong in ([[1]], [[[1, 2, 300]]], [[[0.5, 0, 0]]]):
        with pytest.raises(MalformedMessageError):
            answers.screenshot({"screenshot": wrong})


def test_a_release_has_the_id_of_the_snapshot() -> None:
    answers.released({"release": {"id": "x"}}, "x")
    with pytest.raises(MalformedMessageError, match=r"`release.id` as null"):
        answers.released({"release": {}}, "x")
    with pytest.raises(MalformedMessageError, match=r"`release.id` as 3, .*\"x\", the id of the request"):
        answers.released({"release": {"id": 3}}, "x")
    with pytest.raises(MalformedMessageError, match="sent a message `release` instead of `snapshot`"):
        answers.snapshot_id({"release": {"id": 1}})


def test_a_snapshot_has_an_id() -> None:
    assert answers.snapshot_id({"snapshot": {"id": 3}}) == 3
    with pytest.raises(MalformedMessageError, match=r"`snapshot.id` as true"):
        answers.snapshot_id({"snapshot": {"id": True}})
