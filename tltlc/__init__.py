"""Compile .tltl specifications to finite state predicate automata (FSPA).

>>> import tltlc
>>> fspa, = tltlc.compile_text('''
...     signal exit_reached: bool
...     signal health in [0, 1]
...     spec escape = F exit_reached & G health > 0
... ''')
>>> [str(state.label) for state in fspa.states]
['F exit_reached & G(health > 0)', 'G(health > 0)', 'false']

Importing this package loads nothing else. Each public name below is loaded on first use.
"""

import sys

# Type checkers treat this as true. Importing it from `typing` would add some milliseconds to each start.
TYPE_CHECKING = False
if TYPE_CHECKING:
    from collections.abc import Sequence
    from importlib.machinery import ModuleSpec
    from types import ModuleType

    from tltlc.automaton.fspa import Fspa as Fspa
    from tltlc.automaton.networkx_graph import to_networkx as to_networkx
    from tltlc.diagnostics.diagnostic import Diagnostic as Diagnostic
    from tltlc.diagnostics.diagnostic import TltlError as TltlError
    from tltlc.logic.formula import Formula as Formula
    from tltlc.pipeline import CompileOptions as CompileOptions
    from tltlc.pipeline import compile_file as compile_file
    from tltlc.pipeline import compile_text as compile_text
    from tltlc.pipeline import load as load
    from tltlc.tools.hoa.load import ImportOptions as ImportOptions
    from tltlc.tools.hoa.load import load_hoa as load_hoa

__version__ = "0.1.0"

__all__ = [
    "CompileOptions",
    "Diagnostic",
    "Formula",
    "Fspa",
    "ImportOptions",
    "TltlError",
    "__version__",
    "compile_file",
    "compile_text",
    "load",
    "load_hoa",
    "to_networkx",
]

_HOMES = {
    "CompileOptions": "tltlc.pipeline",
    "Diagnostic": "tltlc.diagnostics.diagnostic",
    "Formula": "tltlc.logic.formula",
    "Fspa": "tltlc.automaton.fspa",
    "ImportOptions": "tltlc.tools.hoa.load",
    "TltlError": "tltlc.diagnostics.diagnostic",
    "compile_file": "tltlc.pipeline",
    "compile_text": "tltlc.pipeline",
    "load": "tltlc.pipeline",
    "load_hoa": "tltlc.tools.hoa.load",
    "to_networkx": "tltlc.automaton.networkx_graph",
}

_MOVED = {
    "tltlc.comparison": "tltlc.automaton.compare",
    "tltlc.fmt": "tltlc.tools.fmt",
    "tltlc.monitor.reward": "tltlc.monitor.progress_and_reward",
    "tltlc.playground": "tltlc.interfaces.playground",
    "tltlc.rabin": "tltlc.automaton.infinite",
    "tltlc.rabin.work": "tltlc.automaton.work",
}


class _OldNames:
    """An import finder that lets programs import moved modules by their old, documented names."""

    @staticmethod
    def find_spec(
        fullname: str, path: "Sequence[str] | None", target: "ModuleType | None" = None
    ) -> "ModuleSpec | None":
        if fullname not in _MOVED:
            return None
        from tltlc.core.moved_modules import OldNames

        return OldNames(_MOVED).find_spec(fullname, path, target)


sys.meta_path.insert(0, _OldNames)


def __getattr__(name: str) -> object:
    home = _HOMES.get(name)
    if home is None:
        raise AttributeError(f"module 'tltlc' has no attribute {name!r}")
    from importlib import import_module

    value: object = getattr(import_module(home), name)
    globals()[name] = value
    return value


def __dir__() -> list[str]:
    return sorted({*globals(), *__all__})
