"""Every specification in the documentation compiles, or causes the very message that stands behind it."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.docs.blocks import DOCS, Block, blocks

PAGES = sorted(DOCS.rglob("*.md"))


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.stem)
def test_specifications(page: Path, tltlc, inside: Path) -> None:  # type: ignore[no-untyped-def]
    found = blocks(page)
    for block, after in zip(found, [*found[1:], Block("", "", 0)], strict=False):
        if block.kind != "tltl":
            continue
        where = f"{page.name}:{block.line}"
        Path(block.file).write_text(block.text, encoding="utf-8")
        checked = tltlc("check", block.file)
        if after.text.startswith(("error[", "warning[")):
            assert checked.err.startswith(after.text), where
            assert checked.status == after.text.startswith("error["), where
            continue
        assert (checked.status, "nothing to report" in checked.err) == (0, True), f"{where}: {checked.err}"
        if '\ntest "' in block.text:
            assert tltlc("test", block.file).status == 0, where


def test_the_reference_has_plenty_of_them() -> None:
    assert sum(block.kind == "tltl" for block in blocks(DOCS / "language.md")) >= 14
