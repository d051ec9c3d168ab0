"""``tltlc list games``."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from tests.interfaces.cli.conftest import Outcome, inside, tltlc  # noqa: F401
from tests.runtime.gymnasium_games import games
from tltl_runtime.stealth.levels.file import level_names, variants

SHIPPED = [("stealth", name, variant, f"{name}.tltl:{name}") for name in level_names() for variant in variants(name)]
CORRIDOR = [
    ("corridor.game.toml", "short", "v0", "corridor.tltl:fetch"),
    ("corridor.game.toml", "short", "v1", "corridor.tltl:fetch"),
    ("corridor.game.toml", "long", "v0", ""),
]


def rows_of(result: Outcome) -> list[tuple[str, ...]]:
    return [tuple(row.values()) for row in json.loads(result.out)]


def test_the_levels_and_the_games_in_the_folder_are_listed(tltlc, inside: Path) -> None:  # type: ignore[no-untyped-def] # noqa: F811
    games.cartpole(inside)
    result: Outcome = tltlc("list", "games", "--json")
    assert result.status == 0
    assert list(json.loads(result.out)[0]) == ["game", "scene", "variant", "spec"]
    assert rows_of(result) == [*SHIPPED, ("cartpole.game.toml", "cartpole", "v0", ""), *CORRIDOR]
    lines = tltlc("list", "games").out.splitlines()
    assert lines[-1] == "corridor.game.toml\tlong\tv0\t"


def test_a_game_is_listed_without_running_its_code(tltlc, inside: Path) -> None:  # type: ignore[no-untyped-def] # noqa: F811
    games.write(inside, corridor__py="raise SystemExit(9)\n")
    assert tltlc("list", "games").status == 0


@pytest.mark.parametrize("folder", ["", "specs"])
def test_the_game_of_the_project_is_listed_once(  # type: ignore[no-untyped-def]
    tltlc,  # noqa: F811
    inside: Path,  # noqa: F811
    monkeypatch: pytest.MonkeyPatch,
    folder: str,
) -> None:
    games.write(inside)
    (inside / "tltl.toml").write_text('game = "corridor.game.toml"\n', encoding="utf-8")
    (inside / "specs").mkdir()
    monkeypatch.chdir(inside / folder)
    listed = [row[1:3] for row in rows_of(tltlc("list", "games", "--json"))]
    assert listed == [row[1:3] for row in (*SHIPPED, *CORRIDOR)]


def test_a_broken_game_is_an_error_and_the_others_are_listed(tltlc, inside: Path) -> None:  # type: ignore[no-untyped-def] # noqa: F811
    games.write(inside)
    (inside / "broken.game.toml").write_text("[game]\n", encoding="utf-8")
    (inside / "tltl.toml").write_text('game = "none.game.toml"\n', encoding="utf-8")
    result: Outcome = tltlc("list", "games", "--json")
    assert result.status == 1
    assert "`[game]` does not say how the environment is made" in result.err
    assert "error[TLT0703]: there is no file `none.game.toml` beside this file" in result.err
    assert rows_of(result) == [*SHIPPED, *CORRIDOR]
