"""The commands on a game of one's own: train, evaluate, replay, baseline, regress."""

from __future__ import annotations

import json
import re
from base64 import b64decode
from collections.abc import Callable
from io import BytesIO
from pathlib import Path
from typing import Any

import pytest
from PIL import Image

from tests.interfaces.cli.conftest import Outcome, tltlc  # noqa: F401
from tests.runtime.gymnasium_games import games
from tltl_runtime.cli.support import regression_run

Run = Callable[..., Outcome]
SETTINGS = """\
[rollout]
envs = 4
steps = 16
workers = 1
[network]
hidden = [16]
[exploration]
ways = 0
"""
SEARCHING = SETTINGS.partition("[exploration]")[0]
"""Settings with the usual search for ways to meet the spec."""
SUITE = """\
seed = 3
episodes = 25

[[case]]
game = "corridor.game.toml"
scene = "short"
policy = "run"

[[case]]
game = "corridor.game.toml"
scene = "short"
variant = "v1"
policy = "run"
"""
SWAPPED = games.GRID.replace("scene, length=5", "scene, swapped=False, length=5").replace("{}", "{'cell': self.cell}")
SWAPPED = SWAPPED.replace(
    "return Corridor(length, render_mode)", "return (Mirror if swapped else Corridor)(length, render_mode)"
)
SWAPPED += """

class Mirror(Corridor):
    def step(self, action):
        self.cell = self.length - 1 - self.cell
        super().step((0, 2, 1)[action])
        self.cell = self.length - 1 - self.cell
        return self._observation(), float(self.opened), self.opened, False, {'cell': self.cell}
"""
"""The corridor with an option, with which the key and the door have each other's places.

It says in which cell the player is, so that a training can search for ways.
"""


@pytest.fixture(name="folder", scope="module")
def _folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("corridor")
    games.write(folder)
    (folder / "settings.toml").write_text(SETTINGS)
    (folder / "suite.toml").write_text(SUITE)
    return folder


@pytest.fixture(name="trained")
def _trained(folder: Path, tltlc: Run, monkeypatch: pytest.MonkeyPatch) -> Path:  # noqa: F811
    """The folder of the game, with a training of a few steps in it."""
    monkeypatch.chdir(folder)
    if not (folder / "run").exists():
        options = ("--steps", "192", "--config", "settings.toml", "--out", "run")
        result = tltlc("train", "--game", "corridor.game.toml:short", *options)
        assert result.status == 1, result.err
        assert result.err.splitlines()[:4] == [
            "training fetch on corridor.game.toml:short:v0, seed 0, in run",
            "it ends when the spec is met, at the latest after 192 steps",
            "starting the game once, to see what it observes and does",
            "starting 4 environments in 1 process",
        ]
    return folder


@pytest.mark.usefixtures("trained")
def test_a_policy_is_evaluated_and_its_episodes_play_again(tltlc: Run, tmp_path: Path) -> None:  # noqa: F811
    out = tmp_path / "out"
    result = tltlc("evaluate", "run", "--episodes", "2", "--record", "all", "--out", out)
    assert result.status == 0, result.err
    assert "corridor.game.toml:short:v0, spec fetch, seed 0: run/policy.safetensors" in result.out
    recording = out / "short-v0-0-0-sampled.episode.npz"
    replayed = tltlc("replay", recording, "--check", "--game", "corridor.game.toml", "--format", "json")
    assert replayed.status == 0, replayed.err
    (fields,) = json.loads(replayed.out)
    assert (fields["follows_from_spec"], fields["plays_again"], fields["level"]) == (True, True, "short")
    without = tltlc("replay", recording, "--check")
    assert "to play it again, say where its game is: --game" in without.out
    trace = tltlc("replay", recording, "-o", tmp_path / "it.csv")
    assert trace.status == 0
    assert tltlc("monitor", "corridor.tltl:fetch", tmp_path / "it.csv").status in (0, 1)
    film = tltlc("replay", recording, "--game", "corridor.game.toml", "-o", tmp_path / "it.gif")
    assert film.status == 0, film.err
    with Image.open(tmp_path / "it.gif") as picture:
        assert picture.size == (640, 480)
        assert picture.n_frames > 1  # type: ignore[attr-defined]


