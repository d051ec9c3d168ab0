"""``tltlc new --level``: a copy of a shipped level for a designer to change."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
import pytest

from tests.interfaces.cli.conftest import Outcome, inside, tltlc  # noqa: F401
from tltl_runtime.cli.support.level_copy import NAMES
from tltl_runtime.game.level import LevelSpec
from tltl_runtime.stealth.capabilities.reach import compute_reach
from tltl_runtime.stealth.levels.file import load_level
from tltl_runtime.stealth.recordings.file import read_episode


@pytest.mark.parametrize("name", NAMES)
def test_a_copy_is_complete(tltlc, inside: Path, name: str) -> None:  # type: ignore[no-untyped-def] # noqa: F811
    created: Outcome = tltlc("new", "mine", "--level", name)
    assert created.status == 0
    assert created.err.endswith(f"Next: tltlc check --level mine/{name}.toml\n")
    level = load_level(f"mine/{name}.toml")
    assert level.spec == LevelSpec(Path(f"mine/{name}.tltl"), "unseen" if name == "vault" else name)
    assert all((Path("mine") / file).is_file() for file, _ in level.files)
    texts = [path.read_text(encoding="utf-8") for path in Path("mine").rglob("*.t*l")]
    named = re.findall(r"\b(?:assets|overlays)/\w+\.toml", "".join(texts))
    assert all((Path("mine") / file).is_file() for file in named)
    assert bool(named) == (name == "vault")
    assert not any("comes with tltlc" in text for text in texts)
    assert tltlc("test", f"mine/{name}.tltl").status == 0
    checked: Outcome = tltlc("check", "--level", f"mine/{name}.toml:v0")
    assert checked.status == 0
    assert "warning" not in checked.err
    assert "(nothing to report)" in checked.err


def test_a_copy_can_be_renamed(tltlc, inside: Path) -> None:  # type: ignore[no-untyped-def] # noqa: F811
    tltlc("new", "mine", "--level", "vault")
    Path("mine").rename("yours")
    spec = Path("yours/vault.toml").rename("yours/cellar.toml").with_name("vault.tltl")
    spec.write_text(spec.read_text(encoding="utf-8").replace("level vault", "level cellar"), encoding="utf-8")
    checked: Outcome = tltlc("check", "--level", "yours/cellar.toml")
    assert checked.status == 0
    assert "warning" not in checked.err and "cellar:v1 supplies lever" in checked.err
    overlay = Path("yours/overlays/guard_alert.toml")
    overlay.write_text(overlay.read_text(encoding="utf-8").replace("sight_range = 9.5", "sight_range = 5"))
    assert load_level("yours/cellar.toml", "v1").enemies[0].kind.sight_range == 5.0


def test_a_similar_level_is_suggested(tltlc, inside: Path) -> None:  # type: ignore[no-untyped-def] # noqa: F811
    result: Outcome = tltlc("new", "mine", "--level", "valt")
    assert (result.status, Path("mine").exists()) == (2, False)
    assert result.err == "error[TLT0800]: there is no level `valt` to copy\n  help: did you mean `vault`?\n"


def test_the_vault_requires_hiding_and_opening_the_door(tltlc, inside: Path) -> None:  # type: ignore[no-untyped-def] # noqa: F811
    tltlc("new", "mine", "--level", "vault")
    level = Path("mine/vault.toml")
    for variant in ("v0", "v1"):
        assert tltlc("demonstrate", f"{level}:{variant}", "--episodes", "2").status == 0
        assert tltlc("demonstrate", f"{level}:{variant}", "--careless", "-o", "careless").status == 1
        episode = read_episode(Path(f"demonstrations/vault-{variant}-0.episode.npz"))
        names = [signal.name for signal in episode.fspa.signals]
        lever = np.asarray(episode.signals)[:, names.index("distance(lever)")]
        assert lever.min() <= 1.0
    level.write_text(level.read_text().replace("at = [10.5, 1.5, 0.0]", "at = [10.5, 9.2, 0.0]"))
    assert not compute_reach(load_level(str(level))).reaches("exit")
    message = "`door` stays shut: it is opened by `lever`, which is behind it"
    assert message in tltlc("check", "--level", level).err


def test_a_user_level_may_use_a_shipped_spec(tltlc, inside: Path) -> None:  # type: ignore[no-untyped-def] # noqa: F811
    tltlc("new", "mine", "--level", "navigation")
    Path("mine/navigation.toml").rename("mine/second.toml")
    Path("mine/navigation.tltl").unlink()
    result: Outcome = tltlc("check", "--level", "mine/second.toml:v0")
    assert result.status == 0
    assert "help: this spec comes with tltlc: `tltlc new FOLDER --level navigation` copies it with its" in result.err
