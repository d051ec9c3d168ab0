"""A scene that pygame draws is drawn without a screen, and without messages of the system."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest

from tests.waiting import HANG_S

pytest.importorskip("pygame")
pytest.importorskip("gymnasium")

_DRAW = """
import sys
from pathlib import Path
from tltl_runtime.gymnasium_games.game_file import read_game_file
from tltl_runtime.gymnasium_games.scene_env import make_base_env
env = make_base_env(read_game_file(Path(sys.argv[1])), "walk", render_mode="rgb_array")
env.reset(seed=0)
print(env.render().shape[2])
env.close()
"""


@pytest.mark.skipif(sys.platform != "linux", reason="the message is that of Linux")
@pytest.mark.parametrize("driver", [{}, {"SDL_VIDEODRIVER": ""}])
def test_a_frame_is_drawn_without_messages_of_the_system(tmp_path: Path, driver: dict[str, str]) -> None:
    (tmp_path / "walk.py").write_text("def signals(env):\n    return {'at_goal': env.unwrapped.s == 47}\n")
    game = tmp_path / "walk.game.toml"
    game.write_text(
        '[game]\ngymnasium = "CliffWalking-v1"\nsignals = "walk:signals"\n\n[[scene]]\nname = "walk"\n',
        encoding="utf-8",
    )
    without = ("DISPLAY", "WAYLAND_DISPLAY", "XDG_RUNTIME_DIR", "SDL_VIDEODRIVER")
    environment = {name: value for name, value in os.environ.items() if name not in without}
    result = subprocess.run(
        [sys.executable, "-c", _DRAW, str(game)],
        capture_output=True,
        text=True,
        env={**environment, **driver},
        timeout=HANG_S,
        check=False,
    )
    assert result.stdout == "3\n", result.stderr
    assert result.stderr == ""
