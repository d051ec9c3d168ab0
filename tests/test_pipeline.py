"""The stages of the compiler for one text, in a session."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from tltlc import pipeline
from tltlc.core.source import SourceFile
from tltlc.diagnostics.diagnostic import Diagnostic, TltlError
from tltlc.pipeline import CompileOptions, Session, compile_source

TWO_SPECS = "signal a: bool\nspec first = F a\nspec second = G a\n"


def session_of(text: str, options: CompileOptions | None = None, *, proofs: bool = True) -> Session:
    return Session(SourceFile("a.tltl", text), options, proofs=proofs)


def codes(diagnostics: tuple[Diagnostic, ...]) -> list[str]:
    return [diagnostic.code for diagnostic in diagnostics]


def raised(use: Callable[[], object]) -> list[str]:
    """Return the codes of the diagnostics that are raised."""
    with pytest.raises(TltlError) as error:
        use()
    return codes(error.value.diagnostics)


def test_each_stage_runs_once(monkeypatch: pytest.MonkeyPatch) -> None:
    runs: list[str] = []

    def counted(name: str) -> None:
        stage = getattr(pipeline, name)

        def run(*arguments: Any, **options: Any) -> Any:
            runs.append(name)
            return stage(*arguments, **options)

        monkeypatch.setattr(pipeline, name, run)

    for name in ("parse", "resolve", "build"):
        counted(name)
    session = session_of(TWO_SPECS)
    assert runs == []
    for _ in range(2):
        assert len(session.module.declarations) == 3
        assert session.syntax_errors == session.source_diagnostics == ()
        assert [spec.name for spec in session.specs] == ["first", "second"]
        assert [fspa.name for fspa in session.automata] == ["first", "second"]
        assert session.compiled().automata == session.automata
    assert runs == ["parse", "resolve", "build", "build"]


def test_a_session_compiles_like_compile_source() -> None:
    options = CompileOptions(specs=("second",))
    session = session_of(TWO_SPECS, options)
    assert session.compiled() == compile_source(session.source, options)
    assert [spec.name for spec in session.program.specs] == ["first", "second"]
    assert [fspa.name for fspa in session.automata] == ["second"]


def test_names_are_resolved_in_a_text_with_a_syntax_error() -> None:
    session = session_of("signal a: bool\nspec broken = F a &\nspec whole = F a and b\n")
    assert len(session.module.declarations) == 2
    assert "a" in session.resolution.env.scope.names
    syntax = codes(session.syntax_errors)
    assert syntax
    assert codes(session.source_diagnostics) == [*syntax, "TLT0201"]
    for use in (lambda: session.program, lambda: session.specs, lambda: session.automata, session.compiled):
        assert raised(use) == [*syntax, "TLT0201"]


def test_no_automaton_is_built_for_a_text_with_a_syntax_error(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.delattr(pipeline, "build")
    session = session_of("signal a: bool\nspec s = F a &\n")
    for use in (lambda: session.program, lambda: session.diagnostics, lambda: session.automata, session.compiled):
        assert raised(use) == codes(session.syntax_errors)


def test_no_automaton_is_built_for_a_text_with_an_error_in_a_name(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.delattr(pipeline, "build")
    session = session_of("signal a: bool\nspec s = F a and b\n")
    assert raised(lambda: session.automata) == codes(session.source_diagnostics) == ["TLT0201"]


def test_a_spec_that_does_not_exist_is_reported_before_anything_is_built(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.delattr(pipeline, "build")
    session = session_of(TWO_SPECS, CompileOptions(specs=("third",)))
    assert len(session.program.specs) == 2
    assert raised(lambda: session.automata) == ["TLT0720"]


def test_silenced_warnings_are_reported_apart() -> None:
    session = session_of("signal a: bool\nspec s = F a and G !a  // tltlc: allow TLT0410\n")
    assert codes(session.reported) == ["TLT0410"]
    assert session.diagnostics == session.compiled().diagnostics == ()


def test_a_text_that_needs_too_many_states_reports_every_spec() -> None:
    session = session_of(TWO_SPECS, CompileOptions(state_budget=1))
    assert len(session.specs) == 2
    assert raised(lambda: session.automata) == codes(session.diagnostics) == ["TLT0501", "TLT0501"]


def test_a_session_without_proofs_does_not_check_predicates() -> None:
    text = "signal x in [0, 10]\npredicate p in [-1, 1] =\n    when x < 5: x / 5 - 1\n    otherwise: 1\nspec s = F p\n"
    assert codes(session_of(text).source_diagnostics) == ["TLT0402"]
    assert session_of(text, proofs=False).source_diagnostics == ()


def test_a_session_reads_imports_from_the_libraries_of_its_options(tmp_path: Path) -> None:
    (tmp_path / "seen.tltl").write_text("signal seen: bool\n", encoding="utf-8")
    text = "import seen\nspec hide = G !seen\n"
    session = session_of(text, CompileOptions(library_dirs=(tmp_path,)))
    assert [loaded.title for loaded in session.resolution.modules] == ["seen", "a"]
    assert len(session.automata) == 1
