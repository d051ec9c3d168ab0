"""Definitions, references and renaming."""

from __future__ import annotations

from contextlib import suppress
from pathlib import Path

import pytest

from tests.interfaces.lsp.texts import EXAMPLES, open_text
from tltlc.diagnostics.diagnostic import TltlError
from tltlc.interfaces.lsp.edits import apply_edits
from tltlc.interfaces.lsp.references import references, rename
from tltlc.interfaces.lsp.slow_analysis import Request, analyse

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


def texts_after_rename(
    at: str, name: str, *, text: str = MAIN, folder: Path = Path("/nowhere"), **others: str
) -> dict[str, str]:
    """Rename the name at a place; return the new texts by the stems of their files."""
    document, offset, workspace = open_text(text.replace(at, f"¦{at}", 1), folder, **others)
    occurrence = document.name_at(offset)
    assert occurrence is not None
    changed = rename(occurrence.symbol, name, workspace)
    return {Path(document_.source.name).stem: apply_edits(document_.source.text, edits) for document_, edits in changed}


@pytest.mark.parametrize(
    ("at", "old", "new", "count"),
    [
        ("at(x: entity)", "at(", "is_at(", 4),
        ("x in (gate)", "x in (gate): at(x)", "place in (gate): at(place)", 1),
        ("most: ratio", "most", "greatest", 4),
        ("leave {", "leave", "flee", 2),
    ],
)
def test_a_name_is_renamed_in_its_file(at: str, old: str, new: str, count: int) -> None:
    texts = texts_after_rename(at, new.partition(" ")[0].partition("(")[0], common=LIBRARY)
    assert texts == {"main": MAIN.replace(old, new)}
    assert MAIN.count(old) == count


def test_a_predicate_is_renamed_in_every_file_and_after_its_alias() -> None:
    texts = texts_after_rename("lurking(least = most) or", "hidden", common=LIBRARY, aliased=ALIASED)
    assert texts == {
        "main": MAIN.replace("lurking", "hidden"),
        "common": LIBRARY.replace("lurking", "hidden"),
        "aliased": ALIASED.replace("lurking", "hidden"),
    }


def test_a_parameter_is_renamed_in_keyword_arguments() -> None:
    texts = texts_after_rename("least = most) or", "lowest", common=LIBRARY)
    assert texts == {"main": MAIN.replace("least", "lowest"), "common": LIBRARY.replace("least", "lowest")}


def test_a_signal_declared_in_two_files_is_one_symbol() -> None:
    first = "signal n: ratio\nlet low = n < 10 %\n"
    main = 'import "first.tltl"\nimport "second.tltl"\nspec a = G (low and high)\n'
    second = first.replace("low", "high")
    texts = texts_after_rename("n: ratio", "level_of_noise", text=first, first=second, second=second)
    # The two files are unrelated until a third one imports both.
    assert set(texts) == {"main"}
    document, _, workspace = open_text(main, first=first, second=second)
    symbol = workspace.document_at("/nowhere/first.tltl")
    assert symbol is not None
    changed = rename(symbol.names[0].symbol, "m", workspace)
    assert sorted(Path(document_.source.name).stem for document_, _ in changed) == ["first", "second"]
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
def test_invalid_new_names_are_rejected(at: str, name: str, code: str) -> None:
    with pytest.raises(TltlError) as refusal:
        texts_after_rename(at, name, common=LIBRARY)
    assert refusal.value.diagnostics[0].code == code


def test_a_name_that_would_capture_another_is_rejected() -> None:
    text = "entity door, gate\nsignal at(x: entity): bool\nspec a = all x in (door, gate): F (at(x) or at(gate))\n"
    with pytest.raises(TltlError, match="TLT0771"):
        texts_after_rename("x in (door", "gate", text=text)
    harmless = text.replace("at(gate)", "at(door)")
    assert set(texts_after_rename("x in (door", "gate", text=harmless)) == {"main"}


def test_a_name_that_is_used_but_not_declared_is_rejected_for_that() -> None:
    text = "signal dark: bool\nsignal seen: bool\nspec a = G dark & F seen & F noise\n"
    for name, expected in (
        ("noise", "stands in .*main.tltl`, where it means nothing yet"),
        ("seen", "means something"),
    ):
        with pytest.raises(TltlError, match=f"TLT0771: `{name}` already {expected}"):
            texts_after_rename("dark:", name, text=text)


def test_names_of_a_library_cannot_be_renamed() -> None:
    text = (
        "import stealth\nentity s1\nsignal health: ratio in [0, 1]\nspec a = F near(s1) & G alive & F health > 50 %\n"
    )
    for at in ("near", "alive", "health: ratio"):
        with pytest.raises(TltlError) as refusal:
            texts_after_rename(at, "other", text=text)
        assert refusal.value.diagnostics[0].code == "TLT0770"


def test_references_are_found_in_files_that_are_not_open(tmp_path: Path) -> None:
    (tmp_path / "common.tltl").write_text(LIBRARY, encoding="utf-8")
    (tmp_path / "aliased.tltl").write_text(ALIASED, encoding="utf-8")
    document, offset, workspace = open_text(MAIN.replace("careful(F", "¦careful(F"), tmp_path)
    occurrence = document.name_at(offset)
    assert occurrence is not None
    places = {Path(document_.source.name).stem: len(at) for document_, at in references(occurrence.symbol, workspace)}
    assert places == {"main": 1, "common": 1, "aliased": 1}
    assert occurrence.symbol.source.name == str(tmp_path / "common.tltl")
    assert occurrence.symbol.source.slice(occurrence.symbol.span) == "careful"


