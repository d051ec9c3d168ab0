"""Commands on a game that lacks every capability: they do without, or give one plain error."""

from __future__ import annotations

import csv
import json
from collections.abc import Callable
from pathlib import Path

import pytest

from tests.interfaces.cli.conftest import Outcome, tltlc  # noqa: F401
from tests.runtime import bare_game
from tests.runtime.bare_game import SPEC, BareEpisode, BareGame, ExpertGame, walk
from tltl_runtime.cli.support.evaluation_files import EvaluationFiles
from tltl_runtime.cli.support.level_faults import level_faults
from tltl_runtime.evaluation.player import EpisodeRequest, PlayedEpisode, Setup
from tltl_runtime.game import registry
from tltl_runtime.game.episode import trajectory
from tltl_runtime.game.level_name import Variant
from tltl_runtime.game.sensors import Sensors
from tltl_runtime.policies.file import read_policy
from tltl_runtime.policies.shipped import shipped_policy
from tltlc.api import TltlError

Run = Callable[..., Outcome]
NO_EXPERT = (
    "error[TLT0731]: the game of `corridor` has no scripted expert\n"
    "  help: let a trained policy play and be recorded: `tltlc evaluate POLICY --record all --out DIR`, "
    "or play the tape of a person again: `tltlc record LEVEL --tape FILE`\n"
)
NO_WINDOW = (
    "error[TLT0731]: the game of `corridor` has no window in which a person can play\n"
    "  help: let a trained policy play: `tltlc evaluate POLICY --record all --out DIR`\n"
)


