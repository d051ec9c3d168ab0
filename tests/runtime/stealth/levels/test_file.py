from __future__ import annotations

import math
import os
import pickle
import random
import re
import shutil
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest

import tltlc
from tests.golden.cases import Case, cases
from tltl_runtime.game.level import default_spec
from tltl_runtime.stealth.level import Box, Solid, StealthLevel, entity_names
from tltl_runtime.stealth.levels.default_spec import LEVELS
from tltl_runtime.stealth.levels.file import level_names, load_level, variants
from tltlc.diagnostics.diagnostic import TltlError
from tltlc.diagnostics.render import render

CASES = cases("level")
SHIPPED = [(name, variant) for name in level_names() for variant in variants(name)]
ROOM = """doc = "A room."
[bounds]
at = [5.0, 5.0, -0.5]
size = [10.0, 10.0, 4.5]
[start]
at = [2.0, 2.0, 0.0]
"""


@pytest.fixture(name="folder")
def _folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Path]:
    monkeypatch.chdir(tmp_path)
    yield tmp_path


def solid(level: StealthLevel, name: str) -> Solid:
    (match,) = (candidate for candidate in level.solids if candidate.name == name)
    return match


def write(path: str, text: str) -> None:
    Path(path).parent.mkdir(exist_ok=True)
    Path(path).write_text(text, encoding="utf-8")


@pytest.mark.parametrize("case", CASES, ids=lambda case: case.name)
def test_an_invalid_level_gives_the_expected_message(case: Case, folder: Path) -> None:
    case.unpack(folder / "case")
    os.chdir(folder / "case")
    _, _, *arguments = case.arguments
    with pytest.raises(TltlError) as error:
        load_level(*arguments)
    text = render(error.value.diagnostics)
    case.check(text)
    assert case.name[:7] in text
    # Each message has a help, and a location unless it is about an argument.
    messages = re.split(r"^(?=error\[)", text, flags=re.MULTILINE)[1:]
    assert all("  help: " in message for message in messages)
    assert all(re.search(r"\.toml:\d+:\d+\n", message) for message in messages) or arguments == ["navigaton", "v0"]


def test_the_first_variants_of_the_levels_of_the_paper_are_those_of_its_table() -> None:
    levels = "branching", "cover_and_hide", "navigation"
    assert set(levels) <= set(level_names())
    assert {name: variants(name)[:3] for name in levels} == dict.fromkeys(levels, ("v0", "v1", "v2"))


@pytest.mark.parametrize(("name", "variant"), SHIPPED)
def test_a_shipped_level_has_the_signals_and_entities_of_its_spec(name: str, variant: str) -> None:
    level = load_level(name, variant)
    assert (level.name, level.variant) == (name, variant)
    assert level.spec is not None
    fspa = next(automaton for automaton in tltlc.compile_file(level.spec.file) if automaton.name == level.spec.name)
    signals = {signal.name for signal in fspa.signals}
    plain_signals = {signal for signal in signals if "(" not in signal} - {"health"}
    assert plain_signals <= {alias for alias, _ in level.signals}
    entities = {argument for signal in signals for argument in re.findall(r"\((\w+)\)", signal)}
    assert entities and entities <= set(entity_names(level))
    assert pickle.loads(pickle.dumps(level)) == level


def test_the_variants_differ_as_in_the_paper() -> None:
    boxes = [solid(load_level("navigation", variant), "corridor_block_2").box for variant in ("v0", "v1", "v2")]
    gaps = [max(4.5 - box.high[1], box.low[1] - 0.5) for box in boxes]
    assert gaps[0] > gaps[1] > 0.9
    assert gaps[2] == pytest.approx(0.0)

    guards = [load_level("cover_and_hide", variant).enemies[0].kind for variant in ("v0", "v1", "v2")]
    assert guards[1].sight_range > guards[0].sight_range
    assert guards[1].reaction_time < guards[0].reaction_time
    assert [guard.branches for guard in guards] == [(), (), ("check_gaps",)]
    assert guards[0].sight_angle == pytest.approx(math.pi / 2)

    branching = [load_level("branching", variant) for variant in ("v0", "v1", "v2")]
    heights = [{point[2] for mover in level.movers for point in mover.path} for level in branching]
    assert max(heights[1]) > max(max(heights[0]), 0.6) - 0.6 and len(heights[1]) > len(heights[0])
    # One asset serves two levels: the same edit changes both.
    assert [level.enemies[0].kind for level in branching] == guards