@pytest.mark.parametrize("path", EXAMPLES, ids=lambda path: path.stem)
def test_a_rename_changes_only_names(path: Path) -> None:
    """Every name that an example declares is renamed and renamed back; the diagnostics stay the
    same."""
    text = path.read_text(encoding="utf-8")
    document, _, workspace = open_text(text)
    own = {diagnostic.symbol.key: diagnostic.symbol for diagnostic in document.names if diagnostic.declares}
    assert own
    for symbol in own.values():
        try:
            ((_, edits),) = rename(symbol, "another_name", workspace)
        except TltlError as error:
            assert error.diagnostics[0].code == "TLT0770"
            continue
        changed = apply_edits(text, edits)
        after, _, workspace_after = open_text(changed)
        assert [diagnostic.code for diagnostic in after.diagnostics] == [
            diagnostic.code for diagnostic in document.diagnostics
        ]
        assert len(after.names) == len(document.names)
        renamed_occurrence = after.name_at(changed.index("another_name"))
        assert renamed_occurrence is not None
        ((_, back),) = rename(renamed_occurrence.symbol, symbol.name, workspace_after)
        assert apply_edits(changed, back) == text


@pytest.mark.parametrize("path", EXAMPLES, ids=lambda path: path.stem)
def test_tests_pass_after_a_rename(path: Path) -> None:
    """This includes tests that expect a state whose label contains names."""
    text = path.read_text(encoding="utf-8")
    document, _, workspace = open_text(text)
    before = analyse(Request(document.source, (), {}, {}))
    for name in {occurrence.symbol.name: None for occurrence in document.names if occurrence.declares}:
        symbol = next(occurrence.symbol for occurrence in document.names if occurrence.symbol.name == name)
        with suppress(TltlError):
            ((_, edits),) = rename(symbol, f"{name}_x", workspace)
            text = apply_edits(text, edits)
            document, _, workspace = open_text(text)
    after = analyse(Request(document.source, (), {}, {}))
    assert "_x" in text
    assert after.failures == before.failures == ()
    assert [(figures.states, figures.passed) for figures in after.figures] == [
        (figures.states, figures.passed) for figures in before.figures
    ]


def test_the_label_of_a_state_has_no_aliases() -> None:
    expected = (
        'spec s = G c.lurking\ntest "t" for s { step c.lurking expect state "G lurking" expect state "always" }\n'
    )
    main = f'import "common.tltl" as c\n{expected}'
    texts = texts_after_rename("lurking\ntest", "hidden", text=main, common=LIBRARY)
    assert texts["main"] == main.replace("lurking", "hidden")


def test_a_closed_file_counts_with_its_saved_text(tmp_path: Path) -> None:
    (tmp_path / "common.tltl").write_text(LIBRARY, encoding="utf-8")
    other = tmp_path / "other.tltl"
    document, offset, workspace = open_text(MAIN.replace("careful(F", "¦careful(F"), tmp_path)
    occurrence = document.name_at(offset)
    assert occurrence is not None
    assert len(references(occurrence.symbol, workspace)) == 2
    other.write_text(ALIASED, encoding="utf-8")
    assert len(references(occurrence.symbol, workspace)) == 3
    other.write_text("signal careful: bool\n", encoding="utf-8")
    assert len(references(occurrence.symbol, workspace)) == 2
    other.unlink()
    assert len(references(occurrence.symbol, workspace)) == 2


GROUPS = """\
signal at(x: entity): bool
entity guards = g1, g2
entity foes = guards, boss
spec s = all g in guards: at(g) & at(g1) & (any f in (foes, g1): at(f))
"""


@pytest.mark.parametrize(
    ("at", "new", "count"),
    [("guards =", "watch", 3), ("g1, g2", "first", 3), ("boss", "chief", 1), ("foes,", "enemies", 2)],
)
def test_a_group_and_its_members_are_renamed(at: str, new: str, count: int) -> None:
    old = at.partition(" ")[0].rstrip(",")
    assert texts_after_rename(at, new, text=GROUPS) == {"main": GROUPS.replace(old, new)}
    assert GROUPS.count(old) == count


def test_a_number_that_a_step_sets_is_renamed_and_a_value_of_an_enum_is_not() -> None:
    text = """\
signal alert: bool
signal fuel in [0, 9]
signal mode: (idle, alert)
spec s { keep fuel > 3 or alert or mode is idle }
test "t" for s {
    step fuel = 4, mode = alert, alert
    expect holding
}
"""
    renamed = texts_after_rename("fuel in", "energy", text=text)
    assert [*renamed.values()] == [text.replace("fuel", "energy")]
    renamed = texts_after_rename("alert: bool", "alarm", text=text)
    assert [*renamed.values()] == [
        text.replace("alert: bool", "alarm: bool").replace("or alert", "or alarm").replace(", alert\n", ", alarm\n")
    ]
