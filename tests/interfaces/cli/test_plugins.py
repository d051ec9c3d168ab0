"""Plugins that other distributions add through entry points: commands, and options for levels."""

from __future__ import annotations

import sys
import zipfile
from pathlib import Path

import pytest

from tests.interfaces.cli.conftest import ROOT
from tltlc.interfaces.cli.command_line import RUNTIME_COMMANDS

if sys.version_info >= (3, 11):
    import tomllib as tomli
else:
    import tomli

CODE = "import click\n\n@click.command()\ndef command():\n    'Dance.'\n    print('dancing')\n    return 0\n"


@pytest.fixture
def installed(tmp_path: Path) -> str:
    """A folder with a distribution of two commands; one of them lacks a module."""
    info = tmp_path / "dancer-1.0.dist-info"
    info.mkdir()
    (info / "METADATA").write_text("Metadata-Version: 2.1\nName: dancer\nVersion: 1.0\n")
    (info / "entry_points.txt").write_text(
        "[tltlc.commands]\ndance = dancer_module:command\nwaltz = waltz_module:command [rl]\n"
    )
    (tmp_path / "dancer_module.py").write_text(CODE)
    (tmp_path / "waltz_module.py").write_text("import a_module_that_nobody_has\n")
    return f"{ROOT}:{tmp_path}"


def test_a_command_of_a_plugin_runs(process, installed: str) -> None:  # type: ignore[no-untyped-def]
    assert process("dance", PYTHONPATH=installed).out == "dancing\n"
    assert "dance" in process("--help", PYTHONPATH=installed).out
    assert "did you mean `dance`?" in process("danec", PYTHONPATH=installed).err.lower()


def test_help_imports_no_plugin(process, installed: str) -> None:  # type: ignore[no-untyped-def]
    outcome = process("--help", PYTHONPATH=installed)
    assert outcome.status == 0
    assert "(needs the extra rl)" in outcome.out


def test_built_in_plugins_are_known_and_need_an_extra() -> None:
    project = tomli.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]
    groups = project["entry-points"]
    assert groups["tltlc.commands"].keys() == RUNTIME_COMMANDS.keys()
    own = [entry for name, group in groups.items() if name.startswith("tltlc.") for entry in group.values()]
    assert all(entry.endswith((" [game]", " [rl]")) for entry in own)


def test_a_missing_component_exits_with_4(process, installed: str) -> None:  # type: ignore[no-untyped-def]
    outcome = process("waltz", PYTHONPATH=installed)
    assert outcome.status == 4
    assert outcome.err == (
        "error[TLT0730]: `tltlc waltz` needs `a_module_that_nobody_has`, which is not installed\n"
        "  help: pip install 'dancer[rl]'\n"
    )


def test_an_archive_may_contain_plugins(process, installed: str, tmp_path: Path) -> None:  # type: ignore[no-untyped-def]
    archive = tmp_path / "dancer.zip"
    with zipfile.ZipFile(archive, "w") as file:
        for path in sorted(tmp_path.rglob("*.*")):
            if path.is_file() and path != archive:
                file.write(path, path.relative_to(tmp_path))
    assert process("dance", PYTHONPATH=f"{ROOT}:{archive}").out == "dancing\n"


def test_the_first_of_two_distributions_of_the_same_name_is_used(process, installed: str, tmp_path: Path) -> None:  # type: ignore[no-untyped-def]
    older = tmp_path / "older"
    info = older / "dancer-0.1.dist-info"
    info.mkdir(parents=True)
    (info / "entry_points.txt").write_text("[tltlc.commands]\ndance = nothing:command\njig = nothing:command\n")
    assert process("dance", PYTHONPATH=f"{installed}:{older}").out == "dancing\n"
    assert "jig" not in process("--help", PYTHONPATH=f"{installed}:{older}").out


LEVELS = """import click

@click.command()
@click.option("--map")
def command(levels, inputs, settings, report, map):
    print(levels, [spec_input.name for spec_input in inputs], settings.params, report.format, map)
"""


@pytest.fixture
def knows_levels(tmp_path: Path) -> str:
    """A folder with an installed distribution that provides levels."""
    info = tmp_path / "atlas-1.0.dist-info"
    info.mkdir()
    (info / "METADATA").write_text("Metadata-Version: 2.1\nName: atlas\nVersion: 1.0\n")
    (info / "entry_points.txt").write_text("[tltlc.levels]\ncheck = atlas_module:command [maps]\n")
    (tmp_path / "atlas_module.py").write_text(LEVELS)
    return f"{ROOT}:{tmp_path}"


def test_levels_have_their_own_options(process, knows_levels: str, inside: Path) -> None:  # type: ignore[no-untyped-def]
    outcome = process("check", "hide.tltl", "--level", "a:v1", "--level=b", "--map", "x", PYTHONPATH=knows_levels)
    assert (outcome.status, outcome.out) == (0, "('a:v1', 'b') ['hide.tltl'] {} text x\n")
    assert process("check", "--level", "a", PYTHONPATH=knows_levels).out == "('a',) [] {} text None\n"
    assert "--map" in process("check", "--level", "a", "--help", PYTHONPATH=knows_levels).out
    assert "--map" not in process("check", "--help", PYTHONPATH=knows_levels).out
    assert process("check", "hide.tltl", "--map", "x", PYTHONPATH=knows_levels).status == 2
    assert process("check", "missing.tltl", "--level", "a", PYTHONPATH=knows_levels).out == ""


def test_missing_levels_exit_with_4(process, knows_levels: str, inside: Path) -> None:  # type: ignore[no-untyped-def]
    (inside / "atlas_module.py").write_text("import a_module_that_nobody_has\n")
    outcome = process("check", "hide.tltl", "--level", "a", PYTHONPATH=knows_levels)
    assert outcome.status == 4
    assert outcome.err == (
        "error[TLT0730]: `tltlc check --level` needs `a_module_that_nobody_has`, which is not installed\n"
        "  help: pip install 'atlas[maps]'\n"
    )


def test_a_missing_part_of_tltlc_exits_with_4(tltlc, inside: Path, monkeypatch) -> None:  # type: ignore[no-untyped-def]
    monkeypatch.setitem(sys.modules, "rich", None)
    monkeypatch.setitem(sys.modules, "rich.console", None)
    monkeypatch.setattr(sys.stdout, "isatty", lambda: True)
    outcome = tltlc("explain", "TLT0001")
    assert outcome.status == 4
    assert "pip install 'rich'" in outcome.err
