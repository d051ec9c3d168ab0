"""The folder of the shipped levels, and the specs that levels are made for."""

from __future__ import annotations

from pathlib import Path
from typing import Final

from tltl_runtime.game.level import LevelSpec, parse_level_spec
from tltl_runtime.support.checked_table import CheckedTable, wrong_value
from tltl_runtime.support.path_text import path_text
from tltl_runtime.support.suggestion import suggestion
from tltlc.api import Diagnostic, fileio

LEVELS: Final = Path(__file__).parents[2] / "levels"
"""The folder of the levels that come with the package."""

SPECS: Final = (LEVELS.parent / "examples", LEVELS.parents[2] / "examples")
"""The folders of the shipped levels' specs: in an installed package, and in a checkout."""


def read_default_spec(table: CheckedTable, level: Path) -> LevelSpec | None:
    """Return the spec that the key ``spec`` in a level's file names.

    ``table`` is the table with that key, and ``level`` the path of the level's file. The spec's
    file is beside the level or in the package.

    - If there is no key, return None.
    - If the value of the key is wrong, log TLT0803 and return None.
    - If there is no such file, log TLT0805 and return None.
    - If the file does not contain the spec, log TLT0805, but return the spec all the same.
    """
    text = table.text("spec", "")
    spec = parse_level_spec(text)
    if spec is None:
        return None
    if not str(spec.file).endswith(".tltl") or not spec.name:
        table.log.append(wrong_value(table.entries["spec"], "spec", "FILE.tltl:NAME, e.g. `stealth.tltl:unseen`"))
        return None
    label, file = table.label_of("spec"), text.rpartition(":")[0]
    path = next((folder / spec.file for folder in (level.parent, *SPECS) if fileio.is_file(folder / spec.file)), None)
    if path is None:
        help_ = f"put it beside `{level.name}`"
        table.log.append(Diagnostic("TLT0805", f"there is no spec file `{file}`", (label,), help_))
        return None
    specs = _spec_names(path)
    if spec.name not in specs:
        title = f"`{file}` contains no spec `{spec.name}`"
        table.log.append(Diagnostic("TLT0805", title, (label,), suggestion(spec.name, specs)))
    return LevelSpec(path, spec.name)


def is_packaged(spec: str) -> bool:
    """Whether the file at the path ``spec`` is directly in a folder of the shipped levels' specs."""
    return Path(spec).resolve().parent in [folder.resolve() for folder in SPECS]


def _spec_names(path: Path) -> list[str]:
    """Return the names of the specs in a file, even if the file has other errors."""
    from tltlc.api import syntax

    declarations = syntax.parse(fileio.read_source(path, path_text(path)))[0].declarations
    return [declaration.name for declaration in declarations if isinstance(declaration, syntax.SpecDecl)]
