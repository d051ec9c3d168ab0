"""Small level files that ask for endless work are rejected, or read in little time."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest

from tests.calls import calls
from tltl_runtime.stealth.levels import level_tables
from tltl_runtime.stealth.levels.file import load_level, read_level
from tltl_runtime.stealth.levels.level_object_check import fault
from tltl_runtime.support.checked_table import CheckedTable
from tltl_runtime.support.toml_tree import Entry, read_tree
from tltlc.core.record import replace
from tltlc.core.source import SourceFile, Span
from tltlc.diagnostics.diagnostic import Diagnostic, Label, TltlError

ROOM = """\
doc = "a room"
[bounds]
at = [0.0, 0.0, -0.5]
size = [40.0, 40.0, 10.0]
[start]
at = [0.0, 0.0, 0.0]
"""
WALL = "[[wall]]\nat = [5.0, 5.0, 0.0]\nsize = [0.1, 0.1, 1.0]\n"
STAIRS = """\
[[stairs]]
name = "s{}"
from = [1.0, 1.0, 0.0]
to = [15.0, 1.0, 4.0]
width = 2.0
steps = 40
"""


def level(folder: Path, text: str, head: str = "") -> str:
    path = folder / "room.toml"
    path.write_text(head + ROOM + text, encoding="utf-8")
    return str(path)


def part(folder: Path, name: str, text: str) -> None:
    (folder / "assets").mkdir(exist_ok=True)
    (folder / "assets" / f"{name}.toml").write_text(f'doc = "a part"\ntype = "part"\n{text}', encoding="utf-8")


def diagnostics_of(path: str) -> tuple[Diagnostic, ...]:
    with pytest.raises(TltlError) as caught:
        load_level(path)
    return caught.value.diagnostics


def test_a_large_part_that_is_used_often_is_rejected(tmp_path: Path) -> None:
    part(tmp_path, "big", 4000 * WALL)
    uses = "".join(f'[[use]]\nasset = "big"\nname = "u{number}"\n' for number in range(6000))
    (diagnostic,) = diagnostics_of(level(tmp_path, uses))
    assert diagnostic.code == "TLT0006"
    assert "more than 4,000 things" in diagnostic.title


def test_an_invalid_part_that_is_used_often_gives_a_limited_number_of_errors(tmp_path: Path) -> None:
    part(tmp_path, "big", 2000 * "[[wall]]\n")
    uses = "".join(f'[[use]]\nasset = "big"\nname = "u{number}"\n' for number in range(6000))
    assert len(diagnostics_of(level(tmp_path, uses))) < 10_000


def test_steps_of_stairs_and_points_of_paths_count_as_things(tmp_path: Path) -> None:
    (diagnostic,) = diagnostics_of(level(tmp_path, "".join(STAIRS.format(number) for number in range(120))))
    assert diagnostic.code == "TLT0006"
    points = ", ".join(5000 * ["[1.0, 1.0, 0.0]"])
    lift = f'[[mover]]\nname = "lift"\nsize = [1.0, 1.0, 1.0]\nspeed = 1.0\npath = [{points}]\n'
    (diagnostic,) = diagnostics_of(level(tmp_path, lift))
    assert diagnostic.code == "TLT0006"


def stairs(count: int) -> Callable[[], object]:
    source = SourceFile("room.toml", "".join(STAIRS.format(number) for number in range(count)))
    table = CheckedTable(Entry(read_tree(source), Label(source, Span(0, 0))), "the level", [])
    return lambda: level_tables.solids(table, level_tables.NamedParts({}, {}, []))


def test_the_work_for_stairs_grows_with_their_number() -> None:
    assert calls(stairs(200)) < 15 * calls(stairs(20))


def test_a_variant_has_at_most_a_hundred_overlays(tmp_path: Path) -> None:
    names = ", ".join(40_000 * ['"wider"'])
    diagnostics = diagnostics_of(level(tmp_path, f"[variants]\nv0 = [{names}]\n"))
    assert "TLT0006" in {diagnostic.code for diagnostic in diagnostics}
    assert len(diagnostics) < 200


def test_an_entity_inside_many_solids_is_reported_once(tmp_path: Path) -> None:
    switches = "".join(f'[[switch]]\nname = "s{number}"\nat = [5.0, 5.0, 0.1]\n' for number in range(100))
    assert len(diagnostics_of(level(tmp_path, 1000 * WALL + switches))) == 100


def test_a_mover_that_hits_many_solids_gives_ten_warnings(tmp_path: Path) -> None:
    lift = "speed = 1.0\npath = [[5.0, 5.0, 0.2], [5.0, 8.0, 0.2]]\n"
    lift = f'[[mover]]\nname = "lift"\nsize = [1.0, 1.0, 0.5]\n{lift}'
    assert len(read_level(level(tmp_path, 1000 * WALL + lift))[1]) == 10


@pytest.mark.parametrize(
    ("text", "head"),
    [
        ("", "".join(f"k{number} = 1\n" for number in range(40_000))),
        ("".join(f'[[use]]\nasset = "a{number}"\n' for number in range(6_000)), ""),
        (f"[sensors]\nentities = [{', '.join(f'{chr(34)}e{number}{chr(34)}' for number in range(40_000))}]\n", ""),
    ],
    ids=["unknown keys", "unknown assets", "unknown entities"],
)
def test_only_the_first_errors_search_for_similar_names(
    tmp_path: Path, text: str, head: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    searches = []
    monkeypatch.setattr(
        "tltl_runtime.support.suggestion.get_close_matches",
        lambda *arguments, **options: searches.append(arguments) or [],
    )
    diagnostics = diagnostics_of(level(tmp_path, text, head))
    # All errors are reported.
    assert len(diagnostics) >= 6_000
    assert len(searches) <= 200


def test_a_floor_that_would_take_gigabytes_is_too_large_for_enemies(tmp_path: Path) -> None:
    guard = '[[enemy]]\nname = "guard"\nkind = "guard"\nroute = [[5.0, 5.0, 0.0]]\n'
    assert load_level(level(tmp_path, guard)).enemies
    wide = ROOM.replace("40.0, 40.0", "1000.0, 1000.0")
    (tmp_path / "room.toml").write_text(wide + guard, encoding="utf-8")
    (diagnostic,) = diagnostics_of(str(tmp_path / "room.toml"))
    assert (diagnostic.code, diagnostic.title) == (
        "TLT0006",
        "the bounds of the level `room` are too large for enemies",
    )
    (tmp_path / "room.toml").write_text(wide, encoding="utf-8")
    large = load_level(str(tmp_path / "room.toml"))
    assert fault(large) is None
    guards = load_level(level(tmp_path, guard)).enemies
    assert fault(replace(large, enemies=guards)) == "the bounds are too large for enemies"
