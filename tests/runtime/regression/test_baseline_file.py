"""The baseline file of a suite: writing it, reading it, and looking up references."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from tests.runtime.regression.game import EASY
from tests.runtime.regression.handmade import PLAYED, an_episode, reference, some_episodes, suite
from tltl_runtime.regression.explain.explained_episode import NearestMiss
from tltl_runtime.regression.suite.suite import SHIPPED, baseline_path, read_suite
from tltl_runtime.regression.verdict.baseline import (
    baseline_command,
    baseline_of,
    check_states,
    default_output,
    read_baseline,
    reference_of,
    write_baseline,
)
from tltl_runtime.support.path_text import path_text
from tltlc import compile_text
from tltlc.core.record import replace
from tltlc.diagnostics.diagnostic import TltlError

SUITE = suite()
NEAREST = NearestMiss("near(exit)", -0.25, (1.0, 2.0, 0.0), "exit", 3.2)


def test_a_baseline_is_read_as_it_was_written(tmp_path: Path) -> None:
    path = tmp_path / "game.baseline.json"
    failed = an_episode(1, False, nearest=NEAREST, by=("guard",), seen_by=("guard",), states=(0, 2, 1))
    references = (reference([an_episode(0), failed]), reference(some_episodes(3), level="vault", variant="v1+wide"))
    write_baseline(path, references)
    assert read_baseline(path) == references
    again = tmp_path / "again.json"
    write_baseline(again, references)
    assert again.read_bytes() == path.read_bytes()
    # Each episode is one line, so that a change of an episode is one line of a diff.
    lines = path.read_text(encoding="utf-8").splitlines()
    assert sum(line.startswith('{"index":') for line in lines) == 5


def test_the_baseline_lies_beside_the_suite() -> None:
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
        ("reward", 1e300),
        ("reward", -1.1),
        ("progress", 7),
        ("progress", -0.5),
        ("steps", 0),
        ("seed", None),
        ("arrivals", []),
        ("way", []),
    ],
)
def test_a_wrong_value_is_rejected(tmp_path: Path, key: str, value: object) -> None:
    path = tmp_path / "game.baseline.json"
    write_baseline(path, (reference([an_episode(0)]),))
    document = json.loads(path.read_text(encoding="utf-8"))
    document["references"][0]["accounts"][0][key] = value
    path.write_text(json.dumps(document), encoding="utf-8")
    with pytest.raises(TltlError) as error:
        read_baseline(path)
    (diagnostic,) = error.value.diagnostics
    assert diagnostic.code == "TLT0902"
    assert key in diagnostic.title


def test_missing_keys_are_named_in_their_order(tmp_path: Path) -> None:
    path = tmp_path / "game.baseline.json"
    write_baseline(path, (reference([an_episode(0)]),))
    document = json.loads(path.read_text(encoding="utf-8"))
    for key in ("cause", "index", "unmet"):
        del document["references"][0]["accounts"][0][key]
    path.write_text(json.dumps(document), encoding="utf-8")
    with pytest.raises(
        TltlError, match=r"`baseline\.references\[0\]\.accounts\[0\]` lacks the keys `index`, `unmet`, `cause`"
    ):
        read_baseline(path)


@pytest.mark.parametrize(("key", "path"), [("arrivals", ("state",)), ("way", (2,)), ("unmet", ())])
def test_states_that_the_automaton_lacks_are_rejected(tmp_path: Path, key: str, path: tuple[str | int, ...]) -> None:
    tested_suite, (fspa,) = suite(path=tmp_path / "game.toml"), compile_text(EASY)
    count = len(fspa.states)
    write_baseline(tested_suite.baseline, (reference(some_episodes(2)),))
    document = json.loads(tested_suite.baseline.read_text(encoding="utf-8"))

    def with_state(state: int) -> None:
        explained = document["references"][0]["accounts"][1]
        if path:
            explained[key][-1][path[0]] = state
        else:
            explained[key] = state
        tested_suite.baseline.write_text(json.dumps(document), encoding="utf-8")

    with_state(count - 1)
    (baseline_reference,) = baseline_of(tested_suite)
    check_states(baseline_reference, fspa, tested_suite)
    with_state(count)
    (baseline_reference,) = baseline_of(tested_suite)
    with pytest.raises(TltlError, match=f"TLT0902: .* episode 1 of `room:v0` has the state {count}, but "):
        check_states(baseline_reference, fspa, tested_suite)
    with_state(-1)
    with pytest.raises(TltlError, match=r"TLT0902: .*references\[0\]\.accounts\[1\]: it has the state -1"):
        baseline_of(tested_suite)


def test_a_reward_may_exceed_its_range_by_rounding(tmp_path: Path) -> None:
    references = (reference([an_episode(0, False, reward=-1.0000000000000002, progress=0.0)]),)
    write_baseline(tmp_path / "game.baseline.json", references)
    assert read_baseline(tmp_path / "game.baseline.json") == references


@pytest.mark.parametrize("text", ["[]", "3", "{}", "[" * 100_000, "\xff", '{"format": "tltl-episode"}'])
def test_a_file_that_is_no_baseline_is_rejected(tmp_path: Path, text: str) -> None:
    path = tmp_path / "game.baseline.json"
    path.write_bytes(text.encode("latin-1"))
    with pytest.raises(TltlError) as error:
        read_baseline(path)
    assert [diagnostic.code for diagnostic in error.value.diagnostics] == ["TLT0900"]


def test_a_reference_is_found_although_the_level_has_changed() -> None:
    references = (reference(variant="v1"), reference(some_episodes(2)))
    identity = replace(PLAYED, level_hash="0" * 64, files=(), versions={})
    assert reference_of(references, identity, SUITE) == references[1]


def test_levels_with_the_same_name_are_told_apart() -> None:
    references = tuple(
        reference(some_episodes(count), place=f"{place}/room.toml") for count, place in ((1, "old"), (2, "new"))
    )
    for user_reference in references:
        assert reference_of(references, replace(PLAYED, place=user_reference.played.place), SUITE) == user_reference
    # A shipped level has no place. It is not confused with user levels either.
    shipped = reference(some_episodes(3), place="")
    for ordered in ((shipped, *references), (*references, shipped)):
        assert [reference_of(ordered, replace(PLAYED, place=place), SUITE) for place in ("old/room.toml", "")] == [
            references[0],
            shipped,
        ]
        with pytest.raises(TltlError, match="no figures for `other/room"):
            reference_of(ordered, replace(PLAYED, place="other/room.toml"), SUITE)
    with pytest.raises(TltlError, match="no figures for `other/room"):
        reference_of(references, replace(PLAYED, place="other/room.toml"), SUITE)


@pytest.mark.parametrize(
    ("changed", "title"),
    [
        ({"level": "vault"}, "the baseline has no figures for `vault:v0`"),
        ({"variant": "v2"}, "the baseline has no figures for `room:v2`"),
        ({"policy": "f" * 64}, "the baseline has no figures for `room:v0` with this policy"),
        ({"spec_hash": "f" * 64}, "the baseline has no figures for `room:v0` with this spec"),
        ({"seed": 8}, "the baseline has no figures for `room:v0` with this seed"),
    ],
)
def test_a_missing_reference_is_reported(changed: dict[str, object], title: str) -> None:
    with pytest.raises(TltlError) as error:
        reference_of((reference(some_episodes(2)),), replace(PLAYED, **changed), suite(path=Path("a game.toml")))
    (diagnostic,) = error.value.diagnostics
    assert (diagnostic.code, diagnostic.title) == ("TLT0903", title)
    assert diagnostic.help == "record it: tltlc baseline 'a game.toml'"


def test_a_missing_baseline_is_reported(tmp_path: Path) -> None:
    with pytest.raises(TltlError) as error:
        baseline_of(suite(path=tmp_path / "game.toml"))
    (diagnostic,) = error.value.diagnostics
    assert diagnostic.code == "TLT0903"
    assert diagnostic.help == f"record it: tltlc baseline {tmp_path / 'game.toml'}"
    write_baseline(tmp_path / "game.baseline.json", (reference(some_episodes(1)),))
    assert baseline_of(suite(path=tmp_path / "game.toml")) == (reference(some_episodes(1)),)
    assert baseline_path(SHIPPED).parent == SHIPPED.parent


def test_a_baseline_that_cannot_be_read_is_not_reported_as_missing() -> None:
    with pytest.raises(TltlError, match="TLT0001: cannot read `aaa"):
        baseline_of(replace(suite(), baseline=Path("a" * 300)))


@pytest.mark.parametrize("path", [Path("game.toml"), SHIPPED])
def test_the_suggested_command_names_the_output_only_where_it_is_needed(path: Path) -> None:
    """The baseline inside the package is written only with an explicit ``--output``."""
    named = replace(suite(path=path), baseline=Path("a night.json"))
    words = "" if path == SHIPPED else " game.toml"
    assert baseline_command(named) == f"tltlc baseline{words} --output 'a night.json'"
    shipped = replace(named, baseline=default_output(path))
    assert baseline_command(shipped) == f"tltlc baseline{words}"
    assert baseline_command(read_suite(SHIPPED)) == f"tltlc baseline --output {path_text(baseline_path(SHIPPED))}"


@pytest.mark.parametrize("indices", [[], [1], [0, 2], [0, 0], [1, 0]])
def test_missing_or_unordered_episodes_are_rejected(tmp_path: Path, indices: list[int]) -> None:
    path = tmp_path / "game.baseline.json"
    write_baseline(path, (reference(some_episodes(1)), reference([an_episode(index) for index in indices])))
    with pytest.raises(TltlError) as error:
        read_baseline(path)
    (diagnostic,) = error.value.diagnostics
    assert diagnostic.code == "TLT0902"
    assert "baseline.references[1].accounts: the episodes must be numbered from 0 on" in diagnostic.title
