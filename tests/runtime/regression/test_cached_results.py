"""The cache of results between runs, and when it is not used."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests import pipes
from tests.runtime.regression.handmade import a_summary
from tltl_runtime.regression.suite.result_cache import cache_text, inputs_hash, read_cache
from tltl_runtime.spec.episode_summary import EpisodeSummary

EPISODES = (a_summary(True, 1.0, 0.5), a_summary(False, 0.25, -0.75))
KIND = tuple[EpisodeSummary, ...]


def test_a_cached_result_is_used_while_its_inputs_are_unchanged(tmp_path: Path) -> None:
    path, inputs = tmp_path / "kept.json", inputs_hash(["level", 3])
    path.write_text(cache_text(inputs, EPISODES), encoding="utf-8")
    assert read_cache(KIND, path, inputs) == EPISODES
    assert read_cache(KIND, path, inputs_hash(["level", 4])) is None


def test_a_pipe_is_not_read_as_a_cache(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    pipes.put_beside(tmp_path / "kept.json")
    pipes.forbid(monkeypatch)
    assert read_cache(KIND, tmp_path / "kept.json", inputs_hash([1])) is None


def test_a_change_of_the_code_changes_the_hash(monkeypatch: pytest.MonkeyPatch) -> None:
    before = inputs_hash([1])
    assert before == inputs_hash([1])
    monkeypatch.setattr("tltl_runtime.regression.suite.result_cache.sources_hash", lambda: "0" * 64)
    assert inputs_hash([1]) != before


@pytest.mark.parametrize(
    "text",
    [
        "",
        "[]",
        "3",
        "[" * 100_000,
        "\xff",
        '{"identity": "a"}',
        '{"content": []}',
        '{"identity": "a", "content": 3}',
        '{"identity": "a", "content": [{"success": 1, "progress": 1.0, "reward": 0.5}]}',
        '{"identity": "b", "content": []}',
        None,
    ],
)
def test_an_invalid_cache_file_is_ignored(tmp_path: Path, text: str | None) -> None:
    path = tmp_path / "kept.json"
    if text is not None:
        path.write_bytes(text.encode("latin-1"))
    assert read_cache(KIND, path, "a") is None
