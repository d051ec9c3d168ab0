"""The live display of a training: it fits into terminals of any size, and its border is intact."""

from __future__ import annotations

from io import StringIO
from pathlib import Path

import pytest
from rich.console import Console

from tests.runtime.training.reports import a_report
from tests.runtime.training.runs import run_in
from tltl_runtime.cli.support.training_picture import TrainingDisplay
from tltl_runtime.training.exploration.search import SearchProgress
from tltl_runtime.training.files.report import TrainingReport
from tltlc.core.record import replace

SEARCHED = SearchProgress(steps=6400, replayed=3200, seconds=80.0, places=1200, lengths=(90, 80), complete=True)


def _lines(folder: Path, columns: int, lines: int, report: TrainingReport | SearchProgress | None) -> list[str]:
    console = Console(width=columns, height=lines, file=StringIO(), force_terminal=True, color_system=None)
    run = run_in(folder, exploration__ways=10, stop__steps=12_000_000)
    picture = TrainingDisplay(run, console)
    if isinstance(report, TrainingReport):
        picture.show_report(report)
    elif report is not None:
        picture.show_search(report)
    with console.capture() as captured:
        console.print(picture.picture())
    return captured.get().splitlines()


@pytest.fixture(name="report")
def _report() -> TrainingReport:
    return replace(a_report(2000, states={0: 0.5, 1: 0.2, 3: 0.1, 4: 0.2}), searched=SEARCHED, checkpointed=True)


@pytest.mark.parametrize(("columns", "lines"), [(80, 24), (80, 18), (80, 15), (120, 40), (101, 24)])
def test_the_display_fits_and_no_figure_is_cut_off(
    tmp_path: Path, report: TrainingReport, columns: int, lines: int
) -> None:
    shown = _lines(tmp_path / ("very-" * 20 + "long"), columns, lines, report)
    assert len(shown) < lines
    # The width leaves four columns, since pressing Ctrl-C twice prints `^C^C` after the border.
    assert {len(line) for line in shown} == {min(100, columns - 4)}
    text = "\n".join(shown)
    for part in (
        "cover_and_hide on cover_and_hide:v0, seed 3",
        "of 100, then the policy is confirmed",
        "reward 0.65, 130 steps an episode; best so far: met in 80%",
        "8,192,000 of at most 12,000,000 steps, 2,048 a second (25% learning)",
        "1 h 6 min so far, at most 3",
        "search: 2 ways found in 1 min 20 s, the shortest of 80 steps",
        "last checkpoint 0 s ago; Ctrl-C writes one to continue from",
        "state 0",
    ):
        assert part in text
    assert shown[-1].endswith("-very-long ─╯")


def test_in_a_low_terminal_the_most_frequent_states_are_shown(tmp_path: Path, report: TrainingReport) -> None:
    text = "\n".join(_lines(tmp_path, 80, 15, report))
    assert "where the last 50 episodes ended (3 of 4 states)" in text
    assert [number for number in range(5) if f"state {number}" in text] == [0, 1, 4]


def test_violations_are_shown_at_the_state_before(tmp_path: Path, report: TrainingReport) -> None:
    text = "\n".join(_lines(tmp_path, 120, 40, report))
    assert "20%   15% violated: Reach near(s2), then near(exit)" in text
    assert "The spec is violated." not in text


def test_before_the_first_iteration_the_search_is_shown(tmp_path: Path) -> None:
    assert "playing the first steps" in _lines(tmp_path, 80, 24, None)[1]
    text = " ".join(line.strip("│ ") for line in _lines(tmp_path, 80, 24, SEARCHED))
    assert "1,200 places, 2 of 10 ways to meet the spec, the shortest of 80 steps" in text


def test_before_the_first_checkpoint_ctrl_c_is_explained(tmp_path: Path, report: TrainingReport) -> None:
    text = "\n".join(_lines(tmp_path, 80, 24, replace(report, checkpointed=False)))
    assert "no checkpoint yet; Ctrl-C writes one to continue from" in text


def test_a_search_without_demonstrations_is_shown(tmp_path: Path, report: TrainingReport) -> None:
    nothing = replace(report, searched=replace(SEARCHED, lengths=()))
    text = "\n".join(_lines(tmp_path, 80, 24, nothing))
    assert "search: no way found in 1 min 20 s; episodes begin at the level's start" in text


def test_a_game_file_may_change_while_its_scene_is_trained(
    tmp_path: Path, report: TrainingReport, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    file = Path("pole.game.toml")
    file.write_text('[game]\ngymnasium = "CartPole-v1"\n\n[[scene]]\nname = "short"\n')
    console = Console(width=100, height=24, file=StringIO())
    display = TrainingDisplay(replace(run_in(tmp_path), level=str(file)), console)
    file.write_text("[game")
    display.show_report(report)
    with console.capture() as captured:
        console.print(display.picture())
    assert "pole.game.toml:short:v0, seed 3" in captured.get()
