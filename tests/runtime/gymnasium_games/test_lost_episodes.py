"""Commands on a game in another process that dies now and then: it costs one episode each time."""

from __future__ import annotations

import json
import os
import sys
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest

from tests.interfaces.cli.conftest import Outcome, tltlc  # noqa: F401
from tests.runtime.gymnasium_games.test_games_in_processes import write
from tests.runtime.wire.processes import no_game_is_left
from tests.waiting import HANG_S

Run = Callable[..., Outcome]
GAMES = Path(__file__).parents[1] / "wire" / "games"
SETTINGS = """\
stop.steps = {steps}
stop.confirmation = 2
rollout = {{ envs = 2, steps = 40, workers = {workers} }}
network.hidden = [16]
exploration.ways = {ways}
checkpoint_s = 0.0
"""


@pytest.fixture(autouse=True)
def _no_process_is_left() -> Iterator[None]:
    with no_game_is_left():
        yield


@pytest.fixture(name="folder")
def _folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    folder = tmp_path / "game"
    folder.mkdir()
    monkeypatch.chdir(folder)
    return folder


def mortal(folder: Path, fault: str, *episodes: int | str, step_s: float = HANG_S) -> Path:
    """Write a game file whose game dies in these episodes, counted from now on."""
    # Not in the folder of the game: there, it would be one of the game's files.
    count = folder.with_name("episodes")
    count.unlink(missing_ok=True)
    path = write(folder, sys.executable, str(GAMES / "mortal.py"), fault, str(count), *map(str, episodes))
    path.write_text(path.read_text().replace("[game]\n", f"[game]\nstep_s = {step_s:g}\n", 1))
    return path


def train(tltlc: Run, folder: Path, *, steps: int = 400, workers: int = 1, ways: int = 0) -> Outcome:  # noqa: F811
    (folder / "settings.toml").write_text(SETTINGS.format(steps=steps, workers=workers, ways=ways))
    return tltlc("train", "--game", "counter.game.toml:short", "--config", "settings.toml", "-o", "run")


