"""Code actions: the suggestions of error messages, and the fixes of the linter's rules."""

from __future__ import annotations

import re
from pathlib import Path

import pytest
from lsprotocol import types

from tests.golden.cases import Case, cases
from tests.interfaces.lsp.texts import open_text
from tltlc.core.source import SourceFile, Span
from tltlc.diagnostics.diagnostic import Edit
from tltlc.grammar.parser import parse
from tltlc.interfaces.lsp.actions import actions
from tltlc.interfaces.lsp.diagnostics import label_in
from tltlc.interfaces.lsp.document import Document
from tltlc.interfaces.lsp.edits import apply_edits
from tltlc.interfaces.lsp.positions import offset

ERRORS = [case for case in cases("error") if re.match("TLT0[123]", case.name) and "input.tltl" in case.files]
"""Errors in syntax, names and types."""
URI = "file:///x.tltl"


def texts_after_actions(document: Document, span: Span) -> dict[str, str]:
    """Return the text after each action, by the action's title."""
    texts = {}
    for action in actions(document, span, (), "utf-16", lambda _: URI, types.WorkspaceEdit):
        assert action.edit is not None
        assert action.edit.changes is not None
        edits = [edit_of(document.source, edit) for edit in action.edit.changes[URI]]
        texts[action.title] = apply_edits(document.source.text, edits)
    return texts


def edit_of(source: SourceFile, edit: types.TextEdit) -> Edit:
    return Edit(Span(offset(source, edit.range.start), offset(source, edit.range.end)), edit.new_text)


@pytest.mark.parametrize(
    ("text", "title", "after"),
    [
        ("import stealth\nspec a = G ali¦v", "Write `alive`", "import stealth\nspec a = G alive"),
        ("entity s1\nspec a = F ne¦ar(s1)", "Add `import spatial`", "import spatial\nentity s1\nspec a = F near(s1)"),
        (
            "import core\nentity s1\nspec a = F ne¦ar(s1)",
            "Add `import spatial`",
            "import core\nimport spatial\nentity s1\nspec a = F near(s1)",
        ),
        (
            "/// Words.\nspec a = G lo¦ud\r\n",
            "Declare `signal loud: bool`",
            "signal loud: bool\r\n/// Words.\nspec a = G loud\r\n",
        ),
        ("signal a: bool\nspc¦ s = G a", "Write `spec`", "signal a: bool\nspec s = G a"),
        ("signal a: boool¦\nspec s = G a", "Write `bool`", "signal a: bool\nspec s = G a"),
        ("signal a: bool\nspec s { kep¦ a }", "Write `keep`", "signal a: bool\nspec s { keep a }"),
        (
            'signal a: bool\nspec hide = F a\ntest "t" for hi¦ed { step a expect holding }',
            "Write `hide`",
            'signal a: bool\nspec hide = F a\ntest "t" for hide { step a expect holding }',
        ),
    ],
)  # fmt: skip
def test_an_action_produces_the_expected_text(text: str, title: str, after: str) -> None:
    document, at, _ = open_text(text)
    texts = texts_after_actions(document, Span(at, at))
    assert texts.get(title) == after, texts


@pytest.mark.parametrize("case", ERRORS, ids=lambda case: case.name)
def test_every_action_reduces_the_errors(case: Case, tmp_path: Path) -> None:
    case.unpack(tmp_path)
    document, _, _ = open_text(case.files["input.tltl"].decode(), tmp_path)
    for diagnostic in document.diagnostics:
        label = label_in(diagnostic, document)
        if label is not None and diagnostic.severity == "error":
            for text in texts_after_actions(document, label.span).values():
                after = Document(SourceFile(document.source.name, text), document.project, {})
                assert error_counts(after) < error_counts(document)


def error_counts(document: Document) -> tuple[int, int]:
    """The number of syntax errors, which hide others, and the number of all errors."""
    return len(parse(document.source)[1]), sum(diagnostic.severity == "error" for diagnostic in document.diagnostics)


def test_many_errors_have_a_fix(tmp_path: Path) -> None:
    fixed = 0
    for case in ERRORS:
        folder = tmp_path / case.name
        case.unpack(folder)
        document, _, _ = open_text(case.files["input.tltl"].decode(), folder)
        labels = [label_in(diagnostic, document) for diagnostic in document.diagnostics]
        fixed += any(texts_after_actions(document, label.span) for label in labels if label is not None)
    assert fixed >= len(ERRORS) // 5
