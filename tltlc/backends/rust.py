"""A stand-alone monitor in Rust, which is one module of `core` alone but for roots, powers, ``exp`` and ``tanh``.

It computes to the last bit what :class:`tltlc.monitor.Monitor` computes with its default reward, where the platform's
``pow``, ``exp`` and ``tanh`` are those that Python was built with.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Sequence
from textwrap import wrap
from typing import ClassVar

from tltlc.automaton.blowup import recursion_room
from tltlc.automaton.fspa import Fspa
from tltlc.backends import Files, Options, Target
from tltlc.backends.program import judge, states
from tltlc.backends.program.build import program
from tltlc.backends.program.printer import Printer, remark
from tltlc.backends.program.template import filled
from tltlc.backends.program.tree import Assign, Binary, Comment, Declare, If, Statement, Type, Variable
from tltlc.backends.program.uses import called, read
from tltlc.monitor.samples import range_text
from tltlc.resolve.spec import Param, Signal

TARGET = Target("rust", "a stand-alone monitor in Rust", ("_monitor.rs",))

_INDENT = Printer.INDENT
_FAILING = {"divide", "sqrt", "power", "exp"}
"""Functions that may have no value."""

_MATH = {"sqrt", "power", "exp", "tanh"}
"""Functions that ``core`` does not have."""

_RESERVED = """
    abstract as async await become box break const continue crate do dyn else enum extern false final fn for gen if
    impl in let loop macro match mod move mut override priv pub raw ref return self Self static struct super trait
    true try type typeof union unsafe unsized use virtual where while yield auto default macro_rules safe
    abs core exp f64 bool char str usize isize i8 i16 i32 i64 i128 u8 u16 u32 u64 u128 f16 f32 f128 math max min place
    entered sample fmt std alloc main program tltl_math
    ATOM_NAMES Default Err GROUPS LARGEST_GROUP Monitor NOTICE_ROOM None Notice Ok Option Params Place Problem Refused
    Result SIGNAL_NAMES STATES Shown Signals Some Step Verdict WrongParam
