"""Whoever follows the help of a warning about a path gets rid of the warning."""

from __future__ import annotations

from pathlib import Path

import pytest

from tltl_runtime.stealth.levels.file import read_level
from tltlc.api import Diagnostic

ROOM = """\
doc = "a room"
[bounds]
at = [5.0, 5.0, -0.5]
size = [10.0, 10.0, 4.5]
[start]
at = [2.0, 2.0, 0.0]
spread = 0.1
[[enemy]]
name = "guard"
kind = "guard"
"""


def warnings_of(folder: Path, text: str) -> tuple[Diagnostic, ...]:
    path = folder / "room.toml"
    path.write_text(ROOM + text, encoding="utf-8")
    return read_level(str(path))[1]


@pytest.mark.parametrize("west", [5.0, 5.04, 5.08, 5.12, 5.16, 5.2, 5.24])
def test_an_enemy_can_walk_through_a_way_of_the_width_in_the_help(west: float, tmp_path: Path) -> None:
    def walls(width: float) -> str:
        ends = ((0.2, west), (west + width, 9.8))
        return "".join(f"[[wall]]\nat = [{(a + b) / 2}, 7.0, 0.0]\nsize = [{b - a}, 0.2, 3.0]\n" for a, b in ends)

    route = "route = [[8.0, 3.0, 0.0], [6.0, 8.5, 0.0]]\n"
    (warning,) = warnings_of(tmp_path, route + walls(0.5))
    assert warning.title == "`guard` cannot walk to [6, 8.5, 0]"
    assert warning.help == "it would walk as near as it can; leave out the point, or make a way that is 1 m wide"
    assert warnings_of(tmp_path, route + walls(1.0)) == ()


def test_an_enemy_beyond_the_distance_in_the_help_cannot_hit_the_player_at_once(tmp_path: Path) -> None:
    # The wall hides the player from the enemy, but the warning counts only the distance.
    wall = "[[wall]]\nat = [2.0, 2.6, 0.0]\nsize = [3.0, 0.1, 3.0]\n"
    (warning,) = warnings_of(tmp_path, f"route = [[2.0, 3.2, 0.0]]\n{wall}")
    assert warning.title == "`guard` begins where it can hit the player at once, 1.1 m from the start"
    assert warning.help == "begin its `route` more than 1.3 m from the start"
    assert warnings_of(tmp_path, f"route = [[2.0, 3.31, 0.0]]\n{wall}") == ()
