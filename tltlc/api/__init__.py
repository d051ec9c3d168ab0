"""The names of the compiler that other programs, such as the runtime, may import.

Import them from here and from nowhere else in ``tltlc``, because other modules may move. This
package has the classes and functions that most programs need. Its nine modules have more; each
answers a question:

- ``cli``: how does a command take options, show diagnostics and choose its exit status?
- ``compiler``: how do I get an automaton, and a monitor or picture of it?
- ``expressions``: what does an atom compute, and what is its value?
- ``fileio``: how do I read and write files so that every failure is a diagnostic?
- ``monitors``: what are the values of the atoms, the progress and the reward of a step?
- ``ranges``: which values can an expression take?
- ``specs``: what types do signals have, how is a clock read, and where is the standard library?
- ``syntax``: what does a ``.tltl`` file declare?
- ``traces``: is a recorded trace accepted, and why not?

Importing this package imports no other module. The module of a name is imported when the name is
first used.
"""

# Type checkers treat this name as true. To import it from `typing` would add some milliseconds to each start.
TYPE_CHECKING = False
if TYPE_CHECKING:
    from tltlc.api import cli as cli
    from tltlc.api import compiler as compiler
    from tltlc.api import expressions as expressions
    from tltlc.api import fileio as fileio
    from tltlc.api import monitors as monitors
    from tltlc.api import ranges as ranges
    from tltlc.api import specs as specs
    from tltlc.api import syntax as syntax
    from tltlc.api import traces as traces
    from tltlc.automaton.fspa import Fspa as Fspa
    from tltlc.automaton.fspa import Implicant as Implicant
    from tltlc.automaton.fspa import Notation as Notation
    from tltlc.automaton.fspa import State as State
    from tltlc.automaton.text import formula_text as formula_text
    from tltlc.automaton.text import label_text as label_text
    from tltlc.core.moved_modules import OldNames as OldNames
    from tltlc.core.record import EMPTY as EMPTY
    from tltlc.core.record import MissingFieldsError as MissingFieldsError
    from tltlc.core.record import record as record
    from tltlc.core.record import replace as replace
    from tltlc.core.source import SourceFile as SourceFile
    from tltlc.core.source import Span as Span
    from tltlc.diagnostics.diagnostic import Diagnostic as Diagnostic
    from tltlc.diagnostics.diagnostic import Label as Label
    from tltlc.diagnostics.diagnostic import Severity as Severity
    from tltlc.diagnostics.diagnostic import TltlError as TltlError
    from tltlc.diagnostics.formats.github import workflow_command as workflow_command
    from tltlc.monitor import Monitor as Monitor
    from tltlc.monitor import MonitorError as MonitorError
    from tltlc.monitor import RewardOptions as RewardOptions
    from tltlc.monitor import Step as Step
    from tltlc.resolve.spec import Atom as Atom
    from tltlc.resolve.spec import Signal as Signal
    from tltlc.resolve.spec import Spec as Spec

_HOMES = {
    "Atom": "tltlc.resolve.spec",
    "Diagnostic": "tltlc.diagnostics.diagnostic",
    "EMPTY": "tltlc.core.record",
    "Fspa": "tltlc.automaton.fspa",
    "Implicant": "tltlc.automaton.fspa",
    "Label": "tltlc.diagnostics.diagnostic",
    "MissingFieldsError": "tltlc.core.record",
    "Monitor": "tltlc.monitor",
    "MonitorError": "tltlc.monitor",
    "Notation": "tltlc.automaton.fspa",
    "OldNames": "tltlc.core.moved_modules",
    "RewardOptions": "tltlc.monitor",
    "Severity": "tltlc.diagnostics.diagnostic",
    "Signal": "tltlc.resolve.spec",
    "SourceFile": "tltlc.core.source",
    "Span": "tltlc.core.source",
    "Spec": "tltlc.resolve.spec",
    "State": "tltlc.automaton.fspa",
    "Step": "tltlc.monitor",
    "TltlError": "tltlc.diagnostics.diagnostic",
    "formula_text": "tltlc.automaton.text",
    "label_text": "tltlc.automaton.text",
    "record": "tltlc.core.record",
    "replace": "tltlc.core.record",
    "workflow_command": "tltlc.diagnostics.formats.github",
}

__all__ = [
    "EMPTY",
    "Atom",
    "Diagnostic",
    "Fspa",
    "Implicant",
    "Label",
    "MissingFieldsError",
    "Monitor",
    "MonitorError",
    "Notation",
    "OldNames",
    "RewardOptions",
    "Severity",
    "Signal",
    "SourceFile",
    "Span",
    "Spec",
    "State",
    "Step",
    "TltlError",
    "cli",
    "compiler",
    "expressions",
    "fileio",
    "formula_text",
    "label_text",
    "monitors",
    "ranges",
    "record",
    "replace",
    "specs",
    "syntax",
    "traces",
    "workflow_command",
]


def __getattr__(name: str) -> object:
    home = _HOMES.get(name)
    if home is None:
        raise AttributeError(f"module 'tltlc.api' has no attribute {name!r}")
    from importlib import import_module

    value: object = getattr(import_module(home), name)
    globals()[name] = value
    return value


def __dir__() -> list[str]:
    return sorted({*globals(), *__all__})
