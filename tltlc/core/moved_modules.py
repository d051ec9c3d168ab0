"""Documented modules that have moved: imports of their old names still work."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence
    from importlib.machinery import ModuleSpec
    from types import ModuleType
    from typing import Any


class OldNames:
    """Finds modules by their old names; append it to :data:`sys.meta_path`.

    ``new_names`` maps each old name to the new name. Importing an old name gives a new module object
    with the attributes of the module that has the new name. That module loads only then.
    """

    def __init__(self, new_names: Mapping[str, str]) -> None:
        self._new_names = new_names

    def find_spec(
        self, fullname: str, path: Sequence[str] | None, target: ModuleType | None = None
    ) -> ModuleSpec | None:
        """Return how to load the module; None if no module had this name."""
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

        moved = import_module(self._new_name)
        module.__doc__ = moved.__doc__
        vars(module)["__getattr__"] = lambda name: getattr(moved, name)
