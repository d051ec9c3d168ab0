"""Every specification in the documentation compiles, or causes exactly the message shown after it."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.docs.blocks import DOCS, Block, blocks

PAGES = sorted(DOCS.rglob("*.md"))


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.stem)
def test_specifications_compile_or_cause_the_shown_message(page: Path, tltlc, inside: Path) -> None:  # type: ignore[no-untyped-def]
    page_blocks = blocks(page)
    for block, after in zip(page_blocks, [*page_blocks[1:], Block("", "", 0)], strict=False):
        if block.kind != "tltl":
            continue
        place = f"{page.name}:{block.line}"
        Path(block.file).write_text(block.text, encoding="utf-8")
        checked = tltlc("check", block.file)
        if after.text.startswith(("error[", "warning[")):
            assert checked.err.startswith(after.text), place
            assert checked.status == after.text.startswith("error["), place
            continue
        if after.text.startswith("$ tltlc lint"):
            # The session shows the warnings, which another test compares.
            assert (checked.status, "warning[" in checked.err) == (0, True), place
            continue
        assert (checked.status, "nothing to report" in checked.err) == (0, True), f"{place}: {checked.err}"
        if '\ntest "' in block.text:
            assert tltlc("test", block.file).status == 0, place


def test_the_language_reference_has_many_examples() -> None:
    assert sum(block.kind == "tltl" for block in blocks(DOCS / "language.md")) >= 14
