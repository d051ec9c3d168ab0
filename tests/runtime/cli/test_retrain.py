"""``tltlc regress --retrain``: its output, its files and its errors."""

from __future__ import annotations

import json
import re
import shutil
import signal
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path
from xml.etree import ElementTree as ET

import pytest

from tests.interfaces.cli.conftest import tltlc  # noqa: F401
from tests.runtime.cli.regressions import ONE, Run
from tests.runtime.evaluation.untrained import untrained
from tests.runtime.regression.game import NEVER, Played, edit, with_few_environments
from tests.runtime.regression.handmade import summaries
from tests.runtime.regression.recorded_game import _game, recorded_game  # noqa: F401
from tests.waiting import HANG_S
from tltl_runtime.evaluation.figures import figures_of
from tltl_runtime.policies.file import write_policy
from tltl_runtime.regression.report.retraining_result import FinishedRetraining, RetrainingResult
from tltl_runtime.regression.suite.suite import read_suite
from tltl_runtime.regression.suite_run import regress
from tltl_runtime.regression.verdict.baseline import baseline_of, read_baseline
from tltl_runtime.regression.verdict.baseline_run import record_and_write_baseline
from tltl_runtime.stealth.levels.file import load_level
from tltl_runtime.stealth.world.physics import WorldError
from tltlc.diagnostics.diagnostic import Diagnostic, TltlError

RETRAIN = ("regress", "game.toml", "--retrain", "--minutes", "0.01", *ONE)
FOLDER = "regression/game/retrained/hopeless"


