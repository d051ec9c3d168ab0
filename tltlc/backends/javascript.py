"""A stand-alone monitor in JavaScript: one ES module for browsers and Node, and its types for TypeScript.

It computes what :class:`tltlc.monitor.Monitor` computes with its default reward: to the last bit where predicates take
no ``exp``, ``tanh`` or power, else within 1e-12, since engines have functions of their own.
"""

from __future__ import annotations

import re
from collections.abc import Collection, Sequence
from itertools import combinations

from tltlc.automaton.finite.blowup import recursion_room
from tltlc.automaton.fspa import Fspa
from tltlc.backends import Files, Options, Target
from tltlc.program import judge, pieces, states
from tltlc.program.arithmetic import defined
from tltlc.program.build import program
from tltlc.program.printer import Printer, remark
from tltlc.program.shallow import shallow
from tltlc.program.template import filled
from tltlc.program.tree import FAILING, Assign, Compare, Declare, Expression, Int
from tltlc.program.uses import called, read
from tltlc.resolve.spec import Param, Signal

TARGET = Target(
    "javascript",
    "a stand-alone monitor in JavaScript, with types",
    ("_monitor.mjs", "_monitor.d.mts"),
    ("js", "mjs", "node", "ts", "typescript", "web"),
)

_LONGEST = 110

_FEW = 3
"""Of so many atoms, pairs are compared; more are counted."""

_ENTERED = "entered"
"""The row of the state that is entered."""

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

    def __init__(self, atoms: Sequence[str], built_in: Collection[str] = ("abs", "tanh")) -> None:
        self._atoms, self._built_in = atoms, built_in

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
        if function in self._built_in:
            function = f"Math.{function}"
        return super().call(f"this.#{function}" if function in FAILING else function, arguments)

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
        names = [atom.name for atom in fspa.atoms]
        self._printer = _JavaScript(names)
        # Among values of atoms no sign of a 0 matters, and Math.min is quicker than a function of our own.
        self._moves = _JavaScript(names, ("min", "max"))

    def module(self) -> str:
        """The whole module."""
        fspa = self._fspa
        made = self._program
        with recursion_room():
            step = _JavaScript.block(self._step(), depth=2)
        present: list[str] = [*made.functions, *(["failing"] if made.functions & FAILING else [])]
        present += ["signal"] if fspa.signals else []
        present += [] if all(made.sure) else ["range"]
        present += ["exclusive"] if made.exclusive else []
        present += ["atom"] if {"failing", "range", "exclusive"} & {*present} else []
        present += ["some"] if fspa.signals or "atom" in present else []
        present += ["clamp"] if fspa.signals or "range" in present else []
        present += ["params"] if made.used & {*made.params} else []
        places = {
            "title": pieces.title(fspa, self._printer.comment),
            "file": self._module,
            "declarations": self._declarations,
            "example": pieces.example(fspa.signals, _key, ": "),
            "signals": _list(
                [_row(signal, f"isBool: {pieces.boolean(signal.type == 'bool')}") for signal in fspa.signals]
            ),
            "params": _list([_row(param, f"value: {_number(param.value)}") for param in fspa.params]),
            "atoms": _list([_string(atom.name) for atom in fspa.atoms]),
            # Where no atom reads a param, names are checked all the same.
            "params_kept": "this.#params = " if "params" in present else "",
            "exclusive": _list([f"[{', '.join(map(str, group))}]" for group in fspa.exclusive]),
            "states": _list(self._states()),
            "step": step,
        }
        return filled("monitor.mjs.txt", places, present)

    def declarations(self) -> str:
        """The whole file of types."""
        fspa = self._fspa
        signals = [
            (
                signal.name,
                "boolean | 0 | 1" if signal.type == "bool" else "number",
                pieces.described(signal.name, signal),
            )
            for signal in fspa.signals
        ]
        params = [(param.name, "number", pieces.described(param.name, param)) for param in fspa.params]
        title = f"// Types of {self._module}, written by tltlc."
        places = {"title": title, "signal_fields": _fields(signals), "param_fields": _fields(params)}
        present = ["signals" if signals else "no_signals", "params" if params else "no_params"]
        return filled("monitor.d.mts.txt", places, present)

    def _states(self) -> list[str]:
        rows: list[str] = []
        for state, ends in zip(self._fspa.states, map(pieces.boolean, self._program.ends), strict=True):
            values = f'verdict: "{state.verdict}", accepting: {pieces.boolean(state.accepting)}, ends: {ends}'
            rows.append(f"{{ label: {_string(state.label.ascii)}, {values} }}")
        return rows

    # --- the step function ------------------------------------------------------------------------

    def _step(self) -> list[str]:
        return pieces.paragraphs(self._read(), self._compute(), self._check(), self._move(), self._judge())

    def _read(self) -> list[str]:
        """Signals in their range, and params, in variables of their own."""
        used = self._program.used
        lines: list[str] = []
        for place, (signal, name) in enumerate(zip(self._fspa.signals, self._program.signals, strict=True)):
            checked = f"this.#signal({place}, signals)"
            if name not in used:
                # It is held to be a number all the same.
                lines.append(f"{checked};")
                continue
            given = _member("signals", signal.name)
            if signal.type == "bool":
                lines.append(f"const {name} = {given} === true ? 1 : {given} === false ? 0 : {checked};")
            else:
                lines.append(f"let {name} = {given};")
                lines += _branch([f"!({_in_range(name, signal.low, signal.high)})"], f"{name} = {checked};")
        for place, name in enumerate(self._program.params):
            lines += [f"const {name} = this.#params[{place}];"] if name in used else []
        return lines

    def _compute(self) -> list[str]:
        """The atoms' values, but for those that one state alone reads."""
        lines = self._values(None)
        for place, (name, sure) in enumerate(zip(self._program.atoms, self._program.sure, strict=True)):
            if not sure:
                lines.append(f"if (!(-1 <= {name} && {name} <= 1)) {name} = this.#inRange({place}, {name});")
        return lines

    def _values(self, state: int | None) -> list[str]:
        """The values of the atoms that are computed in a state alone, or at each step."""
        return [line for place in self._program.computed_in(state) for line in self._value(place)]

    def _value(self, place: int) -> list[str]:
        """The value of one atom."""
        made, statements = self._program, self._program.values[place]
        lines = self._printer.comment(made.remarks[place])
        if called(statements) & FAILING:
            lines.append(f"this.#atom = {place};")
        return [*lines, *self._printer.lines(defined(made.atoms[place], statements, changes=not made.sure[place]))]

    def _check(self) -> list[str]:
        """Exclusive atoms."""
        lines: list[str] = []
        for place, group in self._program.exclusive:
            names = [self._program.atoms[atom] for atom in group]
            refusal = f"throw this.#together({place}, [{', '.join(names)}]);"
            if len(names) <= _FEW:
                pairs = [f"{one} > 0 && {other} > 0" for one, other in combinations(names, 2)]
                tests = pairs if len(pairs) == 1 else [f"({pair})" for pair in pairs]
                lines += _branch(tests, refusal, "||")
            else:
                *before, last = [f"({name} > 0 ? 1 : 0)" for name in names]
                lines += _branch([*before, f"{last} > 1"], refusal, "+")
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
            lines += [f"    {line}" for line in self._values(state.id)]
            lines += self._moves.lines(shallow(statements, self._names), depth=2)
            lines += ["    break;", "  }"]
        return [*lines, "}"]

    def _judge(self) -> list[str]:
        """Progress, reward and the end of the episode."""
        used = read(self._program.judged)
        lines = [f"const {_ENTERED} = STATES[{states.TARGET}];", f"let {judge.BEST} = this.progress;"]
        lines += [f"let {judge.DONE} = this.done;", f"let {judge.REWARD};"]
        given = {
            judge.ENDS: f"{_ENTERED}.ends",
            judge.VIOLATED: f'{_ENTERED}.verdict === "violated"',
            judge.SATISFIED: f'{_ENTERED}.verdict === "satisfied"',
        }
        lines += [f"const {name} = {value};" for name, value in given.items() if name in used]
        return [*lines, *self._printer.lines(self._program.judged)]


