"""MessagePack in place of JSON, if the game asks for it and the package is installed."""

from __future__ import annotations

import sys

import numpy as np
import pytest

from tests.runtime.wire.test_faults import GAMES
from tests.waiting import HANG_S
from tltl_runtime.wire.env import WireEnv
from tltl_runtime.wire.errors import WireError
from tltl_runtime.wire.wire_game import WireGame

pytest.importorskip("msgpack")


def packed(*words: str) -> WireGame:
    return WireGame("packed", GAMES, (sys.executable, "packed.py", *words), start_s=HANG_S, step_s=HANG_S)


def test_messages_may_be_packed() -> None:
    env = WireEnv(packed())
    observation, _ = env.reset(seed=0)
    assert observation.dtype == np.uint8 and observation.ravel().tolist() == list(range(12))
    env.step(np.array([0.5, -0.5], np.float32))
    assert env.tltl_signals() == {"health": 0.5}
    env.close()


@pytest.mark.parametrize(
    ("fault", "sentence"),
    [
        ("long", "sent a message of 1,073,741,824 bytes; at most 33,554,432 are allowed"),
        ("garbage", "sent a message that is not MessagePack: `\N{REPLACEMENT CHARACTER}`"),
        ("nan", "sent a number that is not finite as `state.signals.health`"),
        ("extension", "sent `state.signals.health` as ExtType, but it must be a number"),
    ],
)
def test_a_packed_message_that_breaks_the_protocol_is_refused(fault: str, sentence: str) -> None:
    env = WireEnv(packed(fault))
    with pytest.raises(WireError) as caught:
        env.reset()
    assert caught.value.diagnostics[0].title == f"the game `packed` {sentence}"


def test_without_the_package_messages_stay_json(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "msgpack", None)
    env = WireEnv(packed())
    with pytest.raises(WireError, match="ended with exit status 7") as caught:
        env.reset()
    assert "agreed: json" in (caught.value.diagnostics[0].help or "")
