"""The texts of level files in a baseline: they are the played texts, and the level can be rebuilt from them."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from tests.runtime.regression.game import edit
from tests.runtime.regression.handmade import PLAYED, some_episodes
from tests.runtime.regression.recorded_game import _game, _recorded  # noqa: F401
from tltl_runtime.game.level_name import Variant
from tltl_runtime.regression.suite.suite import SHIPPED, read_suite
from tltl_runtime.regression.verdict.baseline import Reference, baseline_of, read_baseline, text_sha256, write_baseline
from tltl_runtime.regression.verdict.level_texts import baseline_level, level_texts
from tltl_runtime.stealth.levels.file import level_names, load_level, variants
from tltl_runtime.stealth.levels.identity import level_hash
from tltlc.core.record import replace
from tltlc.diagnostics.diagnostic import TltlError


@pytest.mark.parametrize("name", level_names())
def test_every_file_of_a_level_has_a_text(name: str) -> None:
    for variant in variants(name):
        level = load_level(name, variant)
        texts = level_texts(name, Variant(variant), level.files)
        assert tuple((file, text_sha256(text)) for file, text in texts) == level.files


def test_an_overlay_in_another_folder_has_a_text(tmp_path: Path) -> None:
    overlay = tmp_path / "mine" / "slow.toml"
    overlay.parent.mkdir()
    overlay.write_bytes(b'doc = "Slow."\r\n[change.guard]\r\nwalk_speed = 0.5\r\n')
    variant = Variant("v0", (str(overlay),))
    files = load_level("cover_and_hide", variant).files
    texts = dict(level_texts("cover_and_hide", variant, files))
    assert texts["overlays/slow.toml"] == 'doc = "Slow."\n[change.guard]\nwalk_speed = 0.5\n'
    assert len(texts) == len(files)
    overlay.write_text("[change.guard]\nwalk_speed = 0.6\n", encoding="utf-8")
    assert "overlays/slow.toml" not in dict(level_texts("cover_and_hide", variant, files)), "it is another one"


def test_a_baseline_stores_the_texts_that_were_played(game: Path) -> None:
    (good, bad) = baseline_of(read_suite(Path("game.toml")))
    assert tuple((name, text_sha256(text)) for name, text in good.texts) == good.played.files
    assert good.texts == bad.texts and dict(good.texts)["room.toml"] == Path("room.toml").read_text(encoding="utf-8")
    # Each text is stored once and line by line, so that a diff of the baseline is readable.
    lines = Path("game.baseline.json").read_text(encoding="utf-8").splitlines()
    assert lines.count('"at = [8.0, 8.0, 0.0]",') == 1


def test_the_level_is_rebuilt_although_its_files_have_changed(game: Path) -> None:
    (good, _) = baseline_of(read_suite(Path("game.toml")))
    edit("room.toml", "at = [8.0, 8.0, 0.0]", "at = [2.0, 8.0, 0.0]")
    level = baseline_level(good)
    assert level is not None and level_hash(level) == good.played.level_hash
    assert level.exits[0].position == (8.0, 8.0, 0.0)


def test_the_shipped_levels_are_rebuilt() -> None:
    references = read_baseline(read_suite(SHIPPED).baseline)
    assert references
    for reference in references:
        level = baseline_level(reference)
        assert level is not None, reference.played.level
        assert level_hash(level) == reference.played.level_hash, reference.played.level


@pytest.mark.parametrize(
    "files",
    [
        (),
        (("room.toml", "a level that is none"),),
        (("../room.toml", "x = 1"),),
        (("/room.toml", "x = 1"),),
        (("overlays/../../room.toml", "x = 1"),),
        (("room\0.toml", "x = 1"),),
        (("room.toml", "x = 1"), ("overlays/a.toml", "y = 1"), ("overlays/a.toml", "y = 2")),
    ],
)
def test_invalid_texts_give_no_level(files: tuple[tuple[str, str], ...]) -> None:
    played = replace(PLAYED, files=tuple((name, text_sha256(text)) for name, text in files))
    assert baseline_level(Reference(played, tuple(some_episodes(1)), files)) is None


def test_missing_texts_give_no_level(game: Path) -> None:
    (good, _) = baseline_of(read_suite(Path("game.toml")))
    assert baseline_level(replace(good, texts=good.texts[:1])) is None
    assert baseline_level(replace(good, texts=())) is None


def test_edited_texts_are_rejected(tmp_path: Path) -> None:
    path, text = tmp_path / "game.baseline.json", "one\ntwo\n"
    played = replace(PLAYED, files=(("room.toml", text_sha256(text)),))
    references = (Reference(played, tuple(some_episodes(1)), (("room.toml", text),)),)
    write_baseline(path, references)
    assert read_baseline(path) == references
    document = json.loads(path.read_text(encoding="utf-8"))
    document["texts"][text_sha256(text)][0] = "three"
    path.write_text(json.dumps(document), encoding="utf-8")
    with pytest.raises(TltlError, match=r"TLT0902: .*baseline\.texts: the text called `\w{12}` has another SHA-256"):
        read_baseline(path)
    document["texts"] = {}
    path.write_text(json.dumps(document), encoding="utf-8")
    assert [reference.texts for reference in read_baseline(path)] == [()]