""".split()
"""Words of the language, and what stands in the template beside the program."""

_CORE = "It needs `core` alone."
_MORE = """
It needs `core`, and {names} of `std`.  Without `std`, build with `--cfg tltl_no_std` and give the crate a module
`tltl_math` with {functions} on f64, as the crate `libm` has them.
"""


def emit(fspa: Fspa, options: Options) -> Files:
    """``NAME_monitor.rs``."""
    name = f"{fspa.name}{TARGET.endings[0]}"
    return {name: _Source(fspa, name).text()}


class _Rust(Printer):
    """Prints Rust; ``atom`` is the number of the one whose predicate is being printed."""

    TYPES: ClassVar[dict[Type, str]] = {"real": "f64", "int": "i64", "bool": "bool"}

    def __init__(self) -> None:
        self.atom = 0

    def declaration(self, statement: Declare) -> str:
        """A declaration; what has no value yet says its type."""
        head = f"let mut {statement.name}" if statement.changes else f"let {statement.name}"
        if statement.value is None:
            return f"{head}: {self.TYPES[statement.type]};"
        return f"{head} = {self.text(statement.value)};"

    def assignment(self, statement: Assign) -> str:
        """An assignment; what only adds or subtracts says so."""
        match statement:
            case Assign(name, Binary("+" | "-" as op, Variable(left), right)) if left == name:
                return f"{name} {op}= {self.text(right)};"
        return super().assignment(statement)

    def head(self, test: str, *, first: bool) -> str:
        """The line that begins a case."""
        return f"if {test} {{" if first else f"}} else if {test} {{"

    def call(self, function: str, arguments: Sequence[str]) -> str:
        """A call; what may have no value ends the step."""
        if function in _FAILING:
            return super().call(f"self.{function}", [str(self.atom), *arguments]) + "?"
        return super().call(f"math::{function}" if function in _MATH else function, arguments)


class _Source:
    """The source of one monitor: the pieces that fill the template."""

    def __init__(self, fspa: Fspa, file: str) -> None:
        self._fspa, self._file = fspa, file
        self._program = program(fspa, _RESERVED)
        self._printer = _Rust()
        # The first atom of each predicate is where that is explained.
        first = {atom.doc: place for place, atom in reversed([*enumerate(fspa.atoms)]) if atom.doc}
        self._explained = {*first.values()}

    def text(self) -> str:
        """The whole file."""
        fspa, made = self._fspa, self._program
        signals = list(zip(fspa.signals, made.signals, strict=True))
        params = list(zip(fspa.params, made.params, strict=True))
        computed = called(statement for value in made.values for statement in value)
        present = [*computed, "exclusive" if fspa.exclusive else "single", *([] if all(made.sure) else ["keep"])]
        present += ["math"] if computed & _MATH else []
        present += ["number"] if any(signal.type != "bool" for signal in fspa.signals) else []
        with recursion_room():
            step = _block(self._step(), 2)
        give = self._give()
        pieces = {
            "p": fspa.name,
            "title": "\n".join(self._title()),
            "file": self._file,
            "needs": "\n".join(self._needs(computed & _MATH)),
            "signal_fields": _fields([(name, _type(signal), signal) for signal, name in signals]),
            "param_fields": _fields([(name, "f64", param) for param, name in params]),
            "signal_count": str(len(signals)),
            "atom_count": str(len(fspa.atoms)),
            "group_count": str(len(fspa.exclusive)),
            "state_count": str(len(fspa.states)),
            "signal_names": _list([_string(signal.name) for signal in fspa.signals]),
            "atom_names": _list([_string(atom.name) for atom in fspa.atoms]),
            "largest_group": str(max(map(len, fspa.exclusive), default=0)),
            "groups": _list([f"&[{', '.join(map(str, group))}]" for group in fspa.exclusive]),
            "signal_defaults": _block(
                [f"{name}: {'false' if signal.type == 'bool' else 'f64::NAN'}," for signal, name in signals], 3
            ),
            "param_defaults": _block([f"{name}: {_number(param.value)}," for param, name in params], 3),
            "param_checks": _block([line for param, name in params for line in _param_check(param, name)], 2),
            "states": _block(self._states(), 1),
            "sample": "sample" if "sample." in step else "_",
            "step": step,
            "given": "sample" if give else "_",
            "give": _block(give or ["signal < SIGNAL_NAMES.len() && value.is_finite()"], 2),
        }
        return filled("monitor.rs.txt", pieces, present)

    def _title(self) -> list[str]:
        """The first comment: what the spec is called, what it is for, its formula."""
        fspa = self._fspa
        title = f"Monitor of the specification `{fspa.name}`, written by tltlc."
        formula = ["```text", *remark(fspa.formula.ascii.replace("```", "'''")), "```"]
        about = [_markdown(title), _markdown(fspa.doc), formula]
        parts = ["\n".join(f"//! {line}" for line in lines) for lines in about if lines]
        return ["\n//!\n".join(parts)]

    def _needs(self, functions: frozenset[str]) -> list[str]:
        """What the file needs beside the language."""
        if not functions:
            return [f"//! {_CORE}"]
        names = [f"`{'pow' if function == 'power' else function}`" for function in sorted(functions)]
        listed = " and ".join([*([", ".join(names[:-1])] if names[1:] else []), names[-1]])
        text = " ".join(_MORE.format(names=listed, functions=listed).split())
        return [f"//! {line}" for line in wrap(text, 115, break_on_hyphens=False)]

    def _states(self) -> list[str]:
        lines: list[str] = []
        for state in self._fspa.states:
            ends = state.verdict in ("satisfied", "violated") or (self._fspa.judge == "goal" and state.accepting)
            values = (f"Verdict::{state.verdict.capitalize()}", _bool(state.accepting), _bool(ends))
            lines.append(f"place({_string(state.label.ascii)}, {', '.join(values)}),")
        return lines

    def _give(self) -> list[str]:
        """A case for each signal, by its number."""
        if not self._fspa.signals:
            return []
        lines = ["match signal {"]
        for place, (signal, name) in enumerate(zip(self._fspa.signals, self._program.signals, strict=True)):
            if signal.type == "bool":
                lines.append(f"{_INDENT}{place} if value != 0.0 && value != 1.0 => return false,")
            given = "value == 1.0" if signal.type == "bool" else "value"
            lines.append(f"{_INDENT}{place} => sample.{name} = {given},")
        return [*lines, f"{_INDENT}_ => {{}}", "}", "true"]

    # --- a step -----------------------------------------------------------------------------------

    def _step(self) -> list[str]:
        parts = [self._read(), self._compute(), self._check(), self._move(), self._judge()]
        return "\n\n".join("\n".join(part) for part in parts if part).split("\n")

    def _read(self) -> list[str]:
        """Signals in their range, and params, in variables of their own."""
        used = read(statement for value in self._program.values for statement in value)
        lines: list[str] = []
        for place, (signal, name) in enumerate(zip(self._fspa.signals, self._program.signals, strict=True)):
            if signal.type == "bool":
                lines += [f"let {name} = if sample.{name} {{ 1.0 }} else {{ 0.0 }};"] if name in used else []
                continue
            low, high = _number(signal.low, "f64::NEG_INFINITY"), _number(signal.high, "f64::INFINITY")
            head = f"let {name} = " if name in used else ""
            lines.append(f"{head}self.read({place}, sample.{name}, {low}, {high})?;")
        return [*lines, *(f"let {name} = self.params.{name};" for name in self._program.params if name in used)]

    def _compute(self) -> list[str]:
        """The atoms' values."""
        lines: list[str] = []
        used = read([statement for state in self._program.states for statement in state])
        used |= {self._program.atoms[atom] for group in self._fspa.exclusive if len(group) > 1 for atom in group}
        kept: list[str] = []
        for place, name in enumerate(self._program.atoms):
            if self._program.only_in[place] is not None:
                continue
            lines += self._value(place)
            head = f"let {name} = " if name in used else ""
            kept += [] if self._program.sure[place] else [f"{head}self.keep({place}, {name})?;"]
        return [*lines, *kept]

    def _value(self, place: int, depth: int = 0) -> list[str]:
        """What gives an atom its value."""
        atom, made = self._fspa.atoms[place], self._program
        self._printer.atom = place
        text = f"{atom.name}: {atom.doc}" if place in self._explained else atom.name
        return self._printer.lines((Comment(text), *_defined(made.atoms[place], made.values[place])), depth)

    def _alone(self, state: int) -> list[str]:
        """The values of the atoms that nothing but this state needs."""
        only_in = self._program.only_in
        return [line for place, only in enumerate(only_in) if only == state for line in self._value(place, depth=2)]

    def _check(self) -> list[str]:
        """Exclusive atoms."""
        lines: list[str] = []
        for place, group in enumerate(self._fspa.exclusive):
            tests = [f"{self._program.atoms[atom]} > 0.0" for atom in group]
            if len(group) > 1:
                lines.append(f"if {' + '.join(f'u32::from({test})' for test in tests)} > 1 {{")
                lines += [f"{_INDENT}return Err(self.together({place}, &[{', '.join(tests)}]));", "}"]
        return lines

    def _move(self) -> list[str]:
        """The transition, by state."""
        lines = [f"let mut {states.TARGET} = self.state;", f"let mut {states.LIMITING}: isize = -1;"]
        lines.append(f"let mut {states.ROBUSTNESS} = 0.0;")
        lines += [f"let mut {states.PROGRESS} = 0.0;"] if self._fspa.judge == "goal" else []
        lines.append("match self.state {")
        for state, statements in zip(self._fspa.states, self._program.states, strict=True):
            lines += [f"{_INDENT}{line}" for line in self._printer.comment(state.label.ascii)]
            lines += [f"{_INDENT}{state.id} => {{", *self._alone(state.id)]
            lines += [*self._printer.lines(statements, depth=2), f"{_INDENT}}}"]
        return [*lines, f"{_INDENT}_ => {{}}", "}"]

    def _judge(self) -> list[str]:
        """Progress, reward and the end of the episode."""
        used = read(self._program.judged)
        verdict = "entered.verdict"
        lines = [f"let entered = &STATES[{states.TARGET}];"]
        lines += [f"let mut {judge.BEST} = self.progress;", f"let mut {judge.DONE} = self.done;"]
        # Penalties change it.
        lines.append(f"let {'' if self._fspa.limit_steps is None else 'mut '}{judge.REWARD};")
        given = {
            judge.STEPS_REAL: f"let {judge.STEPS_REAL} = {judge.STEPS} as f64;",
            judge.ENDS: f"let {judge.ENDS} = entered.ends;",
            judge.VIOLATED: f"let {judge.VIOLATED} = {verdict} == Verdict::Violated;",
            judge.SATISFIED: f"let {judge.SATISFIED} = {verdict} == Verdict::Satisfied;",
        }
        lines += [line for name, line in given.items() if name in used]
        return [*lines, *self._printer.lines(self._program.judged)]


