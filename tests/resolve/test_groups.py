"""Groups of entities: ``entity guards = g1, g2``, and ``all g in guards: …``."""

from __future__ import annotations

from pathlib import Path

import pytest

from tltlc import CompileOptions, compile_text
from tltlc.core.record import replace
from tltlc.diagnostics.diagnostic import TltlError

HEAD = "signal hidden(x: entity): bool\nsignal alarm: bool\nentity guards = g1, g2\n"


def formula(text: str) -> str:
    (fspa,) = compile_text(HEAD + text)
    return str(fspa.formula)


@pytest.mark.parametrize(
    ("quantifier", "expansion"),
    [
        ("all g in guards: hidden(g)", "hidden(g1) & hidden(g2)"),
        ("any g in guards: hidden(g)", "hidden(g1) | hidden(g2)"),
        ("all g in (guards): hidden(g)", "hidden(g1) & hidden(g2)"),
        ("all g in (boss, guards): hidden(g)", "hidden(boss) & hidden(g1) & hidden(g2)"),
        ("all g in (g2, guards): hidden(g)", "hidden(g2) & hidden(g1)"),
        ("all g in foes: hidden(g)", "hidden(g1) & hidden(g2) & hidden(boss)"),
        ("all g in boss: hidden(g)", "hidden(boss)"),
    ],
)
def test_a_quantifier_takes_each_member_once(quantifier: str, expansion: str) -> None:
    assert formula(f"entity boss\nentity foes = guards, boss\nspec s = {quantifier}") == expansion


def test_a_group_and_a_list_give_equal_automata() -> None:
    (grouped,) = compile_text(f"{HEAD}spec s {{ keep all g in guards: alarm implies hidden(g) }}")
    (listed,) = compile_text(
        "signal hidden(x: entity): bool\nsignal alarm: bool\nentity g1, g2\n"
        "spec s { keep all g in (g1, g2): alarm implies hidden(g) }"
    )
    # Only the texts of the clauses differ.
    assert replace(grouped, clauses=()) == replace(listed, clauses=())


def test_a_group_declares_the_members_that_nothing_else_declares() -> None:
    assert formula("spec s = hidden(g2)") == "hidden(g2)"
    assert formula("entity g2\nspec s = all g in guards: hidden(g)") == "hidden(g1) & hidden(g2)"
    assert formula("entity others = g2, g3\nspec s = all g in others: hidden(g)") == "hidden(g2) & hidden(g3)"


@pytest.mark.parametrize(
    ("declaration", "imported", "expansion"),
    [
        ("import foes", "guards", "hidden(g1) & hidden(g2)"),
        ("import foes (guards)", "guards", "hidden(g1) & hidden(g2)"),
        ("import foes as f", "f.guards", "hidden(g1) & hidden(g2)"),
        ("import foes as f\nentity all_foes = f.guards, boss", "all_foes", "hidden(g1) & hidden(g2) & hidden(boss)"),
    ],
)
def test_a_library_offers_its_groups(tmp_path: Path, declaration: str, imported: str, expansion: str) -> None:
    (tmp_path / "foes.tltl").write_text("entity guards = g1, g2\n", encoding="utf-8")
    text = f"{declaration}\nsignal hidden(x: entity): bool\nspec s = all g in {imported}: hidden(g)"
    (fspa,) = compile_text(text, options=CompileOptions(library_dirs=(tmp_path,)))
    assert str(fspa.formula) == expansion


@pytest.mark.parametrize(
    ("text", "code", "title", "help_"),
    [
        ("spec s = all g in gards: hidden(g)", "TLT0201", "no group `gards` here", None),
        (
            "spec s = hidden(guards)",
            "TLT0302",
            "expected an entity, found the group `guards`",
            "name one of its members, or write a condition for each: `all x in guards: …`",
        ),
        (
            "spec s = guards",
            "TLT0301",
            "expected a formula, found a group of entities",
            "write a condition for each member: `all x in guards: …`",
        ),
        (
            "entity a = b, g1\nentity b = a\nspec s = all g in a: hidden(g)",
            "TLT0207",
            "the group `a` contains itself: a -> b -> a",
            "list entities, or groups that do not contain this one",
        ),
        ("entity guards = g3\nspec s = alarm", "TLT0202", "`guards` is declared twice", None),
        ("entity all_signals = alarm\nspec s = alarm", "TLT0202", "`alarm` is declared twice", None),
        ("entity a = st.guard\nspec s = alarm", "TLT0201", "no entity `st.guard` here", None),
        ("spec s = all g in hidden: alarm", "TLT0302", "expected an entity, found a formula", None),
    ],
)
def test_a_wrong_group_is_one_error(text: str, code: str, title: str, help_: str | None) -> None:
    with pytest.raises(TltlError) as caught:
        compile_text(HEAD + text)
    (diagnostic,) = caught.value.diagnostics
    assert (diagnostic.code, diagnostic.title) == (code, title)
    assert help_ is None or diagnostic.help == help_
