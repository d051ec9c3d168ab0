"""Our Table I: played cells are cached, and the rows stand beside the rows of the paper."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from tests.runtime.evaluation.deadly import kill_this_process
from tests.runtime.policies.examples import card_of, policy_of
from tests.runtime.regression.handmade import a_summary
from tltl_runtime.evaluation.player import EpisodeRequest, PlayedEpisode
from tltl_runtime.evaluation.statistics import Spread
from tltl_runtime.policies.file import write_policy
from tltl_runtime.regression.table1 import table_cells
from tltl_runtime.regression.table1.paper_table import LEVELS, MODELS, PAPER, VARIANTS, CellFigures, TableRow, markdown
from tltl_runtime.regression.table1.table_cells import cell_episodes, figures
from tltl_runtime.spec.episode_summary import EpisodeSummary
from tltlc.diagnostics.diagnostic import TltlError


@pytest.fixture(name="few", autouse=True)
def _few(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(table_cells, "EPISODES", 3)


def test_the_paper_has_a_row_for_each_model_and_level() -> None:
    assert set(PAPER) == {(level, model) for level in LEVELS for model in MODELS}
    assert all(tuple(row.figures) == VARIANTS for row in PAPER.values())
    assert {model for (_, model), row in PAPER.items() if row.hours is None} == {"expert"}


def test_our_row_stands_above_the_row_of_the_paper() -> None:
    cell = CellFigures(100, 0.95, Spread(0.97, 0.1), Spread(0.6, 0.2))
    text = markdown({("navigation", "ours"): TableRow({"v0": cell}, 0.1)})
    assert text.splitlines()[2:] == [
        "| navigation | ours | 0.95 (0.89–0.98) | 0.97 ± 0.10 | 0.60 ± 0.20 | 6 min |",
        "|  | *the paper: ours* | 1.00 / 0.90 / 0.00 | 1.00 ± 0.00 / 0.93 ± 0.21 / 0.49 ± 0.05 "
        "| 0.64 ± 0.01 / 0.39 ± 0.37 / -0.51 ± 0.05 | 3.5 h |",
    ]


@pytest.mark.parametrize(
    ("hours", "cloned", "shown"),
    [
        (None, None, "–"),
        (0.0999, None, "6 min"),
        (1.0, None, "1.0 h"),
        (1.2345678, None, "1.2 h"),
        (0.5, 0.0512, "30 min, 5.1 % cloned"),
        (20.0, 0.0, "20.0 h, 0.0 % cloned"),
    ],
)
def test_the_duration_of_a_training_is_shown(hours: float | None, cloned: float | None, shown: str) -> None:
    cell = CellFigures(100, 0.95, Spread(0.97, 0.1), Spread(0.6, 0.2))
    ours = markdown({("navigation", "imitation"): TableRow({"v0": cell}, hours, cloned)}).splitlines()[2]
    assert ours.endswith(f"| {shown} |")


def test_figures_cover_the_first_runs() -> None:
    cell = (a_summary(True, 1.0, 0.5), a_summary(False, 0.5, -0.5), a_summary(True, 1.0, 0.7))
    cell_figures = figures(cell, 2)
    assert (cell_figures.runs, cell_figures.pass_rate, cell_figures.progress.mean, cell_figures.reward.mean) == (
        2,
        0.5,
        0.75,
        0.0,
    )
    assert cell_figures.progress.std == pytest.approx(0.35355, abs=1e-4)


def test_a_cell_is_cached_until_the_policy_changes(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    path = tmp_path / "policy.safetensors"
    write_policy(path, policy_of(card_of()))
    cell = cell_episodes(tmp_path, "ours", "cover_and_hide", "v0", path, 1)
    assert len(cell) == 3
    with monkeypatch.context() as patched:
        patched.setattr(table_cells, "evaluate", lambda *_, **__: pytest.fail("it is played again"))
        assert cell_episodes(tmp_path, "ours", "cover_and_hide", "v0", path, 1) == cell
    kept = tmp_path / "cover_and_hide-v0-ours.json"
    before = kept.read_bytes()
    write_policy(path, policy_of(card_of(), seed=1))
    cell_episodes(tmp_path, "ours", "cover_and_hide", "v0", path, 1)
    assert kept.read_bytes() != before


@pytest.mark.slow
@pytest.mark.slow
def test_the_expert_plays_the_same_in_any_number_of_processes(tmp_path: Path) -> None:
    one_process = cell_episodes(tmp_path, "expert", "cover_and_hide", "v0", None, 1)
    assert [episode.success for episode in one_process] == [True] * 3
    (tmp_path / "several").mkdir()
    assert cell_episodes(tmp_path / "several", "expert", "cover_and_hide", "v0", None, 2) == one_process


class Mortal(table_cells._ExpertPlayer):
    """A player that kills its process in its first episode."""

    def play(self, request: EpisodeRequest) -> PlayedEpisode:
        kill_this_process()
        return super().play(request)


@pytest.mark.slow
def test_a_lost_process_of_the_expert_is_reported(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(table_cells, "_ExpertPlayer", Mortal)
    with pytest.raises(TltlError, match="TLT0850: a worker was lost while it played episode") as error:
        list(table_cells._expert_episodes("cover_and_hide", "v0", 2))
    seed_match = re.search(r"\(seed (\d+) of the level\)", str(error.value))
    assert seed_match is not None
    (diagnostic,) = error.value.diagnostics
    assert diagnostic.help == f"to play only that episode: tltlc demonstrate cover_and_hide:v0 --seed {seed_match[1]}"


def test_the_expert_plays_again_when_the_spec_or_the_code_changes(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    played: list[str] = []

    def play(level: str, variant: str, pool: object) -> list[EpisodeSummary]:
        played.append(f"{level}:{variant}")
        return [a_summary(True, 1.0, 0.5)]

    monkeypatch.setattr(table_cells, "_expert_episodes", play)

    def count() -> int:
        """Measure the cell again; return how often the expert has played so far."""
        assert cell_episodes(tmp_path, "expert", "cover_and_hide", "v0", None, 1) == (a_summary(True, 1.0, 0.5),)
        return len(played)

    assert (count(), count()) == (1, 1)
    with monkeypatch.context() as patched:
        patched.setattr("tltl_runtime.regression.suite.result_cache.sources_hash", lambda: "another")
        assert count() == 2
    spec = tmp_path / "bold.tltl"
    spec.write_text("import stealth\nentity exit\nspec bold { limit 400 steps\n reach near(exit) }\n", encoding="utf-8")
    with monkeypatch.context() as patched:
        patched.setattr(table_cells, "default_spec", lambda level: str(spec))
        assert count() == 3


def test_a_policy_for_another_spec_is_rejected(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    path = tmp_path / "policy.safetensors"
    write_policy(path, policy_of(card_of()))
    spec = tmp_path / "bold.tltl"
    spec.write_text("import stealth\nentity exit\nspec bold { limit 400 steps\n reach near(exit) }\n", encoding="utf-8")
    monkeypatch.setattr(table_cells, "default_spec", lambda level: str(spec))
    with pytest.raises(TltlError, match="TLT0843"):
        cell_episodes(tmp_path, "ours", "cover_and_hide", "v0", path, 1)