# --- pieces ---------------------------------------------------------------------------------------


def _defined(name: str, statements: Sequence[Statement]) -> tuple[Statement, ...]:
    """The statements that give an atom its value, and the declaration of the variable."""
    *before, last = statements
    if isinstance(last, Assign) and last.name == name:
        return (*before, Declare(name, "real", last.value))
    assert isinstance(last, If), "a value is assigned, or by branches"
    return (*before, Declare(name, "real"), last)


def _type(signal: Signal) -> str:
    return "bool" if signal.type == "bool" else "f64"


def _fields(fields: Sequence[tuple[str, str, Signal | Param]]) -> str:
    """The fields of a struct, each under its name in the spec and what is said of it."""
    lines: list[str] = []
    for name, type_, of in fields:
        texts = [*([of.name] if of.name != name else []), *([of.doc] if of.doc else [])]
        lines += [f"/// {line}" for line in _markdown(": ".join(texts) or _kind(of))]
        lines.append(f"pub {name}: {type_},")
    return _block(lines, 1)


def _kind(of: Signal | Param) -> str:
    """What is said of a signal or param of which the spec says nothing."""
    return "True or false." if of.type == "bool" else f"In {range_text(of.low, of.high)}."


def _markdown(text: str) -> list[str]:
    """Lines of documentation: no code, which would be run as a test, no HTML and no links."""
    escaped = re.sub(r"`{3,}|~{3,}|<|\](?=[(\[:])", lambda found: re.sub("(.)", r"\\\1", found[0]), text)
    return remark(escaped)