def test_a_training_and_an_evaluation_name_the_clause_that_episodes_break(
    folder: Path,
    tltlc: Run,  # noqa: F811
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.chdir(folder)
    (folder / "wary.tltl").write_text(
        "clock 10 Hz\nsignal has_key: bool\nsignal door_open: bool\n"
        "spec wary { limit 20 s  reach door_open  avoid   has_key }\n"
    )
    options = ("--steps", "640", "--config", "settings.toml", "--out", "wary")
    trained = tltlc("train", "wary.tltl", "--game", "corridor.game.toml:short", *options)
    named = re.compile(r"  (\d+) of (\d+) break `avoid has_key`, (mostly )?at steps? \d+.*")
    (line,) = filter(None, map(named.fullmatch, trained.out.splitlines()))
    window = json.loads((folder / "wary" / "record.json").read_text())["window"]
    (cause,) = window["causes"]
    assert (cause["kind"], cause["clauses"]) == ("broken", ["avoid has_key"])
    assert (cause["count"], window["episodes"]) == (int(line[1]), int(line[2]))
    evaluated = tltlc("evaluate", "wary", "--episodes", "3", "--json", "wary.json")
    assert any(map(named.fullmatch, evaluated.out.splitlines())), evaluated.out
    report = json.loads((folder / "wary.json").read_text())
    (cause,) = report["causes"]
    assert (cause["clauses"], cause["count"], cause["episodes"]) == (["avoid has_key"], 3, [0, 1, 2])


@pytest.mark.usefixtures("trained")
def test_a_film_needs_the_game(tltlc: Run, tmp_path: Path) -> None:  # noqa: F811
    tltlc("evaluate", "run", "--episodes", "1", "--record", "all", "--out", tmp_path)
    recording = tmp_path / "short-v0-0-0-sampled.episode.npz"
    result = tltlc("replay", recording, "-o", tmp_path / "it.gif")
    assert result.status == 2
    assert "error[TLT0800]: a film of `short` needs its game, which plays the episode again" in result.err
    assert "say where the game is: `--game corridor.game.toml`" in result.err
    assert not (tmp_path / "it.gif").exists()


def test_a_suite_tests_scenes(tltlc: Run, trained: Path, tmp_path: Path) -> None:  # noqa: F811
    recorded = tltlc("baseline", "suite.toml", "--workers", "1")
    assert recorded.status in (0, 1), recorded.err
    baseline = json.loads((trained / "suite.baseline.json").read_text())
    assert {reference["played"]["place"] for reference in baseline["references"]} == {"corridor.game.toml:short"}
    result = tltlc("regress", "suite.toml", "--out", tmp_path, "--json", tmp_path / "report.json", "--workers", "1")
    assert result.status in (0, 1), result.err
    report = json.loads((tmp_path / "report.json").read_text())
    assert [case["name"] for case in report["cases"]] == ["short:v0", "short:v1"]
    assert report["cases"][0]["pass_rate"] == report["cases"][0]["baseline"]["pass_rate"]
    page = (tmp_path / "report.html").read_text()
    assert "<h3>Episodes</h3>" in page
    assert "<h3>Map</h3>" not in page
    assert "There is no map: the game does not say where the player is. Add <code>tltl_positions()</code>" in page
    assert "<figcaption>episode 0:" in page
    # A film of each recorded episode, above its curves, as the policy of the page allows.
    assert "img-src data:;" in page
    films = re.findall(r'<img class="film" src="data:image/webp;base64,([^"]+)" alt="Film of episode 0"', page)
    assert films
    with Image.open(BytesIO(b64decode(films[0]))) as film:
        assert (film.format, film.size) == ("WEBP", (320, 240))
        assert film.n_frames > 1  # type: ignore[attr-defined]
    assert "There is no film" not in page
    assert re.search(r"^short:v0: drawing \d+ films? for the page$", result.err, re.MULTILINE)


@pytest.mark.usefixtures("trained")
def test_films_are_drawn_again_only_if_something_has_changed(tltlc: Run, tmp_path: Path) -> None:  # noqa: F811
    assert tltlc("baseline", "suite.toml", "--workers", "1").status in (0, 1)
    command = ("regress", "suite.toml", "--out", tmp_path, "--workers", "1")

    def films(*options: str) -> tuple[bool, list[str]]:
        err = tltlc(*command, *options).err
        return "for the page" in err, re.findall(r"base64,([^\"]+)", (tmp_path / "report.html").read_text())

    drawn, first = films()
    assert drawn and first
    assert films() == (False, first)
    (kept, *_) = (tmp_path / "cases" / "short-v0").glob("*.webp")
    kept.unlink()
    assert films() == (True, first)
    assert films("--fresh") == (True, first)


@pytest.mark.usefixtures("trained")
def test_a_game_file_that_breaks_while_cases_are_played_costs_no_report(
    folder: Path,
    tltlc: Run,  # noqa: F811
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    game = folder / "corridor.game.toml"
    text, report = game.read_text(), regression_run._report

    def report_after_an_edit(*arguments: Any) -> None:
        game.write_text("[game")
        report(*arguments)

    assert tltlc("baseline", "suite.toml", "--workers", "1").status in (0, 1)
    monkeypatch.setattr(regression_run, "_report", report_after_an_edit)
    try:
        result = tltlc("regress", "suite.toml", "--out", tmp_path, "--workers", "1")
    finally:
        game.write_text(text)
    assert result.status in (0, 1), result.err
    assert "There is no film" in (tmp_path / "report.html").read_text()


@pytest.mark.slow
def test_a_policy_that_fails_after_a_change_is_retrained(
    tltlc: Run,  # noqa: F811
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.chdir(tmp_path)
    suite = 'seed = 3\nepisodes = 60\n[[case]]\ngame = "corridor.game.toml"\nscene = "short"\npolicy = "good"\n'
    # Only quick ways are in time, so that chance does not meet the spec.
    spec = games.SPEC.replace("limit 20 s", "limit 1 s")
    game = games.write(tmp_path, suite__toml=suite, settings__toml=SEARCHING, corridor__tltl=spec, corridor__py=SWAPPED)
    train = ("train", "--game", "corridor.game.toml:short", "--config", "settings.toml", "--out", "good")
    assert tltlc(*train, "--steps", "30000").status == 0
    assert tltlc("baseline", "suite.toml", "--workers", "1").status == 0
    game.write_text(games.GAME.replace("length = 4", "length = 4, swapped = true"))
    reports = ("--out", "out", "--json", "report.json")
    result = tltlc("regress", "suite.toml", "--retrain", "--minutes", "0.1", "--workers", "1", *reports)
    assert result.status == 1, result.err
    (case,) = json.loads((tmp_path / "report.json").read_text())["cases"]
    assert case["verdict"] == "fail"
    assert case["retrained"]["outcome"] in ("learned", "feasible"), result.err
    page = (tmp_path / "out" / "report.html").read_text()
    assert "<h3>Retrained from its policy</h3>" in page
    assert "How the training went" in page
    policy = Path("out") / case["retrained"]["policy"]
    assert tltlc("evaluate", policy, "--game", "corridor.game.toml:short", "--episodes", "2").status == 0


def test_a_changed_file_of_the_game_selects_its_cases(tltlc: Run, trained: Path, tmp_path: Path) -> None:  # noqa: F811
    if not (trained / "suite.baseline.json").exists():
        tltlc("baseline", "suite.toml", "--workers", "1")
    for file in ("corridor.tltl", "corridor.py", "corridor.game.toml"):
        both = tltlc("regress", "suite.toml", "--changed", file, "--out", tmp_path, "--workers", "1")
        assert "2 cases" in both.out, both.err
    none = tltlc("regress", "suite.toml", "--changed", "unknown.py", "--out", tmp_path, "--workers", "1")
    assert "short:v0" not in none.out


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (("train", "--game", "corridor.toml"), "`corridor.toml` is not a game file"),
        (("evaluate", "run", "--game", "missing.game.toml"), "TLT0001"),
        (("evaluate", "run", "--game", "corridor.game.toml:shorts"), "did you mean `short`?"),
        (("train", "--game", "corridor.game.toml:short", "--level", "vault"), "give --level or --game, not both"),
        (("train", "--game", "corridor.game.toml:long"), "TLT0721"),
        (("evaluate", "run/policy.safetensors"), "--game FILE.game.toml:short`"),
        (("evaluate", "corridor.game.toml:short"), "is a scene of a game file, not a policy"),
        (("evaluate", "corridor.game.toml:shorts"), "did you mean `short`?"),
        (("evaluate", "corridor.game.toml"), "name the scene with --game"),
    ],
)
@pytest.mark.usefixtures("trained")
def test_wrong_scenes_are_reported(tltlc: Run, arguments: tuple[str, ...], message: str) -> None:  # noqa: F811
    result = tltlc(*arguments)
    assert result.status >= 1
    assert message in result.err


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ('game = "corridor.toml"', "must be the path of a file `NAME.game.toml`"),
        ('game = "missing.game.toml"', "there is no game `missing.game.toml`"),
        ('game = "corridor.game.toml"\nscene = "short"\nvariant = "v7"', "has no variant `v7`"),
    ],
)
@pytest.mark.usefixtures("trained")
def test_wrong_cases_are_reported(tltlc: Run, tmp_path: Path, text: str, message: str) -> None:  # noqa: F811
    folder = Path.cwd()
    suite = folder / "wrong.toml"
    suite.write_text(f'[[case]]\n{text}\npolicy = "run"\n')
    result = tltlc("regress", "wrong.toml", "--out", tmp_path)
    assert result.status in (1, 2)
    assert message in result.err


