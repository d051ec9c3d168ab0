"""The example on the page of a code causes this code, or no error if the code's cause is not in a
source."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

import tltlc
from tests.docs.blocks import blocks
from tltlc.core.source import SourceFile
from tltlc.diagnostics import code_pages
from tltlc.pipeline import compile_source
from tltlc.tools.lint.allow import CODE as ALLOWED_IN_VAIN
from tltlc.tools.lint.rules import rules

FOLDER = Path(code_pages.__file__).parent / "pages"
ABBREVIATED = {"TLT0012", "TLT0103", "TLT0317"}
"""The causes of these codes are too long for a page; the examples are abbreviated."""
AT_RUN_TIME = {"TLT0613": "TLT0306", "TLT0616": "TLT0306"}
"""The compiler rejects a source that would cause these at run time; their pages say so."""

FROM_A_SOURCE_TOO = {"TLT0501", "TLT0503", *AT_RUN_TIME}


OF_RULES = {*(rule.code for rule in rules()), ALLOWED_IN_VAIN}
"""Codes of the linter's rules; tests/tools/lint/test_pages.py runs their examples."""


@pytest.mark.parametrize("code", sorted(set(code_pages.codes()) - ABBREVIATED - OF_RULES))
def test_the_example_causes_its_code(code: str, inside: Path) -> None:
    examples = [block for block in blocks(FOLDER / f"{code}.md") if block.kind == "tltl"]
    for block in examples:
        Path(block.file).write_text(block.text, encoding="utf-8")
    # If there are several blocks, the last one uses the others.
    for block in examples[-1:]:
        try:
            diagnostics = compile_source(SourceFile(block.file, block.text)).diagnostics
        except tltlc.TltlError as error:
            diagnostics = error.diagnostics
        caused = AT_RUN_TIME.get(code, code)
        from_a_source = ("TLT0010" <= code < "TLT0500" and code != "TLT0308") or code in FROM_A_SOURCE_TOO
        assert {diagnostic.code for diagnostic in diagnostics} <= {caused}
        assert bool(diagnostics) == from_a_source
        assert caused == code or re.search(rf"\({caused}\)", code_pages.page(code))