@pytest.fixture(name="trained", scope="module")
def _trained(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A policy that was trained with a game that never dies."""
    folder = tmp_path_factory.mktemp("trained") / "game"
    folder.mkdir()
    mortal(folder, "exit")
    (folder / "settings.toml").write_text(SETTINGS.format(steps=160, workers=1, ways=0))
    from tltlc.interfaces.cli.main import main

    with pytest.raises(SystemExit):
        main(
            [
                *("train", "--game", f"{folder / 'counter.game.toml'}:short"),
                *("--config", str(folder / "settings.toml"), "-o", str(folder / "run")),
            ]
        )
    return folder / "run" / "policy.safetensors"


LOST = [
    ("exit", "ended with exit status 3 instead of answering `step`", "now: exit"),
    ("crash", "was killed by SIGSEGV instead of answering `step`", "now: crash"),
    ("garbage", "sent", "now: garbage"),
    ("reset", "reports: no such map", ""),
]


@pytest.mark.parametrize(("fault", "sentence", "last_line"), LOST)
def test_an_evaluation_goes_on_without_lost_episodes(
    tltlc: Run,  # noqa: F811
    trained: Path,
    folder: Path,
    fault: str,
    sentence: str,
    last_line: str,
) -> None:
    game = mortal(folder, fault, 3, 6)
    result = tltlc("evaluate", trained, "--game", f"{game}:short", "--episodes", 20, "--json", "report.json")
    assert result.status == 0, result.err
    assert "2 episodes were lost: the game `counter.game.toml` " + sentence in result.err
    assert last_line in result.err and result.err.count("warning[TLT079") == 1
    assert "stopped" not in result.err
    rows = [line.split() for line in result.out.splitlines()]
    assert ["episodes", "18", "20"] in rows and ["lost", "2", "0"] in rows
    report = json.loads(Path("report.json").read_text())
    assert report["complete"] and [lost["index"] for lost in report["lost"]] == [2, 5]
    assert [episode["index"] for episode in report["episodes"]] == [0, 1, 3, 4, *range(6, 20)]
    assert "lost" not in report["argmax"]
    assert sentence in report["lost"][0]["title"]


def test_other_episodes_are_the_same_whether_or_not_one_is_lost(
    tltlc: Run,  # noqa: F811
    trained: Path,
    folder: Path,
) -> None:
    reports = []
    for episodes in ((), (4,)):
        game = mortal(folder, "exit", *episodes)
        tltlc("evaluate", trained, "--game", f"{game}:short", "--episodes", 10, "--json", "report.json")
        reports.append(json.loads(Path("report.json").read_text())["episodes"])
    whole, lossy = reports
    assert [episode for episode in whole if episode["index"] != 3] == lossy


def test_a_game_that_hangs_costs_one_episode(tltlc: Run, trained: Path, folder: Path) -> None:  # noqa: F811
    # The game sleeps for an hour, so the deadline always passes.
    game = mortal(folder, "hang", 2, step_s=2)
    result = tltlc("evaluate", trained, "--game", f"{game}:short", "--episodes", 10)
    assert result.status == 0, result.err
    assert "1 episode was lost: the game `counter.game.toml` did not answer `step` within 2 s" in result.err


def test_workers_lose_episodes_too(tltlc: Run, trained: Path, folder: Path) -> None:  # noqa: F811
    game = mortal(folder, "exit", 5, 11)
    result = tltlc("evaluate", trained, "--game", f"{game}:short", "--episodes", 20, "--workers", 2)
    assert result.status == 0, result.err
    assert "2 episodes were lost" in result.err


def test_a_game_that_dies_in_each_episode_ends_the_evaluation(
    tltlc: Run,  # noqa: F811
    trained: Path,
    folder: Path,
) -> None:
    game = mortal(folder, "exit", *range(4, 100))
    result = tltlc("evaluate", trained, "--game", f"{game}:short", "--episodes", 100)
    assert result.status == 1
    assert "error[TLT0791]: the game `counter.game.toml` ended with exit status 3" in result.err
    assert "4 episodes were lost" in result.err
    assert "stopped: 3 of 100 sampled and 0 of 100 arg-max episodes were played" in result.err


@pytest.mark.parametrize("workers", [1, 2])
def test_a_training_goes_on_without_lost_episodes(tltlc: Run, folder: Path, workers: int) -> None:  # noqa: F811
    mortal(folder, "exit", 3, 8)
    result = train(tltlc, folder, workers=workers)
    assert result.status in (0, 1), result.err
    assert "2 lost" in result.err
    assert "2 episodes were lost: the game `counter.game.toml` ended with exit status 3" in result.err
    assert "now: exit" in result.err
    lines = [json.loads(line) for line in Path("run/metrics.jsonl").read_text().splitlines()]
    assert sum(line.get("lost", 0) for line in lines) == 2
    assert lines[-1]["steps"] >= 400


def test_a_training_goes_on_if_a_reset_fails(tltlc: Run, folder: Path) -> None:  # noqa: F811
    mortal(folder, "reset", 4)
    result = train(tltlc, folder)
    assert result.status in (0, 1), result.err
    assert "1 episode was lost: the game `counter.game.toml` reports: no such map" in result.err


def test_a_game_that_dies_in_each_episode_ends_the_training(tltlc: Run, folder: Path) -> None:  # noqa: F811
    mortal(folder, "exit", *range(6, 200))
    result = train(tltlc, folder)
    assert result.status == 1
    assert "error[TLT0871]: the training was interrupted" in result.err
    assert "ended with exit status 3 instead of answering `step`" in result.err
    assert "the game's standard error ends:\n        now: exit\n" in result.err


@pytest.mark.slow
def test_a_game_that_dies_while_it_is_measured_is_measured_again(tltlc: Run, folder: Path) -> None:  # noqa: F811
    mortal(folder, "exit", 2)
    result = train(tltlc, folder, ways=1)
    assert result.status in (0, 1), result.err
    assert "searches by restoring the game's snapshots" in result.err
    assert "lost" not in result.err


def test_a_game_that_always_dies_while_it_is_measured_is_not_searched(tltlc: Run, folder: Path) -> None:  # noqa: F811
    mortal(folder, "exit", 2, 3, 4)
    result = train(tltlc, folder, ways=1)
    assert result.status in (0, 1), result.err
    assert "trains from the start alone, without a search: the game `counter.game.toml` ended" in result.err


@pytest.mark.slow
def test_a_search_goes_on_without_lost_episodes(tltlc: Run, folder: Path) -> None:  # noqa: F811
    mortal(folder, "exit", *range(40, 400, 60))
    result = train(tltlc, folder, ways=1)
    assert result.status in (0, 1), result.err
    assert "the training was interrupted" not in result.err


@pytest.mark.slow
def test_a_suite_reports_lost_episodes(tltlc: Run, trained: Path, folder: Path) -> None:  # noqa: F811
    game = mortal(folder, "exit", 2, 7)
    case = f'[[case]]\ngame = "{game.name}"\nscene = "short"\npolicy = "{os.path.relpath(trained, folder)}"\n'
    thresholds = "episodes = 30\nthresholds = { pass_rate = 0.05, fail_rate = 0.01 }\n"
    (folder / "suite.toml").write_text(case + thresholds)
    result = tltlc("baseline", "suite.toml", "--workers", 1)
    assert result.status in (0, 1), result.err
    assert "played again, because 2 episodes were lost: the game `counter.game.toml` ended" in result.err
    baseline = json.loads(Path("suite.baseline.json").read_text())
    assert [episode["index"] for episode in baseline["references"][0]["accounts"]] == [*range(30)]
    mortal(folder, "exit", 2, 7)
    result = tltlc("regress", "suite.toml", "--workers", 1, "--json", "report.json")
    assert result.status in (0, 1), result.err
    (report,) = json.loads(Path("report.json").read_text())["cases"]
    text = "2 episodes were lost: the game `counter.game.toml` ended with exit status 3 instead of answering `step`"
    (sentence,) = [reason for reason in report["reasons"] if reason.startswith(text)]
    assert "now: exit" in sentence and sentence in result.out
    mortal(folder, "exit", "all")
    result = tltlc("regress", "suite.toml", "--workers", 1, "--fresh")
    assert "it cannot be played\n    TLT0791, the game `counter.game.toml` ended with exit status 3" in result.out


EXPERT = """\
import sys
from pathlib import Path

import gymnasium

from tltl_runtime.wire.env import WireEnv
from tltl_runtime.wire.wire_game import WireGame


class Expert:
    def choose(self, observation):
        return 2


class Guided(gymnasium.Wrapper):
    def tltl_expert(self):
        return Expert()

    def tltl_signals(self):
        return self.env.tltl_signals()


def make(scene):
    return Guided(WireEnv(WireGame("counter", Path.cwd(), {words!r}), scene=scene))
"""


def with_expert(folder: Path, fault: str, *episodes: int | str) -> None:
    """Write a game file whose environment is a game in another process, which may die, with an expert."""
    path = mortal(folder, fault, *episodes)
    words = (sys.executable, str(GAMES / "mortal.py"), fault, str(folder.with_name("episodes")), *map(str, episodes))
    (folder / "guided.py").write_text(EXPERT.format(words=words))
    scene = path.read_text().partition("[[scene]]")[2]
    path.write_text(f'[game]\npython = "guided:make"\n\n[[scene]]{scene}')


def test_an_expert_goes_on_demonstrating_after_a_lost_episode(tltlc: Run, folder: Path) -> None:  # noqa: F811
    with_expert(folder, "exit", 2)
    result = tltlc("demonstrate", "counter.game.toml:short", "--episodes", 4, "-o", "runs")
    assert result.status == 0, result.err
    assert "1 episode was lost: the game `counter` ended with exit status 3 instead of answering `step`" in result.err
    assert "now: exit" in result.err
    assert "3 of 3 succeeded" in result.out
    # The second episode has the seed 1.
    assert sorted(path.name for path in Path("runs").glob("*.npz")) == [
        f"short-v0-{seed}.episode.npz" for seed in (0, 2, 3)
    ]


def test_an_expert_stops_if_each_episode_is_lost(tltlc: Run, folder: Path) -> None:  # noqa: F811
    with_expert(folder, "exit", "all")
    result = tltlc("demonstrate", "counter.game.toml:short", "--episodes", 40, "-o", "runs")
    assert result.status == 1
    assert "error[TLT0791]: the game `counter` ended with exit status 3" in result.err
    assert "4 episodes were lost" in result.err


def test_demonstrations_are_recorded_in_spite_of_a_lost_episode(tltlc: Run, folder: Path) -> None:  # noqa: F811
    with_expert(folder, "exit", 1)
    result = tltlc("record", "counter.game.toml:short", "--episodes", 2, "-o", "kept")
    assert result.status == 0, result.err
    assert "1 episode was lost: the game `counter` ended with exit status 3 instead of answering `step`" in result.err
    assert "2 of 2 demonstrations are in kept" in result.out