def test_variants_share_all_parts_that_they_do_not_change() -> None:
    first, second = load_level("navigation"), load_level("navigation", "v2")
    changed = {before.name for before, after in zip(first.solids, second.solids, strict=True) if before != after}
    assert changed == {"corridor_block_2"}
    assert first.switches == second.switches
    names = [name for name, _ in second.files]
    assert names == ["navigation.toml", "assets/corridor.toml", "overlays/corridor_shut.toml"]
    assert dict(first.files)["navigation.toml"] == dict(second.files)["navigation.toml"]


@pytest.mark.parametrize(("name", "variant"), SHIPPED)
def test_solids_of_a_shipped_level_do_not_overlap_its_barriers(name: str, variant: str) -> None:
    level = load_level(name, variant)
    for barrier in level.barriers:
        for obstacle in level.solids:
            is_apart = any(
                obstacle.box.high[axis] <= barrier.box.low[axis] or barrier.box.high[axis] <= obstacle.box.low[axis]
                for axis in range(3)
            )
            assert is_apart, (barrier.name, obstacle.name)


@pytest.mark.parametrize("line", ['spec = "{}.tltl:careful"\n{}', '{1}[[use]]\nasset = "{0}"\n'])
def test_names_too_long_for_a_file_are_reported_as_missing(folder: Path, line: str) -> None:
    write("long.toml", line.format("a" * 300, ROOM))
    with pytest.raises(TltlError, match=r"TLT0805: there is no .*`aaa"):
        load_level("long.toml")
    with pytest.raises(TltlError, match="TLT0800: there is no level `aaa"):
        load_level("a" * 300)


def test_stairs_floor_and_outer_walls_are_solids_of_the_level(folder: Path) -> None:
    write("room.toml", ROOM + "[[stairs]]\nfrom = [8.0, 5.0, 0.0]\nto = [6.0, 5.0, 0.5]\nwidth = 1.0\nsteps = 2\n")
    level = load_level("room.toml")
    assert solid(level, "stairs_1_1").box == Box((7.0, 4.5, 0.0), (8.0, 5.5, 0.25))
    assert solid(level, "stairs_1_2").box == Box((6.0, 4.5, 0.0), (7.0, 5.5, 0.5))
    assert solid(level, "floor").box == Box((0.0, 0.0, -0.5), (10.0, 10.0, 0.0))
    assert solid(level, "outer_east").box == Box((9.8, 0.0, 0.0), (10.0, 10.0, 4.0))
    assert level.spec is None and level.variant == "v0"
    assert level.sensors.map is None


def test_a_level_can_use_assets_and_overlays_of_its_own_and_of_the_package(folder: Path) -> None:
    write("assets/bar.toml", BAR)
    write(
        "overlays/quick.toml",
        "[change.bar.bar]\nspeed = 2.0\n[[add.bar.low]]\nname = 'more'\nat = [2, 0, 0]\nsize = [1, 1, 1]\n",
    )
    write(
        "room.toml",
        ROOM
        + """[variants]
v0 = []
quick = ["quick", "guard_thorough"]
[[use]]
asset = "bar"
name = "first"
at = [4.0, 4.0, 0.5]
[[use]]
asset = "bar"
name = "second"
at = [4.0, 7.0, 0.0]
[[enemy]]
name = "guard"
kind = "guard"
route = [[8.0, 8.0, 0.0]]
""",
    )
    level, quick = load_level("room.toml"), load_level("room.toml", "quick")
    assert variants("room.toml") == ("v0", "quick")
    assert [mover.name for mover in level.movers] == ["first_bar", "second_bar"]
    assert level.movers[0].path == ((4.0, 4.0, 0.75), (5.0, 4.0, 0.75))
    assert [mover.speed for mover in quick.movers] == [2.0, 2.0]
    assert solid(quick, "second_more").box == Box((5.5, 6.5, 0.0), (6.5, 7.5, 1.0))
    assert quick.enemies[0].kind.branches == ("check_gaps",)


BAR = """doc = "A bar."
type = "part"
[[mover]]
name = "bar"
size = [1.0, 0.5, 0.5]
path = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0]]
speed = 1.0
[[low]]
name = "stump"
at = [0.0, 1.0, 0.0]
size = [0.5, 0.5, 0.5]
"""


@pytest.mark.parametrize("name", ["../navigation", "/etc/passwd", "", ".", "navigation.toml.txt"])
def test_names_without_a_level_are_rejected(name: str) -> None:
    with pytest.raises(TltlError):
        load_level(name)


