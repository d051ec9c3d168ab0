"""The baseline beside a suite: written, read again, and asked for figures."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from tests.runtime.regression.made import PLAYED, made, reference, several, suite
from tltl_runtime.regression.account import Nearest
from tltl_runtime.regression.baseline import (
    baseline_command,
    baseline_of,
    read_baseline,
    reference_of,
    write_baseline,
    written_to,
)
from tltl_runtime.regression.suite import SHIPPED, baseline_path, read_suite
from tltl_runtime.stealth.levels.made_for import shown
from tltlc.diagnostics.diagnostic import TltlError
from tltlc.record import replace

SUITE = suite()
NEAREST = Nearest("near(exit)", -0.25, (1.0, 2.0, 0.0), "exit", 3.2)


def test_it_is_read_as_it_was_written(tmp_path: Path) -> None:
    path = tmp_path / "game.baseline.json"
    failed = made(1, False, nearest=NEAREST, by=("guard",), seen_by=("guard",), states=(0, 2, 1))
    known = (reference([made(0), failed]), reference(several(3), level="vault", variant="v1+wide"))
    write_baseline(path, known)
    assert read_baseline(path) == known
    again = tmp_path / "again.json"
    write_baseline(again, known)
    assert again.read_bytes() == path.read_bytes()
    # A line an episode: what changes of one is one line of a difference.
    lines = path.read_text(encoding="utf-8").splitlines()
    assert sum(line.startswith('{"index":') for line in lines) == 5


def test_its_place() -> None:
    assert baseline_path(Path("levels/game.toml")) == Path("levels/game.baseline.json")


@pytest.mark.parametrize(
    ("key", "value"),
    [
        ("progress", "much"),
        ("end", "bored"),
        ("index", 0.5),
        ("arrivals", [[0, 1]]),
        ("colour", "red"),
        ("reward", float("inf")),
    ],
)
def test_what_is_broken_is_refused(tmp_path: Path, key: str, value: object) -> None:
    path = tmp_path / "game.baseline.json"
    write_baseline(path, (reference([made(0)]),))
    document = json.loads(path.read_text(encoding="utf-8"))
    document["references"][0]["accounts"][0][key] = value
    path.write_text(json.dumps(document), encoding="utf-8")
    with pytest.raises(TltlError) as error:
        read_baseline(path)
    (found,) = error.value.diagnostics
    assert found.code == "TLT0902"
    assert key in found.title


@pytest.mark.parametrize("text", ["[]", "3", "{}", "[" * 100_000, "\xff", '{"format": "tltl-episode"}'])
def test_what_is_something_else_is_refused(tmp_path: Path, text: str) -> None:
    path = tmp_path / "game.baseline.json"
    path.write_bytes(text.encode("latin-1"))
    with pytest.raises(TltlError) as error:
        read_baseline(path)
    assert [found.code for found in error.value.diagnostics] == ["TLT0900"]


def test_figures_are_found_whatever_the_level_has_become() -> None:
    known = (reference(variant="v1"), reference(several(2)))
    wanted = replace(PLAYED, level_hash="0" * 64, files=(), versions={})
    assert reference_of(known, wanted, SUITE) == known[1]


def test_levels_of_one_name_are_told_apart() -> None:
    known = tuple(reference(several(count), place=f"{place}/room.toml") for count, place in ((1, "old"), (2, "new")))
    for each in known:
        assert reference_of(known, replace(PLAYED, place=each.played.place), SUITE) == each
    # A level that comes with the package has no place, and is no other one either.
    shipped = reference(several(3), place="")
    for each in ((shipped, *known), (*known, shipped)):
        assert [reference_of(each, replace(PLAYED, place=place), SUITE) for place in ("old/room.toml", "")] == [
            known[0],
            shipped,
        ]
        with pytest.raises(TltlError, match="no figures of `other/room"):
            reference_of(each, replace(PLAYED, place="other/room.toml"), SUITE)
    with pytest.raises(TltlError, match="no figures of `other/room"):
        reference_of(known, replace(PLAYED, place="other/room.toml"), SUITE)


@pytest.mark.parametrize(
    ("changed", "title"),
    [
        ({"level": "vault"}, "the baseline has no figures of `vault:v0`"),
        ({"variant": "v2"}, "the baseline has no figures of `room:v2`"),
        ({"policy": "f" * 64}, "the baseline has no figures of `room:v0` with this policy"),
        ({"spec_hash": "f" * 64}, "the baseline has no figures of `room:v0` with this spec"),
        ({"seed": 8}, "the baseline has no figures of `room:v0` with this seed"),
    ],
)
def test_figures_that_are_missing(changed: dict[str, object], title: str) -> None:
    with pytest.raises(TltlError) as error:
        reference_of((reference(several(2)),), replace(PLAYED, **changed), suite(path=Path("a game.toml")))
    (found,) = error.value.diagnostics
    assert (found.code, found.title) == ("TLT0903", title)
    assert found.help == "record it: tltlc baseline 'a game.toml'"


def test_a_suite_without_a_baseline(tmp_path: Path) -> None:
    with pytest.raises(TltlError) as error:
        baseline_of(suite(path=tmp_path / "game.toml"))
    (found,) = error.value.diagnostics
    assert found.code == "TLT0903"
    assert found.help == f"record it: tltlc baseline {tmp_path / 'game.toml'}"
    write_baseline(tmp_path / "game.baseline.json", (reference(several(1)),))
    assert baseline_of(suite(path=tmp_path / "game.toml")) == (reference(several(1)),)
    assert baseline_path(SHIPPED).parent == SHIPPED.parent


@pytest.mark.parametrize("path", [Path("game.toml"), SHIPPED])
def test_what_records_a_baseline_writes_the_one_that_is_missing(path: Path) -> None:
    """That of the package is written only where this is said."""
    named = replace(suite(path=path), baseline=Path("a night.json"))
    words = "" if path == SHIPPED else " game.toml"
    assert baseline_command(named) == f"tltlc baseline{words} --output 'a night.json'"
    shipped = replace(named, baseline=written_to(path))
    assert baseline_command(shipped) == f"tltlc baseline{words}"
    assert baseline_command(read_suite(SHIPPED)) == f"tltlc baseline --output {shown(baseline_path(SHIPPED))}"


@pytest.mark.parametrize("indices", [[], [1], [0, 2], [0, 0], [1, 0]])
def test_episodes_must_be_there_in_their_order(tmp_path: Path, indices: list[int]) -> None:
    path = tmp_path / "game.baseline.json"
    write_baseline(path, (reference(several(1)), reference([made(index) for index in indices])))
    with pytest.raises(TltlError) as error:
        read_baseline(path)
    (found,) = error.value.diagnostics
    assert found.code == "TLT0902"
    assert "baseline.references[1].accounts: the episodes must be there from number 0 on" in found.title
