"""What other distributions add through entry points: commands, and what knows levels."""

from __future__ import annotations

import sys
import zipfile
from pathlib import Path

import pytest

from tests.interfaces.cli.conftest import ROOT
from tltlc.interfaces.cli.command_line import OF_THE_RUNTIME

if sys.version_info >= (3, 11):
    import tomllib as tomli
else:
    import tomli

CODE = "import click\n\n@click.command()\ndef command():\n    'Dance.'\n    print('dancing')\n    return 0\n"


@pytest.fixture
def installed(tmp_path: Path) -> str:
    """A folder with two installed commands; the parts of one are missing."""
    info = tmp_path / "dancer-1.0.dist-info"
    info.mkdir()
    (info / "METADATA").write_text("Metadata-Version: 2.1\nName: dancer\nVersion: 1.0\n")
    (info / "entry_points.txt").write_text(
        "[tltlc.commands]\ndance = dancer_module:command\nwaltz = waltz_module:command [rl]\n"
    )
    (tmp_path / "dancer_module.py").write_text(CODE)
    (tmp_path / "waltz_module.py").write_text("import a_module_that_nobody_has\n")
    return f"{ROOT}:{tmp_path}"


def test_its_command_runs(process, installed: str) -> None:  # type: ignore[no-untyped-def]
    assert process("dance", PYTHONPATH=installed).out == "dancing\n"
    assert "dance" in process("--help", PYTHONPATH=installed).out
    assert "did you mean `dance`?" in process("danec", PYTHONPATH=installed).err.lower()


def test_help_loads_no_plugin(process, installed: str) -> None:  # type: ignore[no-untyped-def]
    shown = process("--help", PYTHONPATH=installed)
    assert shown.status == 0
    assert "(needs the extra rl)" in shown.out


def test_what_comes_with_tltlc_is_told_and_needs_an_extra() -> None:
    project = tomli.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]
    groups = project["entry-points"]
    assert groups["tltlc.commands"].keys() == OF_THE_RUNTIME.keys()
    own = [entry for name, group in groups.items() if name.startswith("tltlc.") for entry in group.values()]
    assert all(entry.endswith((" [game]", " [rl]")) for entry in own)


def test_a_missing_component_is_4(process, installed: str) -> None:  # type: ignore[no-untyped-def]
    found = process("waltz", PYTHONPATH=installed)
    assert found.status == 4
    assert found.err == (
        "error[TLT0730]: `tltlc waltz` needs `a_module_that_nobody_has`, which is not installed\n"
        "  help: pip install 'dancer[rl]'\n"
    )


def test_an_archive_has_plugins_too(process, installed: str, tmp_path: Path) -> None:  # type: ignore[no-untyped-def]
    archive = tmp_path / "dancer.zip"
    with zipfile.ZipFile(archive, "w") as file:
        for path in sorted(tmp_path.rglob("*.*")):
            if path.is_file() and path != archive:
                file.write(path, path.relative_to(tmp_path))
    assert process("dance", PYTHONPATH=f"{ROOT}:{archive}").out == "dancing\n"


def test_the_first_of_two_distributions_of_one_name_counts(process, installed: str, tmp_path: Path) -> None:  # type: ignore[no-untyped-def]
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
    print(levels, [each.name for each in inputs], settings.params, report.format, map)
"""


@pytest.fixture
def knows_levels(tmp_path: Path) -> str:
    """A folder with an installed distribution that knows levels."""
    info = tmp_path / "atlas-1.0.dist-info"
    info.mkdir()
    (info / "METADATA").write_text("Metadata-Version: 2.1\nName: atlas\nVersion: 1.0\n")
    (info / "entry_points.txt").write_text("[tltlc.levels]\ncheck = atlas_module:command [maps]\n")
    (tmp_path / "atlas_module.py").write_text(LEVELS)
    return f"{ROOT}:{tmp_path}"


def test_levels_have_options_of_their_own(process, knows_levels: str, inside: Path) -> None:  # type: ignore[no-untyped-def]
    found = process("check", "hide.tltl", "--level", "a:v1", "--level=b", "--map", "x", PYTHONPATH=knows_levels)
    assert (found.status, found.out) == (0, "('a:v1', 'b') ['hide.tltl'] {} text x\n")
    assert process("check", "--level", "a", PYTHONPATH=knows_levels).out == "('a',) [] {} text None\n"
    assert "--map" in process("check", "--level", "a", "--help", PYTHONPATH=knows_levels).out
    assert "--map" not in process("check", "--help", PYTHONPATH=knows_levels).out
    assert process("check", "hide.tltl", "--map", "x", PYTHONPATH=knows_levels).status == 2
    assert process("check", "missing.tltl", "--level", "a", PYTHONPATH=knows_levels).out == ""


def test_levels_that_are_not_installed_are_4(process, knows_levels: str, inside: Path) -> None:  # type: ignore[no-untyped-def]
    (inside / "atlas_module.py").write_text("import a_module_that_nobody_has\n")
    found = process("check", "hide.tltl", "--level", "a", PYTHONPATH=knows_levels)
    assert found.status == 4
    assert found.err == (
        "error[TLT0730]: `tltlc check --level` needs `a_module_that_nobody_has`, which is not installed\n"
        "  help: pip install 'atlas[maps]'\n"
    )


def test_a_missing_part_of_tltlc_is_4(tltlc, inside: Path, monkeypatch) -> None:  # type: ignore[no-untyped-def]
    monkeypatch.setitem(sys.modules, "rich", None)
    monkeypatch.setitem(sys.modules, "rich.console", None)
    monkeypatch.setattr(sys.stdout, "isatty", lambda: True)
    found = tltlc("explain", "TLT0001")
    assert found.status == 4
    assert "pip install 'rich'" in found.err
