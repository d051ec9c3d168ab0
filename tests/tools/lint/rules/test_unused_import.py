"""TLT0422: imports that are not used."""

from __future__ import annotations

from tests.calls import calls
from tests.tools.lint.helpers import codes
from tltlc.core.source import SourceFile
from tltlc.pipeline import CompileOptions
from tltlc.tools.lint.rules.unused_import import RULE
from tltlc.tools.lint.run import view_of


def test_an_import_of_a_clock_counts_as_used(tmp_path, monkeypatch) -> None:  # type: ignore[no-untyped-def]
    monkeypatch.chdir(tmp_path)
    (tmp_path / "rules.tltl").write_text("clock 10 Hz\n")
    (tmp_path / "idle.tltl").write_text("signal z: bool\n")
    assert codes("import rules\nimport idle\nsignal a: bool\nspec s { limit 3 s reach a }") == ["TLT0422"]


def test_an_import_that_narrows_a_signal_counts_as_used(tmp_path, monkeypatch) -> None:  # type: ignore[no-untyped-def]
    monkeypatch.chdir(tmp_path)
    (tmp_path / "wide.tltl").write_text("signal x: number\npredicate big = clamp((x - 50) / 100, -1, 1)\n")
    (tmp_path / "narrow.tltl").write_text("signal x in [0, 60]\nlet other = x > 5\n")
    (tmp_path / "another.tltl").write_text("signal y in [0, 60]\nlet more = y > 5\n")
    text = "import wide\nimport {}\nspec s {{ limit 5 steps reach big }}"
    assert codes(text.format("narrow")) == []
    assert codes(text.format("another")) == ["TLT0422"]


def test_the_work_is_linear_in_the_files_of_a_chain_of_imports(tmp_path, monkeypatch) -> None:  # type: ignore[no-untyped-def]
    monkeypatch.chdir(tmp_path)
    text = "import m0\nsignal a: bool\nspec s { limit 3 steps reach a }"

    def work(files: int) -> int:
        for i in range(files):
            (tmp_path / f"m{i}.tltl").write_text(f"import m{i + 1} (z)\nimport m{i + 1} (z)\n")
        (tmp_path / f"m{files}.tltl").write_text("signal z: bool\n")
        view = view_of(SourceFile("example.tltl", text), CompileOptions())
        return calls(lambda: list(RULE.check(view)))

    assert work(20) < 3 * work(10)


def test_the_work_is_linear_in_the_imports_of_one_file(tmp_path, monkeypatch) -> None:  # type: ignore[no-untyped-def]
    monkeypatch.chdir(tmp_path)
    (tmp_path / "many.tltl").write_text(f"entity {', '.join(f'e{i}' for i in range(100))}\nsignal at(x): bool\n")

    def work(imports: int) -> int:
        lines = "".join(f"import many as m{i}\n" for i in range(imports))
        text = f"{lines}spec s {{ limit 3 steps reach m7.at(m7.e0) }}"
        view = view_of(SourceFile("example.tltl", text), CompileOptions())
        reported = list(RULE.check(view))
        assert len(reported) == imports - 1
        return calls(lambda: list(RULE.check(view)))

    assert work(200) < 3 * work(100)


def test_import_aliases_may_contain_dots(tmp_path, monkeypatch) -> None:  # type: ignore[no-untyped-def]
    monkeypatch.chdir(tmp_path)
    (tmp_path / "rules.tltl").write_text("signal z: bool\nsignal y: bool\n")
    spec = "spec s { limit 3 steps reach a.b.z }"
    assert codes(f"import rules as a.b\n{spec}") == []
    assert codes(f"import rules as a.b\nimport rules as a.bc\nimport rules as a.a\n{spec}") == ["TLT0422", "TLT0422"]
    assert codes("import rules (z, y)\nimport rules as r\nspec s { limit 3 steps reach z }") == ["TLT0422", "TLT0422"]