@pytest.fixture(name="recorded", scope="module")
def _recorded(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A game with its baseline and the results of a first run of its suite; no player can meet the spec of one case."""
    folder = tmp_path_factory.mktemp("recorded") / "game"
    suite = read_suite(shutil.copytree(recorded_game(tmp_path_factory), folder) / "game.toml")
    (folder / "regression").mkdir()
    (folder / "run").rename(folder / "regression" / "game")
    write_policy(folder / "soon.safetensors", untrained(NEVER, str(folder / "room.toml")))
    older = read_baseline(suite.baseline)
    recorded = record_and_write_baseline(suite, suite.baseline, 1, Played(), older)
    assert len(list(recorded)) == 2
    list(regress(suite, suite.cases, baseline_of(suite), folder / "regression" / "game", 1, Played()))
    return folder


@pytest.fixture(autouse=True)
def _few_environments(monkeypatch: pytest.MonkeyPatch) -> None:
    with_few_environments(monkeypatch)


@pytest.mark.slow
def test_retraining_reports_that_no_demonstration_was_found(
    tltlc: Run,  # noqa: F811
    game: Path,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    result = tltlc(*RETRAIN, "--json", "report.json", "--junit", "report.xml")
    assert result.status == 1
    (sentence,) = (line for line in result.out.splitlines() if line.startswith("hopeless, retrained"))
    assert sentence.startswith("hopeless, retrained: no way found: neither a search of ")
    assert result.out.splitlines()[-1] == "3 cases: 2 pass, 1 fail; retrained: 1 no way found"
    reports = "--json report.json --junit report.xml --workers 1"
    again = f"tltlc regress game.toml --out regression/game {reports} --retrain --minutes "
    (longer,) = (line for line in result.out.splitlines() if line.startswith(f"    to train longer: {again}"))
    assert float(longer.removeprefix(f"    to train longer: {again}")) >= 0.02
    assert f"hopeless: a training starts from its policy; it runs for at most 0.01 minutes, in {FOLDER}" in result.err
    assert "hopeless, retrained: 25 of at most 50 episodes, 0 met the spec" in result.err
    report = json.loads(Path("report.json").read_text(encoding="utf-8"))
    assert report["complete"] is True and report["verdicts"] == {"pass": 2, "review": 0, "fail": 1}
    *passing, hopeless = report["cases"]
    assert [case["retrained"] for case in passing] == [None, None]
    assert hopeless["retrained"]["outcome"] == "no_way"
    assert f"hopeless, retrained: {hopeless['retrained']['text']}" == sentence
    assert hopeless["retrained"]["policy"] == "retrained/hopeless/policy.safetensors"
    (tests,) = ET.parse("report.xml").getroot()
    assert [element.text for element in tests.findall("testcase/system-out")][-1] == hopeless["retrained"]["text"]
    values = {element.get("name"): element.get("value") for element in tests.iter("property")}
    assert (values["hopeless.retrained"], values["hopeless.retrained_pass_rate"]) == ("no_way", "0.0000")
    page = Path("regression/game/report.html").read_text(encoding="utf-8")
    assert page.count("data:image/png;base64,") == 1 and "no way found: neither" in page

    second = tltlc(*RETRAIN, "--json", "again.json")
    assert "a training" not in second.err and "episodes" not in second.err, "all of it is kept"
    assert Path("again.json").read_bytes() == Path("report.json").read_bytes()

    plain = tltlc("regress", "game.toml", "--json", "-", *ONE)
    assert [case["retrained"] for case in json.loads(plain.out)["cases"]] == [None] * 3

    learned = Path(FOLDER, "policy.safetensors").read_bytes()
    write_policy("soon.safetensors", untrained(NEVER, "room.toml", seed=7))
    assert tltlc("baseline", "game.toml", *ONE).status == 0
    with monkeypatch.context() as patch:
        # The rest is about what happens before the training.
        patch.setattr("tltl_runtime.cli.support.retraining.train_with_display", lambda *_, **__: _worker_lost())
        third = tltlc(*RETRAIN)
    assert (
        "starts from its policy again, because the earlier one is of another level, policy, spec, seed or settings"
        in third.err
    )
    assert f"hopeless: the training that was in {FOLDER} is now in {FOLDER}-2" in third.err.splitlines()
    assert Path(f"{FOLDER}-2", "policy.safetensors").read_bytes() == learned


def test_if_all_cases_pass_nothing_is_trained(tltlc: Run, game: Path) -> None:  # noqa: F811
    text = Path("game.toml").read_text(encoding="utf-8")
    Path("game.toml").write_text(text.rpartition("[[case]]")[0], encoding="utf-8")
    result = tltlc(*RETRAIN)
    assert (result.status, Path("regression/game/retrained").exists()) == (0, False)
    _training("room-v0")
    assert tltlc(*RETRAIN, "--fresh").status == 0
    assert Path("regression/game/retrained/room-v0/policy.safetensors").exists(), "it is not trained again"


def _training(slug: str) -> None:
    """Create the files that mark a finished training."""
    folder = Path("regression/game/retrained", slug)
    folder.mkdir(parents=True)
    for name in ("run.json", "record.json", "policy.safetensors"):
        (folder / name).touch()


def _level_edited(*_: object) -> RetrainingResult:
    raise TltlError([Diagnostic("TLT0905", "`room.toml` changed while `edited` was played")])


def _left_the_level(*_: object) -> RetrainingResult:
    raise WorldError(load_level("navigation"), 3, "player", "it left")


def _no_way(*_: object) -> RetrainingResult:
    trained = FinishedRetraining("minutes", 100, 1.0, 10, False, None)
    return RetrainingResult(
        "no_way", "no way found", trained, figures_of(summaries(0, 25)), (0.0, 0.2), None, "policy", None
    )


def _worker_lost(*_: object) -> RetrainingResult:
    raise TltlError([Diagnostic("TLT0850", "a worker was lost")])


def _write_failing_cases(monkeypatch: pytest.MonkeyPatch, *outcomes: Callable[..., RetrainingResult]) -> None:
    """Write a suite of a failing case for each outcome; retraining takes no time and has these outcomes."""
    head, *_, hopeless = Path("game.toml").read_text(encoding="utf-8").split("[[case]]")
    cases = [f"[[case]]{hopeless.replace('hopeless', name)}" for name in ("edited", "left", "told")[: len(outcomes)]]
    Path("game.toml").write_text(head + "".join(cases), encoding="utf-8")
    waiting = iter(outcomes)
    monkeypatch.setattr("tltl_runtime.cli.support.retraining._train", lambda *_: None)
    monkeypatch.setattr("tltl_runtime.cli.support.retraining.retraining_result", lambda *_: next(waiting)())


def test_an_error_in_one_training_does_not_stop_the_others(
    tltlc: Run,  # noqa: F811
    game: Path,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    _write_failing_cases(monkeypatch, _level_edited, _left_the_level, _no_way)
    result = tltlc(*RETRAIN, "--json", "report.json")
    assert result.status == 1
    lines = result.err.splitlines()
    first, second = (lines.index(f"{name}: its training gave no result") for name in ("edited", "left"))
    assert lines[first + 1] == "error[TLT0905]: `room.toml` changed while `edited` was played"
    assert lines[second + 1] == "error[TLT0806]: level navigation v0, step 3, player: it left"
    assert "told, retrained: no way found" in result.out.splitlines()
    report = json.loads(Path("report.json").read_text(encoding="utf-8"))
    assert report["complete"] is False
    assert [case["retrained"] and case["retrained"]["outcome"] for case in report["cases"]] == [None, None, "no_way"]


def test_a_lost_worker_ends_the_run(
    tltlc: Run,  # noqa: F811
    game: Path,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    _write_failing_cases(monkeypatch, _worker_lost, _no_way)
    result = tltlc(*RETRAIN)
    assert "error[TLT0850]: a worker was lost" in result.err and "retrained" not in result.out


def test_fresh_moves_older_trainings_aside(
    tltlc: Run,  # noqa: F811
    game: Path,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    _write_failing_cases(monkeypatch, _worker_lost, _no_way)
    slugs = ("edited", "left")
    for slug in slugs:
        _training(slug)
    result = tltlc(*RETRAIN, "--fresh")
    folder = "regression/game/retrained"
    for slug in slugs:
        assert (
            f"{slug}: the training that was in {folder}/{slug} is now in {folder}/{slug}-2" in result.err.splitlines()
        )
        assert Path(folder, f"{slug}-2", "policy.safetensors").exists() and not Path(folder, slug).exists()


def test_a_policy_in_the_folder_of_its_training_is_reported_before_any_play(tltlc: Run, game: Path) -> None:  # noqa: F811
    Path(FOLDER).mkdir(parents=True)
    Path("soon.safetensors").rename(Path(FOLDER, "policy.safetensors"))
    edit("game.toml", '"soon.safetensors"', f'"{FOLDER}"')
    result = tltlc(*RETRAIN)
    assert (result.status, result.out) == (1, "")
    assert result.err.startswith(f"error[TLT0942]: the policy of the case `hopeless` is stored in `{FOLDER}`")


@pytest.mark.parametrize(
    ("words", "message"),
    [
        (("--minutes", "5"), "--minutes works only with --retrain"),
        (("--retrain", "--minutes", "0"), "0 is not in the range"),
    ],
)
def test_invalid_options_are_rejected(tltlc: Run, game: Path, words: tuple[str, ...], message: str) -> None:  # noqa: F811
    result = tltlc("regress", "game.toml", *words, *ONE)
    assert (result.status, result.out) == (2, "")
    assert message in re.sub(r"\s+", " ", result.err)


@pytest.mark.slow
def test_a_signal_ends_it_and_keeps_the_results(game: Path) -> None:
    command = [sys.executable, "-m", "tltlc"]
    words = [*command, "regress", "game.toml", "--retrain", "--minutes", "60", *ONE]
    with subprocess.Popen([*words, "--json", "report.json"], stderr=subprocess.PIPE, text=True) as training:
        assert training.stderr is not None
        for line in training.stderr:
            if line.startswith("searching: "):
                break
        training.send_signal(signal.SIGINT)
        _, err = training.communicate(timeout=HANG_S)
    assert training.returncode == 130
    assert (
        "stopped: all cases are judged, but 1 still needs a training; to go on: "
        "tltlc regress game.toml --out regression/game --json report.json --workers 1 --retrain --minutes 60"
    ) in err.splitlines()
    report = json.loads(Path("report.json").read_text(encoding="utf-8"))
    assert (report["complete"], len(report["cases"]), report["cases"][2]["retrained"]) == (False, 3, None)
    # Use another process: this one is patched to few environments, and a training resumes only with its own settings.
    resumed = subprocess.run([*command, *RETRAIN], capture_output=True, text=True, timeout=HANG_S, check=False)
    assert f"hopeless: a training continues; it runs for at most 0.01 minutes, in {FOLDER}" in resumed.stderr
    assert "hopeless, retrained: no way found" in resumed.stdout
