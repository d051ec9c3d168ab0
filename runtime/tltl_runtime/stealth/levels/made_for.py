"""The folders of levels, and the specs that levels are made for."""

from __future__ import annotations

from pathlib import Path
from typing import Final

from tltl_runtime.support.checked_table import CheckedTable, wrong_value
from tltl_runtime.support.shown_path import path_text
from tltl_runtime.support.suggestion import suggestion
from tltlc.api import Diagnostic, fileio

LEVELS: Final = Path(__file__).parents[2] / "levels"
"""The folder of the levels that come with the package."""

SPECS: Final = (LEVELS.parent / "examples", LEVELS.parents[2] / "examples")
"""The folders of the levels' specs: in an installed package, and in a checkout."""


def made_for(table: CheckedTable, level: Path) -> str:
    """Return the spec under the key ``spec`` of a level as ``FILE:NAME``.

    The file is beside the level or in the package. Return an empty text if there is no spec, or if
    it is wrong (TLT0803, TLT0805).
    """
    text = table.text("spec", "")
    file, _, name = text.rpartition(":")
    if not text:
        return ""
    if not file.endswith(".tltl") or not name:
        table.log.append(wrong_value(table.entries["spec"], "spec", "FILE.tltl:NAME, e.g. `stealth.tltl:unseen`"))
        return ""
    label = table.label_of("spec")
    path = next((folder / file for folder in (level.parent, *SPECS) if fileio.is_file(folder / file)), None)
    if path is None:
        help_ = f"put it beside `{level.name}`"
        table.log.append(Diagnostic("TLT0805", f"there is no spec file `{file}`", (label,), help_))
        return ""
    specs = _specs(path)
    if name not in specs:
        title = f"`{file}` holds no spec `{name}`"
        table.log.append(Diagnostic("TLT0805", title, (label,), suggestion(name, specs)))
    return f"{path}:{name}"


def comes_with_the_package(spec: str) -> bool:
    """Whether a spec file is one that shipped levels are made for."""
    return Path(spec).resolve().parent in [folder.resolve() for folder in SPECS]


def _specs(path: Path) -> list[str]:
    """Return the names of the specs in a file, even if the file has other errors."""
    from tltlc.api import syntax

    declarations = syntax.parse(fileio.read_source(path, path_text(path)))[0].declarations
    return [declaration.name for declaration in declarations if isinstance(declaration, syntax.SpecDecl)]
