"""TLT0421: declarations that are not used."""

from __future__ import annotations

import pytest

from tests.tools.lint.helpers import block, codes, findings_in, labelled_texts


@pytest.mark.parametrize(
    "text",
    [
        "signal a: bool\nlet both(x) = a & x\n",  # a library
        "import spatial\nsignal position.x: length in [0 m, 9 m]\nspec s = F inside_rectangle(1 m, 2 m, 3 m, 4 m)",
        "param far: length = 3 m\nimport spatial\nentity e\nspec s = F near(e, far = far)",
        "entity e, f\nsignal a(x: entity): bool\nspec s = all x in (e, f): F a(x)",
        "entity both = e, f\nsignal a(x: entity): bool\nspec s = all x in both: F a(x)",
        "entity e, f\nentity both = e, f\nsignal a(x: entity): bool\nspec s = all x in both: F a(x)",
        "entity e\nsignal a(x: entity): bool\nexclusive a(e), b\nsignal b: bool\nspec s = F b & F c\nsignal c: bool",
        "import stealth as st\nspec s = G st.alive",
        "import stealth (alive)\nspec s = G alive",
        "signal x: length in [0 m, 9 m]\nparam most: length in [1 m, 4 m] = 3 m\nspec s = F x > most",
    ],
)
def test_used_declarations_are_not_reported(text: str) -> None:
    assert not {"TLT0421", "TLT0422"}.intersection(codes(text))


def test_a_declaration_used_only_by_an_unused_one_is_reported_in_the_next_run() -> None:
    text = "signal a: bool\nsignal b: bool\nlet c = F b\nspec s = F a\n"
    assert labelled_texts(text, "TLT0421") == ["c"]


def test_a_level_or_tag_of_the_same_name_is_no_use() -> None:
    text = block("level vault", "tag quick", "reach a", before="signal vault: bool signal quick: bool signal a: bool\n")
    assert labelled_texts(text, "TLT0421") == ["vault", "quick"]


def test_a_group_that_no_quantifier_uses_is_reported_without_a_fix() -> None:
    text = "entity both = e, f\nsignal a(x: entity): bool\nspec s = F a(e)"
    assert labelled_texts(text, "TLT0421") == ["both"]
    (finding,) = [finding for finding in findings_in(text) if finding.diagnostic.code == "TLT0421"]
    assert finding.diagnostic.help == "use it, as in `all x in both: …`, or declare its members alone: `entity e, f`"
    assert not finding.diagnostic.fixes
