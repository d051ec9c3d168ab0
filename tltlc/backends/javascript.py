"""A stand-alone monitor in JavaScript: one ES module for browsers and Node, and its types for TypeScript.

It computes what :class:`tltlc.monitor.Monitor` computes with its default reward: to the last bit where predicates take
no ``exp``, ``tanh`` or power, else within 1e-12, since engines have functions of their own.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Sequence

from tltlc.automaton.blowup import recursion_room
from tltlc.automaton.fspa import Fspa
from tltlc.backends import Files, Options, Target
from tltlc.backends.code.names import visible
from tltlc.backends.program import judge, states
from tltlc.backends.program.arithmetic import defined
from tltlc.backends.program.build import program
from tltlc.backends.program.printer import Printer, remark
from tltlc.backends.program.shallow import shallow
from tltlc.backends.program.template import filled
from tltlc.backends.program.tree import Assign, Compare, Declare, Expression, Int
from tltlc.backends.program.uses import called, read

TARGET = Target("javascript", "a stand-alone monitor in JavaScript", ("_monitor.mjs", "_monitor.d.mts"))

_FAILING = {"divide", "sqrt", "power", "exp"}
"""Functions that may have no value."""

_LONGEST = 110

_RESERVED = """
    abstract arguments as async await boolean break byte case catch char class const continue debugger default delete
    do double else enum eval export extends false final finally float for from function get goto if implements import
    in instanceof int interface let long native new null of package private protected public return set short static
    super switch synchronized this throw throws transient true try typeof undefined var void volatile while with yield
    Infinity Math Monitor MonitorError NaN Number Object Result RowReader Set String TextDecoder globalThis process
    ATOMS EXCLUSIVE PARAMS SIGNALS STATES entered listed max min paramValues result shown signals
