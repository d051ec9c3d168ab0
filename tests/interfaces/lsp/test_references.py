"""Where names lead to, where else they stand, and giving them others."""

from __future__ import annotations

from contextlib import suppress
from pathlib import Path

import pytest

from tests.interfaces.lsp.texts import EXAMPLES, opened
from tltlc.diagnostics.diagnostic import TltlError
from tltlc.interfaces.lsp.analysis import Request, analyse
from tltlc.interfaces.lsp.edits import applied
from tltlc.interfaces.lsp.references import references, rename

LIBRARY = """\
signal dark: ratio
entity gate
/// In the dark.
predicate lurking(least: ratio = 50 %) in [-1, 1] = clamp(dark - least, -1, 1)
let careful(p) = (always lurking) and p
"""
MAIN = """\
import "common.tltl"
signal at(x: entity): bool
param most: ratio = 10 %
spec leave {
    reach all x in (gate): at(x)
    keep lurking(least = most) or dark > most
    require careful(F at(gate))
}
test "t" for leave {
    step lurking(least = most), at(gate)
    expect pending
}
"""
ALIASED = 'import "common.tltl" as c\nspec other = G c.lurking & F c.careful(G c.lurking(10 %))\n'


def renamed(at: str, name: str, *, text: str = MAIN, folder: Path = Path("/nowhere"), **others: str) -> dict[str, str]:
    """The texts after a rename of the name at a place, by the names of the files."""
    document, offset, workspace = opened(text.replace(at, f"¦{at}", 1), folder, **others)
    found = document.name_at(offset)
    assert found is not None
    changed = rename(found.symbol, name, workspace)
    return {Path(each.source.name).stem: applied(each.source.text, edits) for each, edits in changed}


@pytest.mark.parametrize(
    ("at", "old", "new", "count"),
    [
        ("at(x: entity)", "at(", "is_at(", 4),
        ("x in (gate)", "x in (gate): at(x)", "place in (gate): at(place)", 1),
        ("most: ratio", "most", "greatest", 4),
        ("leave {", "leave", "flee", 2),
    ],
)
def test_a_name_of_the_file(at: str, old: str, new: str, count: int) -> None:
    texts = renamed(at, new.partition(" ")[0].partition("(")[0], common=LIBRARY)
    assert texts == {"main": MAIN.replace(old, new)}
    assert MAIN.count(old) == count


def test_a_predicate_is_renamed_in_every_file_and_behind_its_alias() -> None:
    texts = renamed("lurking(least = most) or", "hidden", common=LIBRARY, aliased=ALIASED)
    assert texts == {
        "main": MAIN.replace("lurking", "hidden"),
        "common": LIBRARY.replace("lurking", "hidden"),
        "aliased": ALIASED.replace("lurking", "hidden"),
    }


def test_a_parameter_is_renamed_where_it_is_given_by_name() -> None:
    texts = renamed("least = most) or", "lowest", common=LIBRARY)
    assert texts == {"main": MAIN.replace("least", "lowest"), "common": LIBRARY.replace("least", "lowest")}


def test_a_signal_that_two_files_declare_is_one() -> None:
    first = "signal n: ratio\nlet low = n < 10 %\n"
    main = 'import "first.tltl"\nimport "second.tltl"\nspec a = G (low and high)\n'
    second = first.replace("low", "high")
    texts = renamed("n: ratio", "level_of_noise", text=first, first=second, second=second)
    # The files have nothing to do with each other until a third one imports both.
    assert set(texts) == {"main"}
    document, _, workspace = opened(main, first=first, second=second)
    symbol = workspace.named("/nowhere/first.tltl")
    assert symbol is not None
    changed = rename(symbol.names[0].symbol, "m", workspace)
    assert sorted(Path(each.source.name).stem for each, _ in changed) == ["first", "second"]
    assert document.source.text == main


@pytest.mark.parametrize(
    ("at", "name", "code"),
    [
        ("gate)", "s 1", "TLT0771"),
        ("gate)", "until", "TLT0771"),
        ("at(x: entity)", "min", "TLT0771"),
        ("most: ratio", "dark", "TLT0771"),
        ("at(x: entity)", "careful", "TLT0771"),
        ("leave {", "a.b", "TLT0771"),
    ],
)
def test_what_is_refused(at: str, name: str, code: str) -> None:
    with pytest.raises(TltlError) as refusal:
        renamed(at, name, common=LIBRARY)
    assert refusal.value.diagnostics[0].code == code