@pytest.fixture(autouse=True)
def _bare(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Make the bare game the only one, in a current folder that has its spec."""
    monkeypatch.setitem(registry._MODULES, registry.STEALTH, bare_game.__name__)
    monkeypatch.chdir(tmp_path)
    Path("far.tltl").write_text(SPEC)


@pytest.fixture(name="recorded")
def _recorded() -> BareEpisode:
    """An episode, which is recorded in `run.episode.npz`."""
    game = BareGame()
    env = game.recorder(game.make_env("corridor"), "hand")
    episode = walk(env, 7)
    Path("run.episode.npz").write_bytes(game.episode_bytes(episode))
    return episode


@pytest.mark.parametrize(
    ("arguments", "error"),
    [
        (["demonstrate", "corridor"], NO_EXPERT),
        (["record", "corridor"], NO_EXPERT),
        (["record", "corridor", "--by", "keyboard"], NO_WINDOW),
        (["play", "corridor"], NO_WINDOW),
        (
            ["check", "--level", "corridor"],
            "error[TLT0731]: the game of `corridor` cannot check its levels\n"
            "  help: `tltlc check SPEC` checks a spec without a level\n",
        ),
    ],
    ids=lambda value: " ".join(value[:4]) if isinstance(value, list) else "",
)
def test_what_the_game_lacks_is_one_plain_error(
    tltlc: Run,  # noqa: F811
    arguments: list[str],
    error: str,
) -> None:
    result = tltlc(*arguments)
    assert (result.status, result.out, result.err.rstrip("\n") + "\n") == (2, "", error)
    assert [path.name for path in Path().iterdir()] == ["far.tltl"]


def test_options_for_sensors_are_refused_by_name(tltlc: Run) -> None:  # noqa: F811
    result = tltlc("train", "--level", "corridor", "--entities", "exit", "--no-map")
    assert (result.status, result.out) == (2, "")
    assert result.err.split("\n\n") == [
        "error[TLT0815]: agents have no sensors to choose in `corridor`: `entities`\n  help: leave it out",
        "error[TLT0815]: agents have no sensors to choose in `corridor`: `map`\n  help: leave it out\n",
    ]


def test_an_expert_is_recorded_without_pictures(
    tltlc: Run,  # noqa: F811
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(bare_game, "GAME", ExpertGame())
    result = tltlc("demonstrate", "corridor", "-o", "runs")
    assert (result.status, result.err) == (0, "")
    assert result.out.startswith("seed 0: success after 4 steps, 0.40 s, progress 1.00, return 0.500: ")
    assert [path.name for path in Path("runs").iterdir()] == ["corridor-v0-0.episode.npz"]
    result = tltlc("record", "corridor", "--episodes", "2", "-o", "kept")
    assert (result.status, result.out.splitlines()[2]) == (0, "2 of 2 demonstrations are in kept")


def test_a_film_is_refused_before_the_expert_plays(
    tltlc: Run,  # noqa: F811
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(bare_game, "GAME", ExpertGame())
    result = tltlc("demonstrate", "corridor", "-o", "runs", "--film", "gif")
    assert (result.status, result.out) == (2, "")
    assert result.err.startswith("error[TLT0731]: the game of `corridor` has no films\n")
    assert not Path("runs").exists()


@pytest.mark.usefixtures("recorded")
def test_a_recording_is_summarized_and_checked(tltlc: Run) -> None:  # noqa: F811
    result = tltlc("replay", "run.episode.npz", "--check")
    assert (result.status, result.err) == (0, "")
    assert result.out == (
        "run.episode.npz\n"
        "  level    corridor:v0, spec far\n"
        "  player   hand, seed 7\n"
        "  end      success, after 4 of 8 steps, 0.40 s\n"
        "  reward   0.500, progress 1.000\n"
        "\n"
        "    time  state  progress  what remains\n"
        "    0.00      0     0.000  Reach x > 3.\n"
        "    0.40      1     1.000  Nothing remains to be done.\n"
        "\n"
        "  checked  the judgement follows from the signals; its game cannot play it again\n\n"
    )
    (fields,) = json.loads(tltlc("replay", "run.episode.npz", "--check", "--format", "json").out)
    assert "health" not in fields
    assert (fields["follows_from_spec"], fields["plays_again"], fields["seconds"]) == (True, None, 0.4)


def test_the_signals_of_a_recording_can_be_judged(tltlc: Run, recorded: BareEpisode) -> None:  # noqa: F811
    result = tltlc("replay", "run.episode.npz", "-o", "run.csv")
    assert result.status == 0
    with Path("run.csv").open() as file:
        assert [row["x"] for row in csv.DictReader(file)] == [repr(x) for x in recorded.signals[1:, 0].tolist()]
    assert tltlc("monitor", "far.tltl:far", "run.csv").status == 0


@pytest.mark.usefixtures("recorded")
@pytest.mark.parametrize(
    ("name", "lack"), [("run.png", "draws no pictures"), ("run.gif", "has no films"), ("run.mp4", "has no films")]
)
def test_a_picture_of_a_recording_is_one_plain_error(tltlc: Run, name: str, lack: str) -> None:  # noqa: F811
    result = tltlc("replay", "run.episode.npz", "-o", name)
    assert (result.status, result.out) == (2, "")
    assert result.err.startswith(f"error[TLT0731]: the game of `corridor` {lack}\n  help: write the signals instead: ")
    assert not Path(name).exists()


def test_an_evaluation_writes_and_mentions_no_pictures(recorded: BareEpisode) -> None:
    policy_file = shipped_policy("cover_and_hide")
    assert policy_file is not None
    setup = Setup(read_policy(policy_file), "corridor", Variant("v0"), recorded.fspa, 7, recorded="all")
    files = EvaluationFiles(setup, policy_file, "0" * 64, 0, "tltlc evaluate", Path("out"), None)
    summary = BareGame().summary(recorded)
    result = PlayedEpisode(EpisodeRequest(0), summary, trajectory(recorded), BareGame().episode_bytes(recorded))
    files.add(result)
    assert files.write("{}") == "out: 1 recording, evaluation.json"
    names = ["corridor-v0-7-0-sampled.episode.npz", "evaluation.json"]
    assert sorted(path.name for path in Path("out").iterdir()) == names


def test_the_defaults_say_that_the_game_has_nothing(recorded: BareEpisode) -> None:
    game, level, fspa = BareGame(), recorded.level, recorded.fspa
    sensors = Sensors(("exit",), (), None)
    assert (dict(game.choices), game.branches, game.params(level)) == ({}, (), {})
    assert (game.landmarks(level), game.solids(level), game.barriers(level)) == ({}, {}, {})
    assert list(game.missing_sensors(level, sensors)) == game.unreachable_entities(level, fspa) == []
    assert not game.is_infeasible(level, fspa)
    assert game.play_warnings(level, fspa) == []
    assert game.level_fault(RuntimeError()) is None
    assert game.observers(recorded, 0.0, 9.0) == game.shut_barriers(recorded) == ()
    assert game.choose_sensors(level) == game.choose_sensors(level, level.sensors) == level.sensors
    with pytest.raises(TltlError, match="TLT0815"):
        game.choose_sensors(level, sensors)
    env = game.recorder(game.make_env("corridor"))
    with pytest.raises(TltlError, match="TLT0731"):
        game.expert_episodes(env, [0])


def test_other_errors_of_a_game_without_faults_are_bugs() -> None:
    with pytest.raises(RuntimeError, match="broken"), level_faults():
        raise RuntimeError("broken")
