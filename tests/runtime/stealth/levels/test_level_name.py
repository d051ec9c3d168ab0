"""Levels in arguments, with variants and added overlays."""

from __future__ import annotations

from pathlib import Path

import pytest

from tltl_runtime.game.level_name import Variant, parse_variant, split_level
from tltl_runtime.stealth.levels.file import changes, level_and_changes, load_level
from tltl_runtime.stealth.levels.identity import level_hash
from tltlc.diagnostics.diagnostic import TltlError

WIDER = 'doc = "The guard sees further."\n[change.guard]\nsight_range = 12.5\n'


@pytest.mark.parametrize(
    ("argument", "place"),
    [
        ("navigation", ("navigation", None)),
        ("navigation:v1", ("navigation", "v1")),
        ("levels/vault.toml:v2", ("levels/vault.toml", "v2")),
        ("branching:v0+guard_alert", ("branching", "v0+guard_alert")),
        ("branching:v1+guard_alert+edits/a:b.toml", ("branching", "v1+guard_alert+edits/a:b.toml")),
        ("branching:v0+/games/c++/wider.toml", ("branching", "v0+/games/c++/wider.toml")),
        ("branching:v0+", ("branching:v0+", None)),
        ("branching:+guard_alert", ("branching:+guard_alert", None)),
        ("branching+guard_alert", ("branching+guard_alert", None)),
        ("C:\\levels\\vault.toml", ("C:\\levels\\vault.toml", None)),
        ("C:\\levels\\vault.toml:v1+D:\\wider.toml", ("C:\\levels\\vault.toml", "v1+D:\\wider.toml")),
        (":v0", (":v0", None)),
        ("", ("", None)),
    ],
)
def test_an_argument_is_split_into_level_and_variant(argument: str, place: tuple[str, str | None]) -> None:
    assert split_level(argument) == place


def test_a_path_that_exists_is_not_split(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    (tmp_path / "odd:v0").touch()
    assert split_level("odd:v0") == ("odd:v0", None)
    assert split_level("odd:v1") == ("odd", "v1")


@pytest.mark.parametrize(
    ("variant", "overlays"),
    [
        ("v0", ()),
        ("v0+guard_alert", ("guard_alert",)),
        ("v0+guard_alert+edits/wide.toml+other", ("guard_alert", "edits/wide.toml", "other")),
        ("v0+/games/c++/wide.toml+guard_alert+./a+b.toml", ("/games/c++/wide.toml", "guard_alert", "./a+b.toml")),
        ("v0+a-b+D:\\c++\\wide.toml", ("a-b", "D:\\c++\\wide.toml")),
        ("v0+", ("",)),
        ("v0++wide", ("", "wide")),
    ],
)
def test_the_text_of_a_variant_is_parsed_into_its_name_and_overlays(variant: str, overlays: tuple[str, ...]) -> None:
    assert parse_variant(variant) == Variant("v0", overlays)
    if "\\" not in variant:
        assert Variant("v0", overlays).text == variant.replace("./a+b.toml", f"{Path.cwd()}/a+b.toml")


def test_the_path_of_an_overlay_may_contain_a_plus(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    (tmp_path / "c++").mkdir()
    (tmp_path / "c++" / "a+b.toml").write_text(WIDER, encoding="utf-8")
    variant = Variant("v0", ("c++/a+b.toml", "guard_alert"))
    absolute = Variant("v0", (str(tmp_path / "c++" / "a+b.toml"), "guard_alert"))
    assert parse_variant(variant.text) == variant.absolute() == absolute.absolute() == absolute
    loaded = load_level("branching", variant)
    assert loaded.variant == variant.title == "v0+a+b+guard_alert"
    assert load_level("branching", variant.text) == loaded
    assert level_and_changes("branching", variant) == (loaded, changes("branching", variant))
    assert changes("branching", variant)[0] == "The guard sees further."


def test_line_endings_do_not_change_the_hash(tmp_path: Path) -> None:
    wider = tmp_path / "wider.toml"
    hashes = []
    for text in (WIDER, WIDER.replace("\n", "\r\n"), WIDER.replace("12.5", "12.6")):
        wider.write_bytes(text.encode())
        hashes.append(dict(load_level("branching", f"v0+{wider}").files)["overlays/wider.toml"])
    assert hashes[0] == hashes[1] != hashes[2]


def test_overlays_are_added_to_a_variant(tmp_path: Path) -> None:
    wider = tmp_path / "wider.toml"
    wider.write_text(WIDER, encoding="utf-8")
    plain, alert = load_level("branching"), load_level("branching", "v0+guard_alert")
    assert alert.enemies[0].kind == load_level("cover_and_hide", "v1").enemies[0].kind != plain.enemies[0].kind
    both = load_level("branching", f"v0+guard_alert+{wider}")
    assert (both.name, both.variant) == ("branching", "v0+guard_alert+wider")
    assert both.enemies[0].kind.sight_range == 12.5
    assert both.enemies[0].kind.reaction_time == alert.enemies[0].kind.reaction_time
    assert [name for name, _ in both.files][-2:] == ["overlays/guard_alert.toml", "overlays/wider.toml"]
    assert changes("branching", f"v0+{wider}") == ("The guard sees further.",)
    # The order of the overlays matters if they change the same value.
    assert load_level("branching", f"v0+{wider}+guard_alert").enemies[0].kind.sight_range != 12.5


def test_an_overlay_without_changes_gives_the_same_level_hash(tmp_path: Path) -> None:
    (tmp_path / "nothing.toml").write_text('doc = "Nothing."\n', encoding="utf-8")
    assert level_hash(load_level("branching", f"v0+{tmp_path / 'nothing.toml'}")) == level_hash(load_level("branching"))


@pytest.mark.parametrize(
    ("variant", "code", "title"),
    [
        ("v7+guard_alert", "TLT0800", "the level `branching` has no variant `v7`"),
        ("v0+guard_alart", "TLT0800", "there is no overlay `guard_alart`"),
        ("v0+", "TLT0800", "there is no overlay ``"),
        ("v0+../overlays/guard_alert", "TLT0800", "there is no overlay `../overlays/guard_alert`"),
        ("v0+nowhere/wider.toml", "TLT0001", "cannot read `nowhere/wider.toml`: there is no such file"),
        ("v0+corridor_shut", "TLT0808", "the level uses no asset `corridor`"),
    ],
)
def test_invalid_overlays_are_rejected(variant: str, code: str, title: str) -> None:
    with pytest.raises(TltlError) as error:
        load_level("branching", variant)
    (diagnostic,) = error.value.diagnostics
    assert (diagnostic.code, diagnostic.title) == (code, title)
    assert diagnostic.help