def test_a_name_that_would_catch_another_one_is_refused() -> None:
    text = "entity door, gate\nsignal at(x: entity): bool\nspec a = all x in (door, gate): F (at(x) or at(gate))\n"
    with pytest.raises(TltlError, match="TLT0771"):
        renamed("x in (door", "gate", text=text)
    harmless = text.replace("at(gate)", "at(door)")
    assert set(renamed("x in (door", "gate", text=harmless)) == {"main"}


def test_a_name_of_a_library_is_refused() -> None:
    text = (
        "import stealth\nentity s1\nsignal health: ratio in [0, 1]\nspec a = F near(s1) & G alive & F health > 50 %\n"
    )
    for at in ("near", "alive", "health: ratio"):
        with pytest.raises(TltlError) as refusal:
            renamed(at, "other", text=text)
        assert refusal.value.diagnostics[0].code == "TLT0770"


def test_references_are_found_in_files_that_are_not_open(tmp_path: Path) -> None:
    (tmp_path / "common.tltl").write_text(LIBRARY, encoding="utf-8")
    (tmp_path / "aliased.tltl").write_text(ALIASED, encoding="utf-8")
    document, offset, workspace = opened(MAIN.replace("careful(F", "¦careful(F"), tmp_path)
    found = document.name_at(offset)
    assert found is not None
    places = {Path(each.source.name).stem: len(at) for each, at in references(found.symbol, workspace)}
    assert places == {"main": 1, "common": 1, "aliased": 1}
    assert found.symbol.source.name == str(tmp_path / "common.tltl")
    assert found.symbol.source.slice(found.symbol.span) == "careful"


@pytest.mark.parametrize("path", EXAMPLES, ids=lambda path: path.stem)
def test_a_rename_changes_names_alone(path: Path) -> None:
    """Every name that an example declares gets another one, and back again; what is said stays as it was."""
    text = path.read_text(encoding="utf-8")
    document, _, workspace = opened(text)
    own = {each.symbol.key: each.symbol for each in document.names if each.declares}
    assert own
    for symbol in own.values():
        try:
            ((_, edits),) = rename(symbol, "another_name", workspace)
        except TltlError as error:
            assert error.diagnostics[0].code == "TLT0770"
            continue
        changed = applied(text, edits)
        after, _, workspace_after = opened(changed)
        assert [each.code for each in after.said] == [each.code for each in document.said]
        assert len(after.names) == len(document.names)
        again = after.name_at(changed.index("another_name"))
        assert again is not None
        ((_, back),) = rename(again.symbol, symbol.name, workspace_after)
        assert applied(changed, back) == text


@pytest.mark.parametrize("path", EXAMPLES, ids=lambda path: path.stem)
def test_tests_pass_after_a_rename(path: Path) -> None:
    """Also those that expect a state, whose label has names in it."""
    text = path.read_text(encoding="utf-8")
    document, _, workspace = opened(text)
    before = analyse(Request(document.source, (), {}, {}))
    for name in {each.symbol.name: None for each in document.names if each.declares}:
        symbol = next(each.symbol for each in document.names if each.symbol.name == name)
        with suppress(TltlError):
            ((_, edits),) = rename(symbol, f"{name}_x", workspace)
            text = applied(text, edits)
            document, _, workspace = opened(text)
    after = analyse(Request(document.source, (), {}, {}))
    assert "_x" in text
    assert after.failures == before.failures == ()
    assert [(each.states, each.passed) for each in after.figures] == [
        (each.states, each.passed) for each in before.figures
    ]


def test_the_label_of_a_state_has_no_aliases() -> None:
    expected = (
        'spec s = G c.lurking\ntest "t" for s { step c.lurking expect state "G lurking" expect state "always" }\n'
    )
    main = f'import "common.tltl" as c\n{expected}'
    texts = renamed("lurking\ntest", "hidden", text=main, common=LIBRARY)
    assert texts["main"] == main.replace("lurking", "hidden")


def test_a_closed_file_counts_as_it_is_now(tmp_path: Path) -> None:
    (tmp_path / "common.tltl").write_text(LIBRARY, encoding="utf-8")
    other = tmp_path / "other.tltl"
    document, offset, workspace = opened(MAIN.replace("careful(F", "¦careful(F"), tmp_path)
    found = document.name_at(offset)
    assert found is not None
    assert len(references(found.symbol, workspace)) == 2
    other.write_text(ALIASED, encoding="utf-8")
    assert len(references(found.symbol, workspace)) == 3
    other.write_text("signal careful: bool\n", encoding="utf-8")
    assert len(references(found.symbol, workspace)) == 2
    other.unlink()
    assert len(references(found.symbol, workspace)) == 2
