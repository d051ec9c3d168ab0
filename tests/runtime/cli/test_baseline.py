"""``tltlc baseline``: its output, its files and its errors; the policies are untrained."""

from __future__ import annotations

import signal
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import pytest

from tests.interfaces.cli.conftest import Outcome, tltlc  # noqa: F401
from tests.runtime.cli.signals import signal_at_call, with_signals  # noqa: F401
from tests.runtime.regression.game import SUITE, edit
from tests.runtime.regression.recorded_game import _game, _recorded  # noqa: F401
from tests.waiting import HANG_S
from tltl_runtime.cli.baseline import _advice
from tltl_runtime.evaluation.player import PolicyPlayer
from tltl_runtime.regression.suite.suite import Case, Thresholds
from tltl_runtime.regression.verdict.baseline import read_baseline
from tltl_runtime.support.source_hash import sources_hash

Run = Callable[..., Outcome]
ONE = ("--workers", "1")


def test_a_baseline_is_recorded(tltlc: Run, game: Path) -> None:  # noqa: F811
    before = Path("game.baseline.json").read_bytes()
    result = tltlc("baseline", "game.toml", "--output", "again.json", *ONE)
    assert result.status == 0
    assert result.out == "room:v0: easy met in 50 of 50 episodes\nroom:v0: soon met in 0 of 50 episodes\n"
    lines = result.err.splitlines()
    assert "hopeless: 50 of 50 episodes, 0 met the spec" in lines
    assert lines[-3:] == [
        "    `hopeless` is `fail` even if nothing changes: train its policy further, or lower its `pass_rate`",
        "wrote again.json",
        "to compare with it: tltlc regress game.toml --baseline again.json",
    ]
    assert Path("again.json").read_bytes() == before
    assert len(read_baseline(Path("again.json"))) == 2
    # An unwritable file is reported before anything is played.
    result = tltlc("baseline", "game.toml", "--output", "nowhere/again.json", *ONE)
    assert (result.status, result.out) == (3, "")
    assert result.err == (
        "error[TLT0005]: cannot write `nowhere/again.json`: there is no such folder\n"
        "  help: name another place with --output\n"
    )


def test_unchanged_references_are_kept_and_changes_are_reported(tltlc: Run, game: Path) -> None:  # noqa: F811
    before = Path("game.baseline.json").read_bytes()
    result = tltlc("baseline", "game.toml", *ONE)
    assert result.out == "".join(
        f"room:v0: {spec} met in {met} of 50 episodes  (as before)\n" for spec, met in (("easy", 50), ("soon", 0))
    )
    assert "of 50 episodes" not in result.err
    assert Path("game.baseline.json").read_bytes() == before
    edit("game.toml", 'name = "hopeless"', 'name = "hopeless"\nepisodes = 25')
    result = tltlc("baseline", "game.toml", *ONE)
    assert result.out.splitlines() == [
        "room:v0: easy met in 50 of 50 episodes  (as before)",
        "room:v0: soon met in 0 of 25 episodes; before: 0 of 50",
    ]
    text = Path("game.baseline.json").read_text(encoding="utf-8")
    Path("game.baseline.json").write_text(text.replace(sources_hash(), "0" * 64), encoding="utf-8")
    edit("game.toml", "episodes = 50", "episodes = 25")
    assert "as before" not in tltlc("baseline", "game.toml", *ONE).out, "other code has played them"
    edit("room.toml", "8.0, 8.0", "8.0, 8.5")
    assert tltlc("baseline", "game.toml", *ONE).out.splitlines() == [
        "room:v0: easy met in 25 of 25 episodes; before: 25 of 25",
        "room:v0: soon met in 0 of 25 episodes; before: 0 of 25",
    ]
    one_case = Path("game.toml").read_text(encoding="utf-8").partition('[[case]]\nlevel = "room.toml"\nvariant')[0]
    Path("game.toml").write_text(one_case, encoding="utf-8")
    result = tltlc("baseline", "game.toml", "--fresh", *ONE)
    assert "room:v0: 25 of 25 episodes, 25 met the spec" in result.err.splitlines()
    assert "as before" not in result.out
    Path("game.baseline.json").write_text("{}", encoding="utf-8")
    result = tltlc("baseline", "game.toml", *ONE)
    assert "before" not in result.out, "what is no baseline says nothing"
    # 25 successes are too few to be certain, so the only case cannot pass.
    assert result.status == 1
    assert result.err.endswith("none of the cases can pass with this baseline, even if nothing changes\n")


