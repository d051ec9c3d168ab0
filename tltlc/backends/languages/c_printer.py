"""Print a program in C."""

from __future__ import annotations

import re
from collections.abc import Sequence

from tltlc.backends.languages.c_text import escape, string_literal
from tltlc.program import states
from tltlc.program.names import printable_line
from tltlc.program.printer import Printer
from tltlc.program.tree import FAILING, Assign, Int, Type
from tltlc.resolve.spec import Atom


class CPrinter(Printer):
    """Prints the program of a monitor (:mod:`tltlc.program`) as C code.

    The names of its functions begin with ``prefix``, the name of the spec. ``atoms`` are the atoms
    of the automaton.
    """

    def __init__(self, prefix: str, atoms: Sequence[Atom]) -> None:
        self._prefix, self._atoms = prefix, atoms

    def comment(self, text: str) -> list[str]:
        """Return the lines of a comment, with only ASCII characters and no trigraphs: all compilers read it alike."""
        return super().comment(re.sub(r"[^\x00-\x7f]", escape, printable_line(text)).replace("??", "? ?"))

    def assignment(self, statement: Assign) -> str:
        """Return the text of an assignment; the variable ``limiting`` gets the name of an atom instead of its index."""
        match statement:
            case Assign(states.LIMITING, Int(index)):
                return f"{states.LIMITING} = {string_literal(self._atoms[index].name) if index >= 0 else 'NULL'};"
        return super().assignment(statement)

    def name(self, name: str) -> str:
        """Return a variable, which may be a field of the monitor."""
        return f"monitor->{name}" if name in (states.FAILURE, states.FAILED_STEP) else name

    def field(self, type_: Type, name: str) -> str:
        """Return the field of a monitor that keeps a value of the trace so far."""
        return f"{self._prefix}_flag_({name});" if type_ == "bool" else f"{self.TYPES[type_]} {name};"

    def call(self, function: str, arguments: Sequence[str]) -> str:
        """Return the text of a call of a numeric function.

        Some functions have no value for some arguments, such as a division by 0. They also get the
        monitor as an argument, and set its field ``problem`` in such a case.
        """
        if function in ("abs", "tanh"):
            return super().call({"abs": "fabs"}.get(function, function), arguments)
        monitor_argument = ["monitor"] if function in FAILING else []
        return super().call(f"{self._prefix}_{function}_", [*monitor_argument, *arguments])