""".split()
"""Words of the language, and what the step function reads beside its own variables."""


def emit(fspa: Fspa, options: Options) -> Files:
    """``NAME_monitor.mjs`` and ``NAME_monitor.d.mts``."""
    module, declarations = (f"{fspa.name}{ending}" for ending in TARGET.endings)
    source = _Source(fspa, module, declarations)
    return {module: source.module(), declarations: source.declarations()}


class _JavaScript(Printer):
    """Prints JavaScript; functions that may fail are methods of the monitor."""

    INDENT = "  "

    def __init__(self, atoms: Sequence[str]) -> None:
        self._atoms = atoms

    def declaration(self, statement: Declare) -> str:
        """``const`` where a variable keeps its value."""
        if statement.value is None:
            return f"let {statement.name};"
        return f"{'let' if statement.changes else 'const'} {statement.name} = {self.text(statement.value)};"

    def assignment(self, statement: Assign) -> str:
        """The limiting atom is given by its name."""
        match statement:
            case Assign(states.LIMITING, Int(place)):
                return f"{states.LIMITING} = {_string(self._atoms[place]) if place >= 0 else 'null'};"
        return super().assignment(statement)

    def name(self, name: str) -> str:
        """There is one kind of numbers."""
        return judge.STEPS if name == judge.STEPS_REAL else name

    def real(self, value: float) -> str:
        """A number, whole ones without a point."""
        return _number(value)

    def call(self, function: str, arguments: Sequence[str]) -> str:
        """A call of a function of numbers."""
        if function in ("abs", "tanh"):
            function = f"Math.{function}"
        return super().call(f"this.#{function}" if function in _FAILING else function, arguments)

    def _written(self, node: Expression) -> tuple[str, int]:
        """Numbers are compared without conversions."""
        text, binding = super()._written(node)
        if isinstance(node, Compare) and node.op in ("==", "!="):
            text = text.replace(f" {node.op} ", f" {node.op}= ")
        return text, binding


class _Source:
    """The sources of one monitor: the pieces that fill the templates."""

    def __init__(self, fspa: Fspa, module: str, declarations: str) -> None:
        self._fspa, self._module, self._declarations = fspa, module, declarations
        self._program = program(fspa, _RESERVED)
        self._names = (*self._program.signals, *self._program.params, *self._program.atoms)
        self._printer = _JavaScript([atom.name for atom in fspa.atoms])

    def module(self) -> str:
        """The whole module."""
        fspa = self._fspa
        made = self._program
        functions = called(statement for part in (*made.values, *made.states) for statement in part)
        present = [*functions, *(["failing"] if functions & _FAILING else []), *(["signal"] if fspa.signals else [])]
        present += ["atom"] if fspa.atoms else []
        present += ["some"] if fspa.signals or fspa.atoms else []
        present += ["exclusive"] if fspa.exclusive else []
        with recursion_room():
            step = _block(self._step(), depth=2)
        pieces = {
            "title": _title(fspa),
            "file": self._module,
            "declarations": self._declarations,
            "example": self._example(),
            "signals": _list([_signal(signal.name, signal.type, signal.low, signal.high) for signal in fspa.signals]),
            "params": _list(
                [
                    f"{{ name: {_string(param.name)}, value: {_number(param.value)}, {_range(param.low, param.high)} }}"
                    for param in fspa.params
                ]
            ),
            "atoms": _list([_string(atom.name) for atom in fspa.atoms]),
            "exclusive": _list([f"[{', '.join(map(str, group))}]" for group in fspa.exclusive]),
            "states": _list(self._states()),
            "step": step,
        }
        return filled("monitor.mjs.txt", pieces, present)

    def declarations(self) -> str:
        """The whole file of types."""
        fspa = self._fspa
        signals = [
            (signal.name, "boolean | 0 | 1" if signal.type == "bool" else "number", signal.doc)
            for signal in fspa.signals
        ]
        params = [(param.name, "number", param.doc) for param in fspa.params]
        title = f"// Types of {self._module}, written by tltlc."
        pieces = {"title": title, "signal_fields": _fields(signals), "param_fields": _fields(params)}
        return filled("monitor.d.mts.txt", pieces)

    def _example(self) -> str:
        """A sample, as a call gives it."""
        signals = self._fspa.signals
        shown = [f"{_key(signal.name)}: {'true' if signal.type == 'bool' else '…'}" for signal in signals[:2]]
        text = f"{{ {', '.join([*shown, *(['…'] if len(signals) > 2 else [])])} }}" if signals else "{}"
        # It stands in a comment.
        return visible(text) if len(text) <= 60 else "signals"

    def _states(self) -> list[str]:
        rows: list[str] = []
        for state in self._fspa.states:
            ends = state.verdict in ("satisfied", "violated") or (self._fspa.judge == "goal" and state.accepting)
            values = f'verdict: "{state.verdict}", accepting: {_bool(state.accepting)}, ends: {_bool(ends)}'
            rows.append(f"{{ label: {_string(state.label.ascii)}, {values} }}")
        return rows

    # --- the step function ------------------------------------------------------------------------

    def _step(self) -> list[str]:
        parts = [self._read(), self._compute(), self._check(), self._move(), self._judge()]
        return "\n\n".join("\n".join(part) for part in parts if part).split("\n")

    def _read(self) -> list[str]:
        """Signals in their range, and params, in variables of their own."""
        used = read(statement for value in self._program.values for statement in value)
        signals = list(zip(self._fspa.signals, self._program.signals, strict=True))
        places = [_member("signals", signal.name) for signal, _ in signals]
        lines: list[str] = []
        if places:
            lines += _branch([f"{place} === undefined" for place in places], "||", "throw this.#missing(signals);")
        for number, ((_, name), place) in enumerate(zip(signals, places, strict=True)):
            # What no atom reads is held to be a number all the same.
            given = f"this.#number({number}, {place});"
            lines.append(f"const {name} = {given}" if name in used else given)
        for number, name in enumerate(self._program.params):
            lines += [f"const {name} = this.#params[{number}];"] if name in used else []
        return lines

    def _compute(self) -> list[str]:
        """The atoms' values."""
        lines: list[str] = []
        explained: set[str] = {""}
        for place, (atom, name) in enumerate(zip(self._fspa.atoms, self._program.atoms, strict=True)):
            statements = self._program.values[place]
            lines += self._printer.comment(atom.name if atom.doc in explained else f"{atom.name}: {atom.doc}")
            explained.add(atom.doc)
            if called(statements) & _FAILING:
                lines.append(f"this.#atom = {place};")
            lines += self._printer.lines(defined(name, statements))
        for place, name in enumerate(self._program.atoms):
            lines.append(f"if (!(-1 <= {name} && {name} <= 1)) {name} = this.#inRange({place}, {name});")
        return lines

    def _check(self) -> list[str]:
        """Exclusive atoms."""
        lines: list[str] = []
        for place, group in enumerate(self._fspa.exclusive):
            if len(group) > 1:
                names = [self._program.atoms[atom] for atom in group]
                *before, last = [f"Number({name} > 0)" for name in names]
                refusal = f"throw this.#together({place}, [{', '.join(names)}]);"
                lines += _branch([*before, f"{last} > 1"], "+", refusal)
        return lines

    def _move(self) -> list[str]:
        """The transition, by state."""
        lines = [f"let {states.TARGET} = this.state;", f"let {states.ROBUSTNESS} = 0;"]
        lines += [f"let {states.PROGRESS} = 0;"] if self._fspa.judge == "goal" else []
        lines.append(f"let {states.LIMITING} = null;")
        lines.append("switch (this.state) {")
        for state, statements in zip(self._fspa.states, self._program.states, strict=True):
            # A brace, since declarations may follow.
            lines += [f"  {line}" for line in self._printer.comment(state.label.ascii)]
            lines.append(f"  case {state.id}: {{")
            lines += self._printer.lines(shallow(statements, self._names), depth=2)
            lines += ["    break;", "  }"]
        return [*lines, "}"]

    def _judge(self) -> list[str]:
        """Progress, reward and the end of the episode."""
        used = read(self._program.judged)
        verdict = f"STATES[{states.TARGET}].verdict"
        lines = [f"let {judge.BEST} = this.progress;", f"let {judge.DONE} = this.done;", f"let {judge.REWARD};"]
        given = {
            judge.ENDS: f"STATES[{states.TARGET}].ends",
            judge.VIOLATED: f'{verdict} === "violated"',
            judge.SATISFIED: f'{verdict} === "satisfied"',
        }
        lines += [f"const {name} = {value};" for name, value in given.items() if name in used]
        return [*lines, *self._printer.lines(self._program.judged)]


