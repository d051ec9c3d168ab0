"""``tltlc record --tape``: the tapes of a person become demonstrations."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest

from tests.interfaces.cli.conftest import Outcome, tltlc  # noqa: F401
from tests.runtime.gymnasium_games import games
from tests.runtime.training.test_settings import compare_text
from tltl_runtime import Tape, read_tape, write_tape
from tltl_runtime.gymnasium_games.gymnasium_game import GAME
from tltl_runtime.policies.spaces.layouts import space_layouts
from tltl_runtime.training.imitation.imitation_data import read_demonstrations
from tltl_runtime.wire.clients import tltl_client
from tltlc.core.record import replace
from tltlc.diagnostics.diagnostic import TltlError

TltlcFunction = Callable[..., Outcome]

SCENE = "corridor.game.toml:short"
SEED = 7
TAPE = "traces/trace-0001.tape.jsonl"
RECORDING = "mine/short-v0-7.episode.npz"
LEFT, RIGHT = 2, 1


@pytest.fixture
def tape(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Tape:
    """A person's play in the corridor, which the recorder of the Python client wrote as ``TAPE``."""
    monkeypatch.chdir(tmp_path)
    games.write(tmp_path)
    env = GAME.make_env(SCENE)
    recorder = tltl_client.Recorder(Path("traces"), ["has_key", "door_open", "cell"], clock_hz=10, game="corridor")
    recorder.begin("short", seed=SEED)
    env.reset(seed=SEED)
    over = False
    while not over:
        action = RIGHT if env.sample["has_key"] else LEFT
        _, _, terminated, truncated, _ = env.step(action)
        recorder.sample(dict(env.sample), action)
        over = terminated or truncated
    recorder.end()
    env.close()
    return read_tape(TAPE)


def test_a_tape_becomes_a_demonstration_that_a_training_reads(tltlc: TltlcFunction, tape: Tape) -> None:  # noqa: F811
    # The second time, the folder has the same demonstration already.
    for _ in range(2):
        result = tltlc("record", SCENE, "--tape", TAPE, "-o", "mine")
        assert (result.status, result.err) == (0, ""), result.err
        line, summary, hint = result.out.splitlines()
        assert line.startswith(f"seed 7: success after {len(tape.steps)} steps, ") and line.endswith(f": {RECORDING}")
        assert summary == "1 of 1 demonstrations are in mine"
        assert hint == f"to imitate them: tltlc train --game {SCENE}:v0 --method imitation --demonstrations mine"
    checked = tltlc("replay", RECORDING, "--check", "--game", "corridor.game.toml")
    assert "played again it is the same episode" in checked.out and checked.status == 0
    env = GAME.make_env(SCENE)
    spaces = space_layouts(env.observation_space, env.action_space)
    env.close()
    data = read_demonstrations(Path("mine"), lambda: GAME.make_env(SCENE), spaces)
    assert (data.summary.episodes, data.summary.players, data.summary.left_out) == (1, ("tape",), ())
    assert data.actions.flatten().tolist() == [step.action for step in tape.steps]


@pytest.mark.parametrize(
    ("change", "reason"),
    [
        ({"seed": None}, "it has no seed"),
        ({"scene": "long"}, "it is of `long:v0`, not of `short:v0`"),
        ({"variant": "v1"}, "it is of `short:v1`, not of `short:v0`"),
        ({"action": 3}, "step 1 sent `action` as 3, but it must be a whole number from 0 to 2"),
        ({"fuel": 1.0}, "the level gives none of its signals"),
        ({"cell": 3.5}, "after step 1, `cell` is 1, but 3.5 on the tape"),
    ],
)
def test_a_tape_that_cannot_be_played_again_is_reported(
    tltlc: TltlcFunction,  # noqa: F811
    tape: Tape,
    change: dict[str, object],
    reason: str,
) -> None:
    first, *rest = tape.steps
    if "action" in change:
        first = replace(first, action=change["action"])
    elif "fuel" in change:
        tape = replace(tape, header=replace(tape.header, signals={"fuel": {"type": "number"}}))
        first, *rest = (replace(step, signals=change) for step in tape.steps)
    elif "cell" in change:
        first = replace(first, signals={**first.signals, **change})
    else:
        tape = replace(tape, header=replace(tape.header, **change))
    write_tape("other.tape.jsonl", replace(tape, steps=(first, *rest)))
    # The other tapes are played all the same.
    result = tltlc("record", SCENE, "--tape", "other.tape.jsonl", "--tape", TAPE, "-o", "mine")
    assert result.status == 1
    title = f"error[TLT0923]: the tape `other.tape.jsonl` cannot be played again: {reason}"
    assert result.err.splitlines()[0] == title
    assert result.out.endswith("1 of 2 demonstrations are in mine\n")
    if "seed" in change:
        compare_text("TLT0923", result.err)


def test_a_tape_that_does_not_meet_the_spec_is_not_kept(tltlc: TltlcFunction, tape: Tape) -> None:  # noqa: F811
    write_tape("cut.tape.jsonl", replace(tape, steps=tape.steps[:1]))
    result = tltlc("record", SCENE, "--tape", "cut.tape.jsonl", "-o", "mine")
    assert (result.status, result.err) == (1, "")
    assert result.out.splitlines()[0].endswith(": not kept (cut.tape.jsonl)")
    assert result.out.splitlines()[-1] == "0 of 1 demonstrations are in mine"
    assert not Path("mine").exists()


@pytest.mark.usefixtures("tape")
@pytest.mark.parametrize("option", [("--by", "keyboard"), ("--by", "expert"), ("--episodes", "3"), ("--seed", "3")])
def test_a_tape_has_its_own_player_and_seed(tltlc: TltlcFunction, option: tuple[str, str]) -> None:  # noqa: F811
    result = tltlc("record", SCENE, "--tape", TAPE, *option)
    assert result.status == 2
    assert "a tape is one play, with its own seed: leave out --by, --episodes and --seed" in result.err


@pytest.mark.usefixtures("tape")
def test_a_stopped_command_counts_the_tapes(tltlc: TltlcFunction, monkeypatch: pytest.MonkeyPatch) -> None:  # noqa: F811
    def stop(*_: object) -> None:
        raise KeyboardInterrupt

    monkeypatch.setattr("tltl_runtime.training.imitation.tape_episode.tape_episode", stop)
    result = tltlc("record", SCENE, "--tape", TAPE, "-o", "mine")
    assert result.err.startswith("stopped: 0 of 1 demonstrations are in mine; run the same command again to continue")


@pytest.mark.usefixtures("tape")
def test_messages_about_tapes_name_the_command_that_plays_them_again(tltlc: TltlcFunction) -> None:  # noqa: F811
    command = "`tltlc record LEVEL --tape FILE"
    with pytest.raises(TltlError) as caught:
        read_demonstrations(Path("traces"), lambda: GAME.make_env(SCENE))
    (diagnostic,) = caught.value.diagnostics
    assert diagnostic.title == "there is nothing to imitate in `traces`: it contains no recording, only tapes"
    assert diagnostic.help and command in diagnostic.help
    replayed = tltlc("replay", TAPE)
    assert replayed.err.startswith(f"error[TLT0820]: `{TAPE}` is a tape, not an episode\n  help: {command}")
