"""Documented modules that have moved: imports of their old names still work."""

from __future__ import annotations

import sys
from collections.abc import Mapping, Sequence

TYPE_CHECKING = False
if TYPE_CHECKING:
    from importlib.machinery import ModuleSpec
    from types import ModuleType
    from typing import Any


def keep_old_names(homes: Mapping[str, str]) -> None:
    """Make modules importable under their old names; ``homes`` maps each old name to the module's name.

    The module of an old name is a new object with the same attributes.  It loads on its first import.
    """
    sys.meta_path.append(_Finder(homes))


class _Finder:
    def __init__(self, homes: Mapping[str, str]) -> None:
        self._homes = homes

    def find_spec(
        self, fullname: str, path: Sequence[str] | None, target: ModuleType | None = None
    ) -> ModuleSpec | None:
        if fullname not in self._homes:
            return None
        from importlib.machinery import ModuleSpec

        is_package = any(name.startswith(f"{fullname}.") for name in self._homes)
        loader: Any = _Loader(self._homes[fullname])
        return ModuleSpec(fullname, loader, is_package=is_package)


class _Loader:
    def __init__(self, home: str) -> None:
        self._home = home

    def create_module(self, spec: ModuleSpec) -> None:
        """Let Python create the module."""

    def exec_module(self, module: ModuleType) -> None:
        from importlib import import_module

        home = import_module(self._home)
        module.__doc__ = home.__doc__
        vars(module)["__getattr__"] = lambda name: getattr(home, name)
