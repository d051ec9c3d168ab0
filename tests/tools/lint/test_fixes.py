"""Fixes that editors and the playground offer for single findings."""

from __future__ import annotations

from collections.abc import Sequence

import pytest

from tltlc.core.source import SourceFile
from tltlc.diagnostics.diagnostic import Diagnostic, Edit
from tltlc.grammar.module import Module
from tltlc.grammar.parser import parse
from tltlc.pipeline import CompileOptions, Session
from tltlc.tools.lint.fixes import OfferedFix, fixes_of_errors, fixes_of_findings
from tltlc.tools.lint.run import findings, lint, view_of
from tltlc.tools.lint.scopes import apply_edits, preserve_scopes


def errors(source: SourceFile) -> tuple[Sequence[Diagnostic], Sequence[Diagnostic]]:
    session = Session(source)
    return session.syntax_errors, session.source_diagnostics


def offers(text: str) -> list[OfferedFix]:
    source = SourceFile("x.tltl", text)
    return list(fixes_of_errors(errors(source)[1], source, errors))


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("spec x { kepe alive }", {"Write `keep`": "spec x { keep alive }"}),
        ("spec x = F alive", {"Add `import stealth`": "import stealth\nspec x = F alive"}),
        (
            "/// Loud.\r\nspec x = F loud",
            {"Declare `signal loud: bool`": "signal loud: bool\r\n/// Loud.\r\nspec x = F loud"},
        ),
        (
            "import core spec x {\n    keep loud\n}",
            {"Declare `signal loud: bool`": "import core\nsignal loud: bool\n spec x {\n    keep loud\n}"},
        ),
        ("signal a: bool\nspec x = F a &", {}),
    ],
)
def test_fixes_of_errors_are_offered(text: str, expected: dict[str, str]) -> None:
    source = SourceFile("x.tltl", text)
    assert {offer.fix.title: apply_edits(source, offer.fix.edits).text for offer in offers(text)} == expected


def test_a_fix_that_leaves_as_many_errors_is_not_offered() -> None:
    # The errors stay the same after every edit, so no fix helps.
    source = SourceFile("x.tltl", "spec x = F alive")
    _, diagnostics = errors(source)
    assert diagnostics[0].fixes
    assert list(fixes_of_errors(diagnostics, source, lambda _: ((), diagnostics))) == []


def test_the_title_of_a_fix_says_what_it_removes() -> None:
    source = SourceFile("x.tltl", "import core\nsignal a: bool\nentity e\nspec x = F a")
    assert [offer.fix.title for offer in fixes_of_findings(lint(source), parse(source)[0])] == [
        "Remove the import",
        "Remove it",
    ]


def test_a_fix_keeps_the_allow_comment_of_another_statement() -> None:
    allow = "// tltlc: allow TLT0419\n"
    source = SourceFile(
        "x.tltl", f"/// Old.\n{allow}import core\nsignal a: bool\nspec x {{\n    judge at goal\n    reach a\n}}\n"
    )
    (offer,) = fixes_of_findings(lint(source), parse(source)[0])
    assert (
        apply_edits(source, offer.fix.edits).text
        == f"{allow}signal a: bool\nspec x {{\n    judge at goal\n    reach a\n}}\n"
    )


def test_the_same_fix_of_many_findings_is_tried_once(monkeypatch: pytest.MonkeyPatch) -> None:
    tried: list[Sequence[Edit]] = []

    def record_attempt(module: Module, edits: Sequence[Edit]) -> tuple[Edit, ...] | None:
        tried.append(edits)
        return preserve_scopes(module, edits)

    monkeypatch.setattr("tltlc.tools.lint.fixes.preserve_scopes", record_attempt)
    source = SourceFile("example.tltl", f"// tltlc: allow{' TLT0421' * 50}\nsignal a: bool\nspec s = F a\n")
    view = view_of(source, CompileOptions())
    comment_findings = [finding for finding in findings(view) if finding.diagnostic.code == "TLT0427"]
    assert (len(list(fixes_of_findings(comment_findings, view.module))), len(tried)) == (50, 1)


def test_no_more_fixes_are_tried_after_the_limit(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("tltlc.tools.lint.fixes.WORK", {"fixes tried": 5})
    count = 9
    lets = "".join(f"let l{number} = F a\n" for number in range(count))
    source = SourceFile("example.tltl", f"signal a: bool\nspec s = F a  // tltlc: allow TLT0420\n{lets}")
    view = view_of(source, CompileOptions())
    unused_findings = [finding for finding in findings(view) if finding.diagnostic.code == "TLT0421"]
    assert (len(unused_findings), len(list(fixes_of_findings(unused_findings, view.module)))) == (count, 5)
