"""Commands of other distributions, through the entry-point group ``tltlc.commands``."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.cli.conftest import ROOT

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


def test_a_missing_component_is_4(process, installed: str) -> None:  # type: ignore[no-untyped-def]
    found = process("waltz", PYTHONPATH=installed)
    assert found.status == 4
    assert found.err == (
        "error[TLT0730]: `tltlc waltz` needs `a_module_that_nobody_has`, which is not installed\n"
        "  help: pip install 'dancer[rl]'\n"
    )


def test_a_missing_part_of_tltlc_is_4(tltlc, inside: Path, monkeypatch) -> None:  # type: ignore[no-untyped-def]
    import sys

    monkeypatch.setitem(sys.modules, "rich", None)
    monkeypatch.setitem(sys.modules, "rich.console", None)
    monkeypatch.setattr(sys.stdout, "isatty", lambda: True)
    found = tltlc("explain", "TLT0001")
    assert found.status == 4
    assert "pip install 'rich'" in found.err
