"""``tltlc check --game``; the golden tests of ``tests/golden/game`` cover its messages, too."""

from __future__ import annotations

import json
from pathlib import Path

from tests.interfaces.cli.conftest import Outcome, inside, tltlc  # noqa: F401
from tests.runtime.gymnasium_games import games


def test_all_scenes_and_variants_are_checked_against_their_own_spec(tltlc, inside: Path) -> None:  # type: ignore[no-untyped-def] # noqa: F811
    games.write(inside)
    result: Outcome = tltlc("check", "--game", "corridor.game.toml")
    assert (result.status, result.out) == (0, "")
    assert "short:v0 has the signals that `fetch` uses\n  signals: has_key, door_open, cell\n" in result.err
    assert "observation: Dict(cell: Box(1, float32, 0 to 7), has_key: Discrete(2))\n  action: Discrete(3)" in result.err
    assert "long:v0: the scene does not name a spec; name one before --game" in result.err
    assert result.err.count("equal seeds and actions give equal plays: yes") == 3


def test_a_scene_and_a_variant_can_be_chosen(tltlc, inside: Path) -> None:  # type: ignore[no-untyped-def] # noqa: F811
    games.write(inside)
    assert tltlc("check", "--game", "corridor.game.toml:short").err.count("short:v") == 2
    assert tltlc("check", "--game=corridor.game.toml:short:v1").err.count("short:v1") == 1
    result: Outcome = tltlc("check", "corridor.tltl", "--game", "corridor.game.toml:long")
    assert "long:v0 has the signals that `fetch` uses" in result.err


def test_signals_that_random_play_never_made_true_are_named(tltlc, inside: Path) -> None:  # type: ignore[no-untyped-def] # noqa: F811
    code = games.GRID.replace('"cell": float(game.cell)', '"cell": float(game.cell), "caught": False, "burnt": False')
    games.write(inside, corridor__py=code)
    result: Outcome = tltlc("check", "--game", "corridor.game.toml:short:v0")
    assert "  in 200 random steps, `caught`, `burnt` were never true\n" in result.err


def test_an_artefact_is_checked_against_a_game(tltlc, inside: Path) -> None:  # type: ignore[no-untyped-def] # noqa: F811
    games.write(inside)
    (inside / "other.tltl").write_text("signal has_kee: bool\nspec other = F has_kee\n", encoding="utf-8")
    assert tltlc("compile", "other.tltl", "-t", "json").status == 0
    result: Outcome = tltlc("check", "other.fspa.json", "--game", "corridor.game.toml:long")
    assert result.status == 1
    assert "error[TLT0811]: the scene `long` has no signal `has_kee`\n  help: did you mean `has_key`?" in result.err


def test_the_report_is_one_document_in_json(tltlc, inside: Path) -> None:  # type: ignore[no-untyped-def] # noqa: F811
    noisy = games.GRID.replace("def make(scene", "print('loading')\n\n\ndef make(scene")
    games.write(inside, corridor__py=noisy)
    result: Outcome = tltlc("check", "--game", "corridor.game.toml:short:v0", "--format", "json")
    document = json.loads(result.out)
    assert document["diagnostics"] == []
    (scene,) = document["scenes"]
    assert scene.pop("steps_per_s") > 0
    assert isinstance(scene.pop("advice"), str)
    box = {"type": "box", "low": 0.0, "high": 3.0, "shape": [1], "dtype": "float32"}
    assert scene == {
        "game": "corridor.game.toml",
        "scene": "short",
        "variant": "v0",
        "specs": [{"name": "fetch", "fits": True}],
        "signals": ["has_key", "door_open", "cell"],
        "params": None,
        "clock_s": 0.1,
        "observation": {"type": "dict", "spaces": {"cell": box, "has_key": {"type": "discrete", "n": 2, "start": 0}}},
        "action": {"type": "discrete", "n": 3, "start": 0},
        "capabilities": ["clock", "render"],
        "unchanged": [],
        "standard_error": [],
        "missing": {
            "positions": "reports have no maps, and sentences name no places",
            "cause": "sentences do not say who or what ended an episode",
            "snapshot": "a training replays actions to return to a place",
        },
        "reproducible": True,
        "restores": None,
    }
    assert "::" not in tltlc("check", "--game", "corridor.game.toml:short:v0", "--format", "github").out


def test_a_broken_game_is_an_error_and_the_others_are_checked(tltlc, inside: Path) -> None:  # type: ignore[no-untyped-def] # noqa: F811
    broken = games.GRID.replace("def make(scene, length=5", "def make(scene, length=5 + (1 / (")
    games.write(inside / "broken", corridor__py=broken)
    games.cartpole(inside)
    result: Outcome = tltlc("check", "--game", "broken/corridor.game.toml", "--game", "cartpole.game.toml")
    assert result.status == 1
    assert "error[TLT0780]: the module `corridor` raises SyntaxError" in result.err
    assert "cartpole:v0\n  signals: position, angle\n" in result.err
    assert "Traceback" not in result.err


def test_snapshots_are_compared(tltlc, inside: Path) -> None:  # type: ignore[no-untyped-def] # noqa: F811
    methods = """
    def tltl_snapshot(self):
        import pickle

        return pickle.dumps((self.cell, self.key, self.opened))

    def tltl_restore(self, data):
        import pickle

        self.cell, self.key, self.opened = pickle.loads(data)

    def render(self):
"""
    games.write(inside, corridor__py=games.GRID.replace("\n    def render(self):\n", methods))
    result: Outcome = tltlc("check", "--game", "corridor.game.toml:short:v0")
    assert result.status == 0
    assert "a restored snapshot is what was saved: yes" in result.err


def test_files_outside_the_folder_need_an_option(tltlc, inside: Path) -> None:  # type: ignore[no-untyped-def] # noqa: F811
    (inside / "rules.tltl").write_text(games.SPEC, encoding="utf-8")
    text = games.GAME.replace("corridor.tltl:fetch", "../rules.tltl:fetch")
    games.write(inside / "game", corridor__game__toml=text)
    arguments = ("check", "--game", "game/corridor.game.toml:short:v0")
    refused = tltlc(*arguments).err
    assert "`../rules.tltl` is outside the folder of the game file" in refused
    # Only `check` has the option, so the message gives a help that works for all commands.
    assert "move it into this folder, or the game file into a folder that contains both" in refused
    assert tltlc(*arguments, "--allow-outside").status == 0


def test_a_level_and_a_game_can_be_checked_together(tltlc, inside: Path) -> None:  # type: ignore[no-untyped-def] # noqa: F811
    games.write(inside)
    result: Outcome = tltlc("check", "--level", "navigation:v0", "--game", "corridor.game.toml:short:v0")
    assert result.status == 0
    assert "navigation:v0 supplies" in result.err
    assert "short:v0 has the signals that" in result.err


def test_the_help_has_the_options_for_games_if_there_is_a_game(tltlc, inside: Path) -> None:  # type: ignore[no-untyped-def] # noqa: F811
    assert "--allow-outside" in tltlc("check", "--game", "x", "--help").out
    assert "--allow-outside" not in tltlc("check", "--help").out
