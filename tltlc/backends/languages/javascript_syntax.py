"""Print the program of a monitor, literals, keys and tests in JavaScript."""

from __future__ import annotations

import re
from collections.abc import Collection, Sequence
from typing import ClassVar

from tltlc.program import reward_step, snippets, states
from tltlc.program.printer import CHOICE, Printer
from tltlc.program.tree import FAILING, Assign, Declare, Int

_LONGEST = 110


class JavaScriptPrinter(Printer):
    """Prints the program of a monitor (:mod:`tltlc.program`) as JavaScript code.

    ``atoms`` are the names of the atoms in the spec. A numeric function whose name is in ``built_in`` is
    called as a function of ``Math``: ``Math.abs(x)``. The template of the monitor must define all other
    functions that the program calls. A function that has no value for some arguments, such as the
    division, is a method of the monitor: ``this.#divide(x, y)``.
    """

    INDENT = "  "
    COMPARISONS: ClassVar = {**Printer.COMPARISONS, "==": "===", "!=": "!=="}
    TABLES: ClassVar = {name: name.upper() for name in Printer.TABLES}

    def __init__(self, atoms: Sequence[str], built_in: Collection[str] = ("abs", "tanh")) -> None:
        self._atoms, self._built_in = atoms, built_in

    def declaration(self, statement: Declare) -> str:
        """Return a declaration: ``const`` if the variable keeps its value, ``let`` otherwise."""
        if statement.value is None:
            return f"let {statement.name};"
        return f"{'let' if statement.changes else 'const'} {statement.name} = {self.text(statement.value, CHOICE)};"

    def assignment(self, statement: Assign) -> str:
        """Return the text of an assignment; the variable ``limiting`` gets the name of an atom instead of its index."""
        match statement:
            case Assign(states.LIMITING, Int(index)):
                return f"{states.LIMITING} = {string_literal(self._atoms[index]) if index >= 0 else 'null'};"
        return super().assignment(statement)

    def name(self, name: str) -> str:
        """Return the name of a variable in JavaScript.

        For ``steps_real``, the number of steps as a real number, this is ``steps``: JavaScript has
        one type for all numbers.
        """
        return reward_step.STEPS if name == reward_step.STEPS_REAL else name

    def real(self, value: float) -> str:
        """Return the literal of a number; whole numbers have no decimal point."""
        return number_literal(value)

    def call(self, function: str, arguments: Sequence[str]) -> str:
        """Return the text of a call of a numeric function: ``Math.abs(x)``, ``this.#divide(x, y)`` or ``min(x, y)``."""
        if function in self._built_in:
            function = f"Math.{function}"
        return super().call(f"this.#{function}" if function in FAILING else function, arguments)


def number_literal(value: float) -> str:
    """Return the literal of a number; whole numbers have no decimal point."""
    return repr(float(value)).removesuffix(".0")


def string_literal(text: str) -> str:
    """Return a string literal with escapes for characters that do not print."""
    return snippets.string_literal(text, _escape)


def _escape(character: str) -> str:
    code = ord(character)
    return f"\\u{code:04x}" if code < 0x10000 else f"\\u{{{code:x}}}"


def range_test(name: str, low: float | None, high: float | None) -> str:
    """Return a JavaScript expression that is true if the variable ``name`` is a finite number in a range.

    The range goes from ``low`` to ``high``; None means that there is no bound.
    """
    if low is None and high is None:
        return f"Number.isFinite({name})"
    least = f"-Infinity < {name}" if low is None else f"{number_literal(low)} <= {name}"
    greatest = f"{name} < Infinity" if high is None else f"{name} <= {number_literal(high)}"
    return f'typeof {name} === "number" && {least} && {greatest}'


def _is_plain(name: str) -> bool:
    return re.fullmatch(r"[A-Za-z_$][A-Za-z0-9_$]*", name) is not None


def key(name: str) -> str:
    """Return a property's name as it is written in an object or a type: in quotes unless it is an identifier."""
    return name if _is_plain(name) else string_literal(name)


def own_key(name: str) -> str:
    """Return a property's name in an object; in brackets if it is ``__proto__``, which would set the prototype."""
    return f"[{string_literal(name)}]" if name == "__proto__" else key(name)


def member(owner: str, name: str) -> str:
    """Return the text that reads a property of the variable ``owner``: ``owner.name`` or ``owner["a name"]``."""
    return f"{owner}.{name}" if _is_plain(name) else f"{owner}[{string_literal(name)}]"


def branch_lines(tests: Sequence[str], body: str, word: str = "") -> list[str]:
    """Return the lines of an ``if`` that runs ``body``; its condition joins ``tests`` with the operator ``word``."""
    head = f"if ({f' {word} '.join(tests)})"
    if len(head) + len(body) < _LONGEST:
        return [f"{head} {body}"]
    if len(head) < _LONGEST or len(tests) == 1:
        return [f"{head} {{", f"  {body}", "}"]
    lines, text = [], tests[0]
    for test in tests[1:]:
        if len(text) + len(test) > _LONGEST - 8:
            lines.append(f"  {text} {word}")
            text = test
        else:
            text = f"{text} {word} {test}"
    return ["if (", *lines, f"  {text}", ") {", f"  {body}", "}"]


def array(items: Sequence[str]) -> str:
    """Return the text of an array, on one line if it is short, otherwise with a line for each item."""
    line = f"[{', '.join(items)}]"
    if len(line) <= 80 and not any("{" in item for item in items):
        return line
    return "[\n" + "".join(f"{JavaScriptPrinter.INDENT}{item},\n" for item in items) + "]"