def test_the_game_of_a_project_needs_no_option(tltlc: Run, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:  # noqa: F811
    monkeypatch.chdir(tmp_path)
    games.write(tmp_path, tltl__toml='game = "corridor.game.toml"\n', settings__toml=SETTINGS)
    options = ("--steps", "64", "--config", "settings.toml", "--out", "run")
    assert "training fetch on corridor.game.toml:short:v0" in tltlc("train", "corridor.tltl:fetch", *options).err
    (tmp_path / "other.tltl").write_text("clock 10 Hz signal door_open: bool spec other { reach door_open limit 9 s }")
    assert "`other` does not name a level: name one with --level" in tltlc("train", "other.tltl").err
    (tmp_path / "named.tltl").write_text(
        "clock 10 Hz signal door_open: bool spec named { level long reach door_open limit 9 s }"
    )
    assert "training named on corridor.game.toml:long:v0" in tltlc("train", "named.tltl", *options[:-1], "named").err


def test_the_printed_settings_are_those_with_which_the_scene_is_trained(
    tltlc: Run,  # noqa: F811
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.chdir(tmp_path)
    games.write(tmp_path, tltl__toml='game = "corridor.game.toml"\n')
    printed = tltlc("train", "--game", "corridor.game.toml:long", "--print-config")
    assert "hidden = [128, 128]" in printed.out and "envs = 16 " in printed.out
    assert tltlc("train", "corridor.tltl:fetch", "--print-config") == printed
    for argument in ("cover_and_hide", "missing.tltl"):
        assert "hidden = [512, 512]" in tltlc("train", argument, "--print-config").out


def test_the_check_prints_no_control_characters_of_a_game(
    tltlc: Run,  # noqa: F811
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.chdir(tmp_path)
    code = games.GRID.replace('"cell": float(game.cell)', '"cell": float(game.cell), "\\x1b[2J\\n::error::": 0.0')
    assert code != games.GRID
    games.write(tmp_path, corridor__py=code)
    result = tltlc("check", "--game", "corridor.game.toml:short:v0")
    assert "  in 200 random steps, `\ufffd[2J ::error::` never changed\n" in result.err
    assert "\x1b" not in result.err


EXPERT = """

class Expert:
    def choose(self, observation):
        return 2 if not observation["has_key"] else 1


def make(scene, length=5, render_mode=None):
    env = Corridor(length, render_mode)
    env.tltl_expert = Expert
    return env
"""


def test_the_expert_of_a_game_demonstrates(tltlc: Run, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:  # noqa: F811
    monkeypatch.chdir(tmp_path)
    games.write(tmp_path, corridor__py=games.GRID + EXPERT)
    result = tltlc("demonstrate", "corridor.game.toml:short", "--episodes", "3", "-o", "runs")
    assert result.status == 0, result.err
    assert result.out.count("success after") == 3
    recorded = tltlc("record", "corridor.game.toml:short", "--episodes", "2", "-o", "kept")
    assert recorded.status == 0, recorded.err
    assert "2 of 2 demonstrations are in kept" in recorded.out


EXPERT_OF_ANY_SPEC = """

class Expert:
    def __init__(self, fspa):
        self.fspa = fspa

    def choose(self, observation):
        state = int(observation["automaton"].argmax())
        distances = [state.distance for state in self.fspa.states]
        nearer = [edge for edge in self.fspa.edges_from(state) if distances[edge.target] == distances[state] - 1]
        wanted = {atom for edge in nearer for prime in edge.guard.primes for atom, holds in prime if holds}
        return 2 if "has_key" in {self.fspa.atoms[atom].name for atom in wanted} else 1


class Guided(Corridor):
    def tltl_expert(self, skill="high", *, task):
        assert skill == "high"
        return Expert(task.fspa)


def make(scene, length=5, render_mode=None):
    return Guided(length, render_mode)
"""


def test_an_expert_gets_the_automaton_of_the_spec(tltlc: Run, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:  # noqa: F811
    monkeypatch.chdir(tmp_path)
    games.write(tmp_path, corridor__py=games.GRID + EXPERT_OF_ANY_SPEC)
    result = tltlc("demonstrate", "corridor.game.toml:short", "--episodes", "2", "-o", "runs")
    assert result.out.count("success after") == 2, result.err
    (tmp_path / "key.tltl").write_text("clock 10 Hz signal has_key: bool spec key { reach has_key limit 9 s }")
    other = tltlc("demonstrate", "corridor.game.toml:short", "--spec", "key.tltl:key", "-o", "keys")
    assert other.out.count("success after") == 1, other.err


def test_a_game_without_an_expert_is_refused(tltlc: Run, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:  # noqa: F811
    monkeypatch.chdir(tmp_path)
    games.write(tmp_path)
    result = tltlc("demonstrate", "corridor.game.toml:short")
    assert result.status == 2
    assert "error[TLT0731]" in result.err


@pytest.mark.slow
def test_a_training_says_how_it_searches(tltlc: Run, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:  # noqa: F811
    monkeypatch.chdir(tmp_path)
    games.write(tmp_path, settings__toml=SEARCHING)
    options = ("--steps", "64", "--config", "settings.toml", "--out", "run")
    result = tltlc("train", "--game", "corridor.game.toml:short", *options)
    lines = result.err.splitlines()
    plan = "searches by replaying actions: the game gives no snapshots; places are values of "
    assert any(line.startswith(plan) for line in lines)
    assert any(line.startswith("searching first for ways to meet the spec, with random actions.") for line in lines)
    assert any(line.startswith("search: ") and "ways found" in line for line in lines)
    assert "without a search" not in result.out


def test_a_training_without_a_search_says_why(tltlc: Run, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:  # noqa: F811
    monkeypatch.chdir(tmp_path)
    random = games.GRID.replace("import gymnasium\n", "import random\n\nimport gymnasium\n").replace(
        "(0, 1, -1)[action]", "random.choice((0, 1, -1))"
    )
    games.write(tmp_path, settings__toml=SEARCHING, corridor__py=random)
    options = ("--steps", "64", "--config", "settings.toml", "--out", "run")
    result = tltlc("train", "--game", "corridor.game.toml:short", *options)
    assert "trains from the start alone, without a search: equal seeds and actions give different plays: " in result.err
    assert "it began without a search for demonstrations, because equal seeds and actions give " in result.out


@pytest.mark.usefixtures("trained")
def test_another_scene_is_not_resumed(tltlc: Run) -> None:  # noqa: F811
    result = tltlc("train", "--game", "corridor.game.toml:long", "--resume", "run", "--steps", "500")
    assert result.status == 1
    assert "is on the level" in result.err


@pytest.mark.usefixtures("trained")
def test_recordings_of_another_game_are_kept(tltlc: Run, trained: Path, tmp_path: Path) -> None:  # noqa: F811
    evaluate = ("evaluate", "run", "--episodes", "1", "--record", "all", "--out", tmp_path)
    assert tltlc(*evaluate).status == 0
    kept = {path.name: path.read_bytes() for path in tmp_path.glob("*.npz")}
    other = trained / "other.game.toml"
    other.write_text((trained / "corridor.game.toml").read_text())
    copied = trained / "copied.safetensors"
    copied.write_bytes((trained / "run" / "policy.safetensors").read_bytes() + b"")
    result = tltlc("evaluate", copied, "--game", "other.game.toml:short", "--seed", "9", *evaluate[2:])
    assert result.status == 0, result.err
    assert {name: (tmp_path / name).read_bytes() for name in kept} == kept
    other.unlink()