def test_labels_are_correct_in_unusual_toml(folder: Path) -> None:
    text = 'doc = """a [[wall]]\n= "]" # no comment"""  # a [comment]\n' + ROOM.partition("\n")[2]
    text += "[sensors] # [x]\nentities = [\n  # ] ,\n  'exit' ]\n"
    text += "map.cell = 0.5\nmap . \"extent\" = 15\nmap.types = ['wool']\n"
    write("room.toml", text)
    with pytest.raises(TltlError) as error:
        load_level("room.toml")
    labels = [(d.labels[0].source.slice(d.labels[0].span), d.title) for d in error.value.diagnostics]
    assert labels == [("map.types", "there is no cell type `wool`"), ("entities", "there is no entity `exit`")]


def test_loading_a_level_loads_no_physics() -> None:
    code = (
        "import sys; from tltl_runtime.stealth.levels.file import load_level; load_level('branching', 'v2');"
        "print(sorted({'pybullet', 'torch', 'matplotlib'} & set(sys.modules)))"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout == "[]\n"


def test_every_asset_and_overlay_is_used() -> None:
    used = {name for level, variant in SHIPPED for name, _ in load_level(level, variant).files}
    assert used == {str(path.relative_to(LEVELS)) for path in LEVELS.rglob("*.toml")}


def test_the_level_in_the_reference_loads_and_every_key_is_documented(folder: Path) -> None:
    text = (LEVELS.parents[2] / "docs" / "levels.md").read_text(encoding="utf-8")
    level, overlay = re.findall(r"```toml\n(.*?)```", text, re.DOTALL)
    (spec,) = re.findall(r"```tltl\n(.*?)```", text, re.DOTALL)
    starter = LEVELS.parent / "starter"
    assert (level, spec) == tuple((starter / name).read_text(encoding="utf-8") for name in ("vault.toml", "vault.tltl"))
    write("vault.toml", level.replace('v1 = ["guard_alert"]', 'v1 = ["guard_alert"]\nv2 = ["changes"]') + CRATES)
    write("vault.tltl", spec)
    write("overlays/changes.toml", overlay)
    assert load_level("vault.toml", "v2").enemies[0].kind.branches == ("check_gaps",)
    assert default_spec(load_level("vault.toml", "v1")).endswith("vault.tltl:unseen")
    modules = ("level_tables", "file", "default_spec", "regions")
    sources = [LEVELS.parent / "stealth" / "levels" / f"{name}.py" for name in modules]
    keys = {
        key
        for source in sources
        for key in re.findall(
            r"\.(?:number|whole|text|flag|names|points?|tables?)\(\"(\w+)\"", source.read_text(encoding="utf-8")
        )
    }
    assert len(keys) > 35
    missing = [key for key in sorted(keys) if not re.search(rf"`{key}`|`\[+(sensors\.)?{key}\]+`", text)]
    assert not missing


CRATES = '[[use]]\nasset = "crates"\nat = [5.0, 4.6, 0.0]\n'


DAMAGE = ["[", "]", "[[", "]]", "=", '"', "{", "}", "-", "nan", "[]", "{}", "''", "true", "1979-05-27", "[[1,2,3]]"]
DAMAGE += ["[{a=1}]", "\n", "name", "[sensors.map]\n", "[[use]]\n", "[variants.v0]\n", "[change.guard]\n", "#", "1e300"]


@pytest.mark.parametrize("seed", range(4))
@pytest.mark.parametrize(
    "file", ["branching.toml", "assets/guard.toml", "assets/crates.toml", "overlays/guard_alert.toml"]
)
def test_damaged_files_are_loaded_or_rejected_with_diagnostics(file: str, seed: int, folder: Path) -> None:
    shutil.copytree(LEVELS, folder / "levels")
    lines = (LEVELS / file).read_text(encoding="utf-8").split("\n")
    draw = random.Random(seed)
    rejected = 0
    for _ in range(15):
        damaged = list(lines)
        for _ in range(draw.randint(1, 3)):
            row, piece = draw.randrange(len(damaged)), draw.choice(DAMAGE)
            key, equals, _ = damaged[row].partition("=")
            column = draw.randrange(len(damaged[row]) + 1)
            inside = damaged[row][:column] + piece + damaged[row][column:]
            damaged[row] = draw.choice(
                [f"{key}= {piece}" if equals else piece, inside, "", f"{damaged[row]}\n{piece} = 1"]
            )
        (folder / "levels" / file).write_text("\n".join(damaged), encoding="utf-8")
        try:
            load_level("levels/branching.toml", "v1")
        except TltlError as error:
            rejected += 1
            for diagnostic in error.diagnostics:
                assert all(
                    0 <= label.span.start <= label.span.end <= len(label.source.text) for label in diagnostic.labels
                )
            assert render(error.diagnostics)
    assert rejected > 0
