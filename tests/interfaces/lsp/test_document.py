"""What is said at once, and what waits for the automata."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.interfaces.lsp.texts import EXAMPLES, opened
from tltlc.core.source import SourceFile
from tltlc.diagnostics.diagnostic import TltlError
from tltlc.interfaces.lsp.analysis import Request, analyse
from tltlc.interfaces.lsp.diagnostics import remark
from tltlc.interfaces.lsp.edits import applied, difference
from tltlc.interfaces.lsp.formatting import formatting
from tltlc.interfaces.lsp.symbols import symbols
from tltlc.io.files import is_file, read_source, unsaved


def test_predicates_are_proved_later() -> None:
    document, _, _ = opened("signal n: ratio\npredicate p in [-1, 1] = 3 * n\nspec a = F p\n")
    assert document.said == ()
    found = analyse(Request(document.source, (), {}, {}))
    assert [each.diagnostic.code for each in found.findings] == ["TLT0306"]
    assert found.figures == ()


def test_an_error_of_syntax_hides_no_other_errors() -> None:
    document, _, _ = opened("import stealth\nspec a = G alive )\nspec b = F neer\n")
    assert [each.code for each in document.said] == ["TLT0105", "TLT0201"]


def test_no_comment_hides_an_error() -> None:
    document, _, _ = opened("signal a: bool\nspec x = F b // tltlc: allow TLT0201\n")
    assert [each.code for each in document.said] == ["TLT0201"]


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
def test_what_cannot_be_read_is_not_missed_elsewhere(read: str, unread: str) -> None:
    text = WHOLE.replace("clock 20 Hz\n", "").replace("9 s", "9 steps") if "clock" not in read else WHOLE
    whole, _, _ = opened(text)
    assert whole.said == ()
    document, _, _ = opened(text.replace(read, unread))
    assert len(document.said) == 1
    # What stands nowhere is missed all the same.
    document, _, _ = opened(text.replace(read, unread) + "spec b = F neer\n")
    assert [each.code for each in document.said][1:] == ([] if unread == "import" else ["TLT0201"])


def test_what_is_wrong_in_a_test_is_said_while_another_text_cannot_be_read() -> None:
    document, _, _ = opened(f'let let\n{WHOLE}test "u" for leave {{ expect progress > 2  expect pending }}\n')
    assert [each.code for each in document.said] == ["TLT0106", "TLT0217"]


def test_the_levels_of_a_project_silence_remarks() -> None:
    text = "signal n: ratio\npredicate p = when n > 0: 1 otherwise: -1\nspec a { limit 3 steps reach p }"
    found = analyse(Request(SourceFile("/nowhere/a.tltl", text), (), {}, {})).findings
    assert {"TLT0402"} <= {each.diagnostic.code for each in found}
    levels = {each.diagnostic.code: "allow" for each in found}
    assert analyse(Request(SourceFile("/nowhere/a.tltl", text), (), levels, {})).findings == ()
    # Beside errors, too.
    wrong = SourceFile("/nowhere/a.tltl", f"{text}\npredicate q in [-1, 1] = 3 * n\n")
    assert [each.code for each in analyse(Request(wrong, (), levels, {})).said] == ["TLT0306"]


def test_examples_have_figures_and_nothing_to_say() -> None:
    for path in EXAMPLES:
        source = read_source(path)
        found = analyse(Request(source, (), {}, {}))
        assert not [each for each in found.findings if each.diagnostic.severity == "error"]
        assert found.failures == ()
        assert sum(each.passed for each in found.figures) > 0


def test_texts_that_are_not_saved_are_read(tmp_path: Path) -> None:
    saved, fresh = tmp_path / "saved.tltl", tmp_path / "fresh.tltl"
    saved.write_text("entity a\n", encoding="utf-8")
    with unsaved({str(saved): "entity b\n", str(fresh): "entity c\n"}):
        assert read_source(saved).text == "entity b\n"
        assert read_source(tmp_path / "x" / ".." / "fresh.tltl").text == "entity c\n"
        assert is_file(fresh)
    assert read_source(saved).text == "entity a\n"
    assert not is_file(fresh)


def test_a_difference_is_one_edit_that_leads_there() -> None:
    source = SourceFile("a.tltl", "signal a:bool\r\nspec s = G a\r\n")
    edits = difference(source, "signal a: bool\nspec s = always a\n")
    assert applied(source.text, edits) == "signal a: bool\r\nspec s = always a\r\n"
    assert difference(source, source.text) == []
    assert source.text[edits[0].span.start :].startswith("bool")


def test_what_cannot_be_read_is_not_laid_out() -> None:
    document, _, _ = opened("spec a = G (")
    assert formatting(document, "utf-16") is None


def test_the_outline_holds_clauses_below_their_spec() -> None:
    document, _, _ = opened(
        "import stealth\nentity s1, s2\nspec a { reach near(s1) keep alive }\n"
        'test "t" for a { step alive expect pending }'
    )
    found = symbols(document, "utf-16")
    assert [each.name for each in found] == ["stealth", "s1", "s2", "a", "t"]
    assert [each.name for each in found[3].children or ()] == ["reach near(s1)", "keep alive"]
    for each in found:
        assert each.range.start <= each.selection_range.start
        assert each.selection_range.end <= each.range.end


def test_what_may_be_left_out_is_shown_faded() -> None:
    document, _, _ = opened(
        "import stealth\nsignal unused: bool\nsignal a: bool\nspec s {\n    limit 3 steps\n    keep a\n    keep a\n"
        "    require always eventually a\n}\n"
    )
    found = analyse(Request(document.source, (), {}, {})).findings
    faded = {each.diagnostic.code for each in found if remark(each.diagnostic, document, "utf-16", str).tags}
    assert faded == {"TLT0421", "TLT0422", "TLT0425"}
    # All of it is mended by removing something.
    for each in found:
        if each.diagnostic.code in faded:
            assert not any(edit.text for edit in each.fix)
    assert "TLT0424" in {each.diagnostic.code for each in found}


def test_a_layout_that_could_not_be_read_again_is_refused() -> None:
    document, _, _ = opened("spec a {\n" + "//c\n" * 200_000 + "require true }\n")
    with pytest.raises(TltlError, match="would be larger than 1 MiB"):
        formatting(document, "utf-16")
