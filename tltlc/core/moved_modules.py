"""Let programs import public modules by their old names after the modules have moved."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence
    from importlib.machinery import ModuleSpec
    from types import ModuleType
    from typing import Any


class OldNames:
    """An import finder for old names of modules; insert it at the front of :data:`sys.meta_path`.

    The finder must come before Python's own finders. An update may leave a folder with an old name
    that has only compiled files in it, and Python's finders would import this folder as a package.

    ``new_names`` maps old names to new names. The import of an old name gives a new module object,
    which looks up all its attributes in the module with the new name.
    """

    def __init__(self, new_names: Mapping[str, str]) -> None:
        self._new_names = new_names

    def find_spec(
        self, fullname: str, path: Sequence[str] | None, target: ModuleType | None = None
    ) -> ModuleSpec | None:
        """Return the import spec of the module ``fullname``; None if this is not an old name."""
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
        """Return None, so that Python creates the module in the usual way."""

    def exec_module(self, module: ModuleType) -> None:
        from importlib import import_module

        moved = import_module(self._new_name)
        module.__doc__ = moved.__doc__

        def attribute(name: str) -> object:
            # With the `__path__` of a package, Python would load a second copy of each of its modules.
            if name == "__path__":
                raise AttributeError(f"module {module.__name__!r} has no attribute {name!r}")
            return getattr(moved, name)

        vars(module)["__getattr__"] = attribute
