"""Documented modules that have moved: imports of their old names still work."""

from __future__ import annotations

import sys

# Type checkers treat this as true. The imports would add to each start of the command line.
TYPE_CHECKING = False
if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence
    from importlib.machinery import ModuleSpec
    from types import ModuleType
    from typing import Any


def keep_old_names(new_names: Mapping[str, str]) -> None:
    """Make modules importable under their old names; ``new_names`` maps each old name to the new name.

    Importing an old name gives a new module object with the attributes of the module that has the
    new name. That module loads only then.
    """
    sys.meta_path.append(_Finder(new_names))


class _Finder:
    def __init__(self, new_names: Mapping[str, str]) -> None:
        self._new_names = new_names

    def find_spec(
        self, fullname: str, path: Sequence[str] | None, target: ModuleType | None = None
    ) -> ModuleSpec | None:
        if fullname not in self._new_names:
            return None
        from importlib.machinery import ModuleSpec

        is_package = any(name.startswith(f"{fullname}.") for name in self._new_names)
        loader: Any = _Loader(self._new_names[fullname])
        return ModuleSpec(fullname, loader, is_package=is_package)


class _Loader:
    def __init__(self, new_name: str) -> None:
        self._new_name = new_name

    def create_module(self, spec: ModuleSpec) -> None:
        """Let Python create the module."""

    def exec_module(self, module: ModuleType) -> None:
        from importlib import import_module

        new_module = import_module(self._new_name)
        module.__doc__ = new_module.__doc__
        vars(module)["__getattr__"] = lambda name: getattr(new_module, name)