# --- pieces ---------------------------------------------------------------------------------------


def _title(fspa: Fspa) -> str:
    """The first comment: what the spec is called, what it is for, its formula."""
    title = f"Monitor of the specification `{fspa.name}`, written by tltlc."
    about = [[f"// {line}" for line in remark(text)] for text in (title, fspa.doc)]
    about.append([f"//     {line}" for line in remark(fspa.formula.ascii)])
    return "\n//\n".join("\n".join(lines) for lines in about if lines)


def _fields(fields: Sequence[tuple[str, str, str]]) -> str:
    """The fields of an interface, each behind what is said of it."""
    lines: list[str] = []
    for name, type_, doc in fields:
        said = [line.replace("*/", "* /") for line in remark(doc)]
        if len(said) == 1:
            lines.append(f"/** {said[0]} */")
        elif said:
            lines += ["/**", *(f" * {line}" for line in said), " */"]
        lines.append(f"{_key(name)}: {type_};")
    return _block(lines)


def _signal(name: str, type_: str, low: float | None, high: float | None) -> str:
    return f"{{ name: {_string(name)}, isBool: {_bool(type_ == 'bool')}, {_range(low, high)} }}"


def _range(low: float | None, high: float | None) -> str:
    least, greatest = ("-Infinity" if low is None else _number(low)), ("Infinity" if high is None else _number(high))
    return f"low: {least}, high: {greatest}"


def _number(value: float) -> str:
    return repr(float(value)).removesuffix(".0")


def _string(text: str) -> str:
    """A string literal; what does not print is escaped."""
    escaped = text.replace("\\", "\\\\").replace('"', '\\"')
    return '"' + "".join(character if character.isprintable() else _escape(character) for character in escaped) + '"'


def _escape(character: str) -> str:
    code = ord(character)
    return f"\\u{code:04x}" if code < 0x10000 else f"\\u{{{code:x}}}"


def _branch(tests: Sequence[str], word: str, body: str) -> list[str]:
    """``if (A word B) body``, on several lines where it is long."""
    line = f"if ({f' {word} '.join(tests)}) {body}"
    if len(line) <= _LONGEST:
        return [line]
    lines, text = [], tests[0]
    for test in tests[1:]:
        if len(text) + len(test) > _LONGEST - 8:
            lines.append(f"  {text} {word}")
            text = test
        else:
            text = f"{text} {word} {test}"
    return ["if (", *lines, f"  {text}", ") {", f"  {body}", "}"]


def _is_plain(name: str) -> bool:
    return re.fullmatch(r"[A-Za-z_$][A-Za-z0-9_$]*", name) is not None


def _key(name: str) -> str:
    """A property's name, where an object or a type lists it."""
    return name if _is_plain(name) else _string(name)


def _member(of: str, name: str) -> str:
    return f"{of}.{name}" if _is_plain(name) else f"{of}[{_string(name)}]"


def _bool(value: bool) -> str:
    return "true" if value else "false"


def _block(lines: Iterable[str], depth: int = 1) -> str:
    return "\n".join(f"{_JavaScript.INDENT * depth}{line}" if line else "" for line in lines)


def _list(items: Sequence[str]) -> str:
    """An array on one line where that is short, else with a line for each item."""
    line = f"[{', '.join(items)}]"
    if len(line) <= 80 and not any("{" in item for item in items):
        return line
    return "[\n" + "".join(f"{_JavaScript.INDENT}{item},\n" for item in items) + "]"
