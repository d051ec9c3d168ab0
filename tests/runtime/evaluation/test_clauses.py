"""The clauses that a failed episode broke or did not meet, as the designer wrote them."""

from __future__ import annotations

from pathlib import Path

import pytest

from tltl_runtime.evaluation.clauses import clause_judge
from tltlc import compile_text

SPEC = """\
signal x: length in [0 m, 10 m]
signal fell: bool
param far: length in [1 m, 10 m] = 5 m
spec go { limit 9 steps  reach x >= 700 cm  keep x < far  avoid fell  require always (fell implies next x > 1 m) }
"""


def test_clauses_are_named_as_their_source_has_them(tmp_path: Path) -> None:
    (fspa,) = compile_text(SPEC)
    file = tmp_path / "go.tltl"
    file.write_text(SPEC)
    names = [part.text for part in clause_judge(fspa, {}, f"{file}:go").clauses.parts]
    assert names[:3] == ["reach x >= 700 cm", "keep x < far", "avoid fell"]


@pytest.mark.parametrize("source", [None, "missing.tltl", "other.tltl"])
def test_without_their_source_clauses_are_named_in_words(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, source: str | None
) -> None:
    monkeypatch.chdir(tmp_path)
    Path("other.tltl").write_text(SPEC.replace("700", "800"))
    (fspa,) = compile_text(SPEC)
    names = [part.text for part in clause_judge(fspa, {}, source).clauses.parts]
    assert names[:3] == ["reach x >= 7", "keep far > x", "avoid fell"]


def test_params_have_the_values_of_the_episodes() -> None:
    (fspa,) = compile_text(SPEC)
    sample = {"x": 3.0, "fell": 0.0}
    for far, clauses in ((2.0, ("keep far > x",)), (4.0, ("reach x >= 7",))):
        cause = clause_judge(fspa, {"far": far}, None).judge().verdict([sample]).cause
        assert cause is not None and cause.clauses == clauses


def test_a_sample_alone_shows_which_unchanging_clauses_it_breaks() -> None:
    (fspa,) = compile_text(SPEC)
    judge = clause_judge(fspa, {}, None)
    atoms = {atom.name: -0.5 for atom in fspa.atoms}
    assert judge.broken({**atoms, "far > x": 0.5}) == ()
    assert judge.broken({**atoms, "far > x": 0.5, "fell": 1.0}) == ("avoid fell",)
    assert judge.broken({**atoms, "fell": 1.0}) == ("keep far > x", "avoid fell")
