from __future__ import annotations

import sys
from pathlib import Path

import pytest

from tests.runtime.gymnasium_games import games
from tltl_runtime.gymnasium_games.game_file import read_game_file
from tltl_runtime.gymnasium_games.python_files import python_files
from tltl_runtime.gymnasium_games.scene_hash import scene_hash
from tltlc.api import TltlError

MAPS = games.GAME.replace('name = "short"', 'name = "short"\nfiles = ["map.txt"]')
FILES = {"corridor__game__toml": MAPS, "map__txt": "#####\n"}


def hash_of(folder: Path, scene: str = "short", variant: str = "v0", **files: str) -> str:
    return scene_hash(read_game_file(games.write(folder, **{**FILES, **files})), scene, variant)


def test_a_hash_depends_on_what_can_change_an_episode(tmp_path: Path) -> None:
    changes = {
        "option": {"corridor__game__toml": MAPS.replace("length = 4", "length = 5")},
        "clock": {"corridor__game__toml": MAPS.replace("10 Hz", "20 Hz")},
        "observation": {"corridor__game__toml": MAPS.replace(', "has_key"]', "]")},
        "file": {"map__txt": "####\n"},
        "module": {"corridor__py": games.GRID.replace("(0, 1, -1)", "(0, 2, -1)")},
    }
    hashes = [hash_of(tmp_path / name, **files) for name, files in changes.items()]
    others = [hash_of(tmp_path / "variant", variant="v1"), hash_of(tmp_path / "scene", "long")]
    assert len({*hashes, *others, hash_of(tmp_path / "same")}) == len(changes) + 3
    assert "corridor" not in sys.modules or not getattr(sys.modules["corridor"], "__file__", "").startswith(
        str(tmp_path)
    )


def test_a_hash_does_not_depend_on_the_spec_the_folder_or_other_scenes(tmp_path: Path) -> None:
    changes = {
        "spec": {"corridor__tltl": games.SPEC.replace("20 s", "10 s")},
        "no_spec": {"corridor__game__toml": MAPS.replace('spec = "corridor.tltl:fetch"\n', "")},
        "comment": {"corridor__game__toml": f"# A game.\n{MAPS}"},
        "other_scene": {"corridor__game__toml": MAPS.replace("length = 30", "length = 31")},
        "other_file": {"tool__py": "raise SystemExit\n"},
        "line_ends": {"map__txt": "#####\r\n"},
    }
    assert {hash_of(tmp_path / name, **files) for name, files in changes.items()} == {hash_of(tmp_path / "same")}


def test_imported_files_are_found_without_running_them(tmp_path: Path) -> None:
    files = {
        "game.py": "import numpy, maps.small\nfrom rules import doors as d\nregister(entry_point='engine:Env')\n",
        "maps/__init__.py": "",
        "maps/small.py": "from . import sizes\nfrom .shapes.boxes import *\n",
        "maps/sizes.py": "def late():\n    import walls\n",
        "maps/shapes/boxes.py": "this is not Python",
        "rules/doors.py": "raise SystemExit\n",
        "engine.py": "import game\n",
        "walls.py": "\r\n",
        "unused.py": "",
        "maps/unused.py": "",
    }
    for name, text in files.items():
        path = tmp_path / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_bytes(text.encode())
    contents = python_files(tmp_path, ["game", "numpy"])
    assert list(contents) == sorted(name for name in files if "unused" not in name)
    assert contents["walls.py"] == b"\n"


@pytest.mark.parametrize(
    ("text", "followed"),
    [
        ("from maps import *", {"maps/small.py", "maps/large.py"}),
        ("from maps import rooms", set()),
        ("import importlib\nimportlib.import_module('.small', 'maps')", {"maps/small.py"}),
        ("from maps.rooms import load", {"maps/rooms/__init__.py", "maps/rooms/crypt.py", "maps/large.py"}),
        ("from importlib import import_module\nimport_module(name, package='maps')", set()),
        ("from maps import *\nimport_module('...x', __package__)", {"maps/small.py", "maps/large.py"}),
    ],
)
def test_modules_that_are_offered_or_relative_are_followed(tmp_path: Path, text: str, followed: set[str]) -> None:
    files = {
        "game.py": text,
        "maps/__init__.py": "__all__ = ['small', 'no name', 'nothing']\n__all__ += ['large']\n",
        "maps/small.py": "",
        "maps/large.py": "",
        "maps/unused.py": "",
        "maps/rooms/__init__.py": "import_module('.crypt', __package__), import_module('..large', package=__package__)",
        "maps/rooms/crypt.py": "",
    }
    for name, content in files.items():
        path = tmp_path / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(content)
    always = {"game.py"} | ({"maps/__init__.py"} if "from maps" in text or "maps')" in text else set())
    files = set(python_files(tmp_path, ["game"]))
    if text == "from maps import rooms":
        followed = {"maps/rooms/__init__.py", "maps/rooms/crypt.py", "maps/large.py"}
    assert files == always | followed


def test_a_file_that_has_gone_is_an_error(tmp_path: Path) -> None:
    game = read_game_file(games.write(tmp_path, **FILES))
    (tmp_path / "map.txt").unlink()
    with pytest.raises(TltlError, match="TLT0001"):
        scene_hash(game, "short")