def _param_check(param: Param, name: str) -> list[str]:
    value = f"params.{name}"
    tests = [f"{value}.is_finite()"]
    tests += [] if param.low is None else [f"{value} >= {_number(param.low)}"]
    tests += [] if param.high is None else [f"{value} <= {_number(param.high)}"]
    low, high = _number(param.low, "f64::NEG_INFINITY"), _number(param.high, "f64::INFINITY")
    test = f"!({' && '.join(tests)})" if tests[1:] else f"!{tests[0]}"
    wrong = f"WrongParam {{ name: {_string(param.name)}, value: {value}, low: {low}, high: {high} }}"
    return [f"if {test} {{", f"{_INDENT}return Err({wrong});", "}"]


def _number(value: float | None, otherwise: str = "") -> str:
    return otherwise if value is None else repr(float(value))


def _string(text: str) -> str:
    """A string literal in ASCII."""
    escaped = text.replace("\\", "\\\\").replace('"', '\\"')
    return '"' + "".join(char if " " <= char < "\x7f" else _escape(ord(char)) for char in escaped) + '"'


def _escape(code: int) -> str:
    """Halves of pairs, which no text of Rust holds, are replaced."""
    return "\\u{fffd}" if 0xD800 <= code < 0xE000 else f"\\u{{{code:x}}}"


def _bool(value: bool) -> str:
    return "true" if value else "false"


def _block(lines: Iterable[str], depth: int) -> str:
    return "\n".join(f"{_INDENT * depth}{line}" if line else "" for line in lines)


def _list(items: Sequence[str]) -> str:
    """The items between brackets: on one line where they are short, else on lines of their own."""
    line = ", ".join(items)
    if len(line) <= 60:
        return line
    if all(len(item) < 12 for item in items):
        items = [wrapped.rstrip(",") for wrapped in wrap(line, 100)]
    return "\n" + "".join(f"{_INDENT}{item},\n" for item in items)