def test_a_stopped_first_baseline_reports_its_partial_file(
    tltlc: Run,  # noqa: F811
    game: Path,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    def stopped(*_: object) -> None:
        raise KeyboardInterrupt

    monkeypatch.setattr("tltl_runtime.regression.verdict.baseline_run._play_reference", stopped)
    Path("game.baseline.json").unlink()
    result = tltlc("baseline", "game.toml", *ONE)
    assert (result.status, result.out) == (130, "")
    assert result.err == (
        "stopped: `game.baseline.json` was not written; what is finished is kept in `game.baseline.json.partial`: "
        "run the same command again to continue\n"
    )
    assert Path("game.baseline.json.partial").exists()


def test_a_stopped_baseline_leaves_the_old_one(
    with_signals: Run,  # noqa: F811
    game: Path,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    before = _with_many_episodes()
    signal_at_call(monkeypatch, PolicyPlayer, "play", signal.SIGINT)
    result = with_signals("baseline", "game.toml", *ONE)
    _check_old_baseline(before, result.status, result.err)


@pytest.mark.slow
def test_a_process_that_is_stopped_leaves_the_old_baseline(game: Path) -> None:
    before = _with_many_episodes()
    command = [sys.executable, "-m", "tltlc", "baseline", "game.toml", *ONE]
    with subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True) as playing:
        assert playing.stderr is not None
        playing.stderr.readline()
        playing.send_signal(signal.SIGINT)
        _, err = playing.communicate(timeout=HANG_S)
    _check_old_baseline(before, playing.returncode, err)


def _with_many_episodes() -> bytes:
    """Give the suite more episodes than a test can wait for; return its baseline."""
    Path("game.toml").write_text(SUITE.replace("episodes = 50", "episodes = 10000"), encoding="utf-8")
    return Path("game.baseline.json").read_bytes()


def _check_old_baseline(before: bytes, status: int, err: str) -> None:
    assert status == 130
    assert "stopped: `game.baseline.json` was not changed; run the same command again to continue" in err
    assert Path("game.baseline.json").read_bytes() == before
    assert sorted(path.name for path in Path().glob(".*")) == []


@pytest.mark.parametrize("name", ["game.toml", "easy.safetensors"])
def test_inputs_of_the_suite_are_not_overwritten(tltlc: Run, game: Path, name: str) -> None:  # noqa: F811
    before = (game / name).read_bytes()
    result = tltlc("baseline", "game.toml", "-o", name)
    assert (result.status, result.out) == (3, "")
    assert result.err.startswith(
        f"error[TLT0005]: cannot write `{name}`: the suite reads it\n  help: name another place"
    )
    assert (game / name).read_bytes() == before


def test_a_baseline_is_not_written_to_standard_output(tltlc: Run, game: Path) -> None:  # noqa: F811
    result = tltlc("baseline", "game.toml", "-o", "-")
    assert (result.status, result.out) == (2, "") and "expected a file, found `-`" in result.err
    assert not Path("-").exists()


def test_the_advice_depends_on_the_pass_rate() -> None:
    case = Case("room:v0", "room", "v0", "v0", None, Path("bot"), 25, Thresholds(), "")
    assert _advice(1.0, case, 0.05) == "25 `episodes` are too few to be certain; give it at least 29"
    assert _advice(0.9, case, 0.05) == "train its policy further, lower its `pass_rate`, or give it more `episodes`"
