"""TLT0422: imports of which nothing is used."""

from __future__ import annotations

from tests.lint.helpers import codes


def test_an_import_may_count_without_being_named(tmp_path, monkeypatch) -> None:  # type: ignore[no-untyped-def]
    monkeypatch.chdir(tmp_path)
    (tmp_path / "rules.tltl").write_text("clock 10 Hz\n")
    (tmp_path / "idle.tltl").write_text("signal z: bool\n")
    assert codes("import rules\nimport idle\nsignal a: bool\nspec s { limit 3 s reach a }") == ["TLT0422"]
