"""Diagnostics that are published at once, and those that need the automata."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.interfaces.lsp.texts import EXAMPLES, open_text
from tltlc.core.source import SourceFile
from tltlc.diagnostics.diagnostic import TltlError
from tltlc.interfaces.lsp.diagnostics import protocol_diagnostic
from tltlc.interfaces.lsp.edits import apply_edits, difference
from tltlc.interfaces.lsp.formatting import formatting
from tltlc.interfaces.lsp.slow_analysis import Request, analyse
from tltlc.interfaces.lsp.symbols import symbols
from tltlc.io.files import is_file, read_source, unsaved_texts


def test_proofs_of_predicates_are_made_in_the_analysis() -> None:
    document, _, _ = open_text("signal n: ratio\npredicate p in [-1, 1] = 3 * n\nspec a = F p\n")
    assert document.diagnostics == ()
    analysis = analyse(Request(document.source, (), {}, {}))
    assert [finding.diagnostic.code for finding in analysis.findings] == ["TLT0306"]
    assert analysis.figures == ()


def test_a_syntax_error_hides_no_other_error() -> None:
    document, _, _ = open_text("import stealth\nspec a = G alive )\nspec b = F neer\n")
    assert [diagnostic.code for diagnostic in document.diagnostics] == ["TLT0105", "TLT0201"]


def test_a_comment_cannot_hide_an_error() -> None:
    document, _, _ = open_text("signal a: bool\nspec x = F b // tltlc: allow TLT0201\n")
    assert [diagnostic.code for diagnostic in document.diagnostics] == ["TLT0201"]


WHOLE = """\
clock 20 Hz
import stealth
entity s1, exit
let calm = always hidden
spec leave { limit 9 s  reach near(s1) then near(exit)  keep calm }
test "t" for leave { step near(s1)  expect pending }
"""


@pytest.mark.parametrize(
    ("read", "unread"),
    [
        ("reach near(s1) then", "reach near(s1) then then"),
        ("let calm =", "let calm"),
        ("spec leave {", "spec leave"),
        ("import stealth", "import"),
        ("entity s1", "entity , s1"),
        ("clock 20 Hz", "clock"),
        ("expect pending", "expect"),
    ],
)
def test_a_syntax_error_makes_no_names_undefined_elsewhere(read: str, unread: str) -> None:
    text = WHOLE.replace("clock 20 Hz\n", "").replace("9 s", "9 steps") if "clock" not in read else WHOLE
    whole, _, _ = open_text(text)
    assert whole.diagnostics == ()
    document, _, _ = open_text(text.replace(read, unread))
    assert len(document.diagnostics) == 1
    # A name that is declared nowhere is still reported, unless the broken part may declare any name.
    document, _, _ = open_text(text.replace(read, unread) + "spec b = F neer\n")
    assert [diagnostic.code for diagnostic in document.diagnostics][1:] == (
        [] if unread in ("import", "entity , s1") else ["TLT0201"]
    )


def test_errors_in_tests_are_reported_beside_a_syntax_error() -> None:
    document, _, _ = open_text(f'let let\n{WHOLE}test "u" for leave {{ expect progress > 2  expect pending }}\n')
    assert [diagnostic.code for diagnostic in document.diagnostics] == ["TLT0106", "TLT0217"]


def test_levels_of_the_project_silence_findings() -> None:
    text = "signal n: ratio\npredicate p = when n > 0: 1 otherwise: -1\nspec a { limit 3 steps reach p }"
    findings = analyse(Request(SourceFile("/nowhere/a.tltl", text), (), {}, {})).findings
    assert {"TLT0402"} <= {finding.diagnostic.code for finding in findings}
    levels = {finding.diagnostic.code: "allow" for finding in findings}
    assert analyse(Request(SourceFile("/nowhere/a.tltl", text), (), levels, {})).findings == ()
    # This also holds beside errors.
    wrong = SourceFile("/nowhere/a.tltl", f"{text}\npredicate q in [-1, 1] = 3 * n\n")
    assert [diagnostic.code for diagnostic in analyse(Request(wrong, (), levels, {})).diagnostics] == ["TLT0306"]


def test_examples_have_figures_and_no_errors() -> None:
    for path in EXAMPLES:
        source = read_source(path)
        analysis = analyse(Request(source, (), {}, {}))
        assert not [finding for finding in analysis.findings if finding.diagnostic.severity == "error"]
        assert analysis.failures == ()
        assert sum(figures.passed for figures in analysis.figures) > 0


def test_unsaved_texts_are_read(tmp_path: Path) -> None:
    saved, fresh = tmp_path / "saved.tltl", tmp_path / "fresh.tltl"
    saved.write_text("entity a\n", encoding="utf-8")
    with unsaved_texts({str(saved): "entity b\n", str(fresh): "entity c\n"}):
        assert read_source(saved).text == "entity b\n"
        assert read_source(tmp_path / "x" / ".." / "fresh.tltl").text == "entity c\n"
        assert is_file(fresh)
    assert read_source(saved).text == "entity a\n"
    assert not is_file(fresh)


def test_a_difference_is_a_single_edit() -> None:
    source = SourceFile("a.tltl", "signal a:bool\r\nspec s = G a\r\n")
    edits = difference(source, "signal a: bool\nspec s = always a\n")
    assert apply_edits(source.text, edits) == "signal a: bool\r\nspec s = always a\r\n"
    assert difference(source, source.text) == []
    assert source.text[edits[0].span.start :].startswith("bool")


def test_a_text_with_syntax_errors_is_not_formatted() -> None:
    document, _, _ = open_text("spec a = G (")
    assert formatting(document, "utf-16") is None


def test_the_outline_nests_clauses_in_their_spec() -> None:
    document, _, _ = open_text(
        "import stealth\nentity s1, s2\nspec a { reach near(s1) keep alive }\n"
        'test "t" for a { step alive expect pending }'
    )
    outline = symbols(document, "utf-16")
    assert [symbol.name for symbol in outline] == ["stealth", "s1", "s2", "a", "t"]
    assert [child.name for child in outline[3].children or ()] == ["reach near(s1)", "keep alive"]
    for symbol in outline:
        assert symbol.range.start <= symbol.selection_range.start
        assert symbol.selection_range.end <= symbol.range.end


def test_removable_code_is_shown_faded() -> None:
    document, _, _ = open_text(
        "import stealth\nsignal unused: bool\nsignal a: bool\nspec s {\n    limit 3 steps\n    keep a\n    keep a\n"
        "    require always eventually a\n}\n"
    )
    findings = analyse(Request(document.source, (), {}, {})).findings
    faded = {
        finding.diagnostic.code
        for finding in findings
        if protocol_diagnostic(finding.diagnostic, document, "utf-16", str).tags
    }
    assert faded == {"TLT0421", "TLT0422", "TLT0425"}
    # The fix of each of these findings only removes text.
    for finding in findings:
        if finding.diagnostic.code in faded:
            assert not any(edit.text for edit in finding.fix)
    assert "TLT0424" in {finding.diagnostic.code for finding in findings}


def test_a_layout_over_the_size_limit_is_rejected() -> None:
    document, _, _ = open_text("spec a {\n" + "//c\n" * 200_000 + "require true }\n")
    with pytest.raises(TltlError, match="would have more than 1 MiB"):
        formatting(document, "utf-16")
