"""Suites and recordings of scenes: what costs one case alone, and what stays open."""

from __future__ import annotations

import json
import sys
from collections.abc import Callable
from importlib.metadata import distribution
from pathlib import Path
from typing import Any

import gymnasium
import pytest

from tests.interfaces.cli.conftest import Outcome, tltlc  # noqa: F401
from tests.runtime.gymnasium_games import games
from tests.runtime.regression.handmade import reference
from tltl_runtime.game.level_name import Variant
from tltl_runtime.gymnasium_games.game_file import read_game_file
from tltl_runtime.gymnasium_games.gymnasium_game import GAME
from tltl_runtime.gymnasium_games.installed_code import installed_code_hash, own_package_files
from tltl_runtime.gymnasium_games.scene_env import SceneEnv
from tltl_runtime.regression.suite.suite import read_suite
from tltl_runtime.regression.verdict.unnamed_changes import unnamed_changes
from tltlc.api import TltlError

Run = Callable[..., Outcome]
SETTINGS = """\
rollout = { envs = 2, steps = 32, workers = 1 }
network.hidden = [8]
exploration.ways = 0
stop.confirmation = 2
"""


@pytest.fixture(name="folder", scope="module")
def _folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder with the corridor, and a policy for it that was trained for a few steps."""
    from tltlc.interfaces.cli.main import main

    folder = tmp_path_factory.mktemp("corridor")
    game = games.write(folder, settings__toml=SETTINGS)
    options = ("--config", folder / "settings.toml", "--steps", "64", "--out", folder / "run")
    with pytest.raises(SystemExit):
        main(["train", "--game", f"{game}:short", *map(str, options)])
    return folder


@pytest.fixture(autouse=True)
def _here(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(folder)


def case(game: str, name: str = "", scene: str = "short") -> str:
    named = f'name = "{name}"\n' if name else ""
    scene_key = f'scene = "{scene}"\n' if scene else ""
    return f'[[case]]\n{named}game = "{game}"\n{scene_key}policy = "run"\nepisodes = 25\n'


def test_a_package_that_one_game_lacks_costs_its_case_alone(
    tltlc: Run,  # noqa: F811
    folder: Path,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    other = games.GAME.replace("corridor:", "other:")
    games.write(folder, other__game__toml=other, other__py=games.GRID)
    (folder / "two.toml").write_text(case("other.game.toml", "other") + case("corridor.game.toml", "own"))
    assert tltlc("baseline", "two.toml", "--workers", "1").status in (0, 1)
    (folder / "other.py").write_text(f"import no_such_package\n{games.GRID}")
    monkeypatch.delitem(sys.modules, "other")
    result = tltlc("regress", "two.toml", "--workers", "1", "--json", "two.json")
    assert result.status == 1, result.err
    first, second = json.loads((folder / "two.json").read_text())["cases"]
    assert first["verdict"] == "fail" and second["pass_rate"] is not None
    assert "TLT0730, the module `no_such_package` is not installed" in " ".join(first["reasons"])


def test_a_variant_says_what_it_changes(folder: Path) -> None:
    (folder / "map.txt").write_text("#")
    own = "variants = { v1 = { options = { length = 8 } } }"
    assert own in games.GAME
    variants = 'variants = { v1 = { options = { length = 6, key = "left" }, files = ["map.txt"] }, v2 = {} }'
    games.write(folder, changed__game__toml=games.GAME.replace(own, variants))
    texts = [GAME.level_files.description("changed.game.toml:short", Variant(name)) for name in ("v0", "v1", "v2")]
    assert texts == ["", '`v1`: `length` = 6, was 4; `key` = "left"; also map.txt', ""]


def test_edits_of_a_package_of_the_user_are_noticed(
    tltlc: Run,  # noqa: F811
    folder: Path,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    package = tmp_path / "own_package"
    package.mkdir()
    (package / "__init__.py").touch()
    (package / "env.py").write_text(games.GRID)
    monkeypatch.syspath_prepend(str(tmp_path))
    games.write(folder, packaged__game__toml=games.GAME.replace("corridor:", "own_package.env:"))
    (folder / "packaged.toml").write_text(case("packaged.game.toml"))
    assert tltlc("baseline", "packaged.toml", "--workers", "1").status in (0, 1)

    def is_played(*options: str) -> bool:
        result = tltlc("regress", "packaged.toml", "--workers", "1", *options)
        return "(as before)" not in result.out and "short:v0" in result.out

    assert [is_played(), is_played()] == [True, False]
    (package / "env.py").write_text(f"{games.GRID}\n# edited\n")
    assert [is_played(), is_played()] == [True, False]
    assert [is_played("--changed", str(package / name)) for name in ("env.py", "__init__.py")] == [False, False]
    chosen = tltlc("regress", "packaged.toml", "--workers", "1", "--changed", str(package / "env.py"))
    assert "left out" not in chosen.err and "short:v0" in chosen.out


def test_a_module_that_moves_to_another_folder_of_a_package_is_noticed(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    for folder in ("first", "second"):
        (tmp_path / "moved_package" / folder).mkdir(parents=True)
    module = tmp_path / "moved_package" / "first" / "env.py"
    module.write_text(games.GRID)
    monkeypatch.syspath_prepend(str(tmp_path))
    text = games.GAME.replace("[game]", '[game]\nimport = ["moved_package"]')
    game = read_game_file(games.write(tmp_path / "game", corridor__game__toml=text))
    before = installed_code_hash(game)
    module.rename(tmp_path / "moved_package" / "second" / "env.py")
    assert installed_code_hash(game) not in ("", before)


def test_an_installed_package_counts_by_what_was_installed(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    game = games.write(tmp_path, corridor__game__toml=games.GAME.replace("[game]", '[game]\nimport = ["click"]'))
    before = installed_code_hash(read_game_file(game))
    assert before and before == installed_code_hash(read_game_file(game))
    assert not [*own_package_files(read_game_file(game))]
    record = (distribution("click").read_text("RECORD") or "") + "click/other.py,sha256=0,0\n"
    monkeypatch.setattr(type(distribution("click")), "read_text", lambda self, name: record)
    assert installed_code_hash(read_game_file(game)) != before
    assert installed_code_hash(read_game_file(games.write(tmp_path / "none"))) == ""


@pytest.mark.parametrize(
    ("clock", "lost", "step"),
    [('clock = "20 Hz"', "", "0.05 s"), ("", "    tltl_clock_s = 0.05\n", "another time")],
    ids=["in the game file", "of the environment"],
)
def test_a_policy_of_another_game_is_named_with_its_scene(
    tltlc: Run,  # noqa: F811
    folder: Path,
    monkeypatch: pytest.MonkeyPatch,
    clock: str,
    lost: str,
    step: str,
) -> None:
    cave = games.GAME.replace("corridor:", "cave:").replace('clock = "10 Hz"', clock).replace('"short"', '"deep"')
    code = games.GRID.replace('    metadata = {"render', f'{lost}    metadata = {{"render')
    monkeypatch.delitem(sys.modules, "cave", raising=False)
    spec = games.SPEC.replace("10 Hz", "20 Hz")
    games.write(folder, cave__game__toml=cave.replace("corridor.tltl", "cave.tltl"), cave__py=code, cave__tltl=spec)
    (folder / "other_game.toml").write_text(case("cave.game.toml", scene="deep"))
    result = tltlc("baseline", "other_game.toml", "--workers", "1")
    assert result.status == 1
    title = "the policy was trained for `short:v0`, whose steps take 0.1 s; it cannot play `deep:v0`, whose steps take"
    assert "error[TLT0843]: " in result.err and f"{title} {step}\n" in result.err
    assert "TLT0617" not in result.err


@pytest.mark.parametrize(
    ("before", "after"),
    [(b"\xe9t\xe9 \x80", b"\xe9t\xe9 \x81"), (b"\xef\xbb\xbf###\r\n", b"\xef\xbb\xbf##\r\n"), (b"\0\r\n", b"\0\r\r")],
    ids=["not UTF-8", "byte order mark", "binary"],
)
def test_a_file_counts_as_changed_only_if_its_bytes_have_changed(folder: Path, before: bytes, after: bytes) -> None:
    (folder / "map.txt").write_bytes(before)
    games.write(folder, corridor__game__toml=games.GAME.replace('"short"', '"short"\nfiles = ["map.txt"]'))
    (folder / "maps.toml").write_text(case("corridor.game.toml"))
    suite = read_suite(folder / "maps.toml")
    files = GAME.load_level("corridor.game.toml:short").files
    references = (reference(level="short", files=files, place="corridor.game.toml:short"),)
    assert "map.txt" in dict(files)
    assert unnamed_changes(suite, suite.cases, references) == {}
    (folder / "map.txt").write_bytes(after)
    assert unnamed_changes(suite, suite.cases, references) == {"map.txt": ("short:v0",)}


def test_a_case_without_a_scene_has_the_name_of_the_first_scene(folder: Path) -> None:
    (folder / "first.toml").write_text(case("corridor.game.toml", scene=""))
    assert [suite_case.name for suite_case in read_suite(folder / "first.toml").cases] == ["short:v0"]


def test_a_game_without_a_clock_is_evaluated_recorded_and_tested(tltlc: Run, folder: Path) -> None:  # noqa: F811
    (folder / "timeless.game.toml").write_text(games.GAME.replace('clock = "10 Hz"\n', ""))
    scene = ("--game", "timeless.game.toml:short")
    options = ("--episodes", 3, "--record", "all", "--out", "timeless", "--json", "timeless.json")
    result = tltlc("evaluate", "run", *scene, *options)
    assert result.status == 0, result.err
    episodes = json.loads((folder / "timeless.json").read_text())["episodes"]
    assert all(episode["seconds"] == episode["steps"] > 0 for episode in episodes)
    recorded = [GAME.read_episode(path) for path in sorted((folder / "timeless").glob("*-sampled.episode.npz"))]
    assert [episode.times[-1] for episode in recorded] == [episode["seconds"] for episode in episodes]
    (folder / "timeless.toml").write_text(case("timeless.game.toml", "timeless"))
    for command in (("baseline",), ("regress", "--fresh", "--json", "timeless.json")):
        result = tltlc(*command, "timeless.toml", "--workers", 1)
        assert result.status in (0, 1), result.err
    (report,) = json.loads((folder / "timeless.json").read_text())["cases"]
    assert report["pass_rate"] is not None


def test_positions_without_an_outline_get_a_map(tltlc: Run, folder: Path) -> None:  # noqa: F811
    (folder / "placed.game.toml").write_text(games.GAME.replace("corridor:", "placed:"))
    positions = 'def tltl_positions(self):\n        return {"player": (self.cell, 0.5)}\n\n    def render'
    (folder / "placed.py").write_text(games.GRID.replace("def render", positions))
    (folder / "placed.toml").write_text(case("placed.game.toml", "placed"))
    for command in (("baseline",), ("regress", "--fresh", "--html", "placed.html")):
        result = tltlc(*command, "placed.toml", "--workers", 1)
        assert result.status in (0, 1), result.err
    page = (folder / "placed.html").read_text(encoding="utf-8")
    assert "<h3>Map</h3>" in page and "The game gives positions, but no outline" in page
    assert "<h3>Episodes</h3>" in page and 'class="film"' in page, "the map takes nothing away"
    assert "There is no map" not in page


@pytest.mark.slow
def test_a_baseline_with_which_no_case_can_pass_says_so(tltlc: Run, folder: Path) -> None:  # noqa: F811
    strict = "thresholds = { pass_rate = 0.999 }\n"
    (folder / "strict.toml").write_text(case("corridor.game.toml") + strict)
    result = tltlc("baseline", "strict.toml", "--workers", "1")
    assert result.status == 1
    assert result.err.endswith("none of the cases can pass with this baseline, even if nothing changes\n")
    assert (folder / "strict.baseline.json").exists()


class Unrecordable(SceneEnv):
    """A scene whose actions cannot be recorded; it counts how often it is closed."""

    closed = 0

    def __init__(self, env: gymnasium.Env[Any, Any], *rest: Any) -> None:
        super().__init__(env, *rest)
        self.action_space = gymnasium.spaces.Text(8)

    def close(self) -> None:
        Unrecordable.closed += 1
        super().close()


@pytest.mark.parametrize(
    "arguments",
    [
        ("play", "corridor.game.toml:short"),
        ("record", "corridor.game.toml:short"),
        ("record", "corridor.game.toml:short", "--by", "keyboard"),
        ("demonstrate", "corridor.game.toml:short"),
    ],
    ids=" ".join,
)
def test_an_environment_that_cannot_be_recorded_is_closed(
    tltlc: Run,  # noqa: F811
    monkeypatch: pytest.MonkeyPatch,
    arguments: tuple[str, ...],
) -> None:
    monkeypatch.setattr("tltl_runtime.gymnasium_games.scene_env.SceneEnv", Unrecordable)
    monkeypatch.setattr(Unrecordable, "closed", 0)
    result = tltlc(*arguments)
    assert "error[TLT0844]" in result.err
    assert result.status in (1, 2) and Unrecordable.closed == 1


def test_a_policy_that_does_not_fit_closes_the_environment(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    from tltl_runtime.evaluation.evaluate import set_up
    from tltl_runtime.evaluation.player import PolicyPlayer
    from tltl_runtime.policies.file import read_policy

    setup = set_up(read_policy(folder / "run" / "policy.safetensors"), "corridor.game.toml:short", "v0", None, 0, "all")
    monkeypatch.setattr("tltl_runtime.gymnasium_games.scene_env.SceneEnv", Unrecordable)
    monkeypatch.setattr(Unrecordable, "closed", 0)
    with pytest.raises(TltlError, match="TLT084"):
        PolicyPlayer(setup)
    assert Unrecordable.closed == 1