# --- pieces ---------------------------------------------------------------------------------------


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
    return _JavaScript.block(lines)


def _row(of: Signal | Param, more: str) -> str:
    least = "-Infinity" if of.low is None else _number(of.low)
    greatest = "Infinity" if of.high is None else _number(of.high)
    return f"{{ name: {_string(of.name)}, {more}, low: {least}, high: {greatest} }}"


def _number(value: float) -> str:
    return repr(float(value)).removesuffix(".0")


def _string(text: str) -> str:
    return pieces.quoted(text, _escape)


def _escape(character: str) -> str:
    code = ord(character)
    return f"\\u{code:04x}" if code < 0x10000 else f"\\u{{{code:x}}}"


def _in_range(name: str, low: float | None, high: float | None) -> str:
    """A test whether a variable is a finite number from ``low`` to ``high``."""
    if low is None and high is None:
        return f"Number.isFinite({name})"
    least = f"-Infinity < {name}" if low is None else f"{_number(low)} <= {name}"
    greatest = f"{name} < Infinity" if high is None else f"{name} <= {_number(high)}"
    return f'typeof {name} === "number" && {least} && {greatest}'


def _branch(tests: Sequence[str], body: str, word: str = "") -> list[str]:
    """``if (A word B) body``, on several lines where it is long."""
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


def _is_plain(name: str) -> bool:
    return re.fullmatch(r"[A-Za-z_$][A-Za-z0-9_$]*", name) is not None


def _key(name: str) -> str:
    """A property's name, where an object or a type lists it."""
    return name if _is_plain(name) else _string(name)


def _member(of: str, name: str) -> str:
    return f"{of}.{name}" if _is_plain(name) else f"{of}[{_string(name)}]"


def _list(items: Sequence[str]) -> str:
    """An array on one line where that is short, else with a line for each item."""
    line = f"[{', '.join(items)}]"
    if len(line) <= 80 and not any("{" in item for item in items):
        return line
    return "[\n" + "".join(f"{_JavaScript.INDENT}{item},\n" for item in items) + "]"
