"""A stand-alone monitor in Lua 5.1 to 5.4 and LuaJIT: one module, the standard library only.

It computes to the last bit what :class:`tltlc.monitor.Monitor` computes with its default reward, but for ``tanh``,
which newer versions lack, and powers in LuaJIT, which has its own: these are within 1e-12.  Atoms and states have
functions of their own and variables are fields, since Lua takes no more than 200 local variables.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Mapping, Sequence
from typing import ClassVar

from tltlc.automaton.blowup import recursion_room
from tltlc.automaton.fspa import Fspa
from tltlc.backends import Files, Options, Target
from tltlc.backends.code.names import visible
from tltlc.backends.program import judge, states
from tltlc.backends.program.build import program
from tltlc.backends.program.printer import Printer, remark
from tltlc.backends.program.shallow import shallow
from tltlc.backends.program.template import filled
from tltlc.backends.program.tree import Assign, Compare, Declare, Expression, If, Int, Statement
from tltlc.backends.program.uses import called, read

TARGET = Target("lua", "a stand-alone monitor in Lua", ("_monitor.lua",))

_FAILING = {"divide", "sqrt", "power", "exp"}
"""Functions that may have no value."""

_MOST_LOCALS = 150
"""How many parts of a predicate are local variables; those of more are fields."""

_WORDS = """
    and break do else elseif end false for function goto if in local nil not or repeat return then true until while
    abs divide exp failure huge max min param part power signal sqrt tanh value
""".split()
"""Words of the language, and what the functions of atoms and states read beside their own variables."""


def emit(fspa: Fspa, options: Options) -> Files:
    """``NAME_monitor.lua``."""
    name = f"{fspa.name}{TARGET.endings[0]}"
    return {name: _Source(fspa, name).text()}


class _Lua(Printer):
    """Prints Lua; ``fields`` are the tables that variables are fields of, other variables are local."""

    INDENT = "  "
    WORDS: ClassVar = {"and": "and", "or": "or", "not": "not ", "true": "true", "false": "false"}
    END = ""

    def __init__(self, fields: Mapping[str, str], atoms: Sequence[str]) -> None:
        self._fields, self._atoms = fields, atoms

    def name(self, name: str) -> str:
        """There is one kind of numbers."""
        if name == judge.STEPS_REAL:
            return judge.STEPS
        return f"{self._fields[name]}.{name}" if name in self._fields else name

    def declaration(self, statement: Declare) -> str:
        """A field needs none."""
        value = "nil" if statement.value is None else self.text(statement.value)
        if statement.name in self._fields:
            return f"{self.name(statement.name)} = {value}"
        return f"local {statement.name}" if statement.value is None else f"local {statement.name} = {value}"

    def assignment(self, statement: Assign) -> str:
        """The limiting atom is given by its name."""
        match statement:
            case Assign(states.LIMITING, Int(place)):
                return f"{states.LIMITING} = {_string(self._atoms[place]) if place >= 0 else 'nil'}"
        return super().assignment(statement)

    def head(self, test: str, *, first: bool) -> str:
        """The line that begins a case."""
        return f"{'if' if first else 'elseif'} {test} then"

    def otherwise(self) -> str:
        """The line that begins what is done where no test holds."""
        return "else"

    def closing(self) -> list[str]:
        """What ends a branch."""
        return ["end"]

    def comment(self, text: str) -> list[str]:
        """A remark; the blank keeps brackets from beginning a long one."""
        return [f"-- {line}" for line in remark(text)]

    def _written(self, node: Expression) -> tuple[str, int]:
        text, binding = super()._written(node)
        if isinstance(node, Compare) and node.op == "!=":
            text = text.replace(" != ", " ~= ")
        return text, binding


class _Source:
    """The source of one monitor: the pieces that fill the template."""

    def __init__(self, fspa: Fspa, file: str) -> None:
        self._fspa, self._file = fspa, file
        made = self._program = program(fspa, _WORDS)
        self._names = [atom.name for atom in fspa.atoms]
        self._inputs = {**dict.fromkeys(made.signals, "signal"), **dict.fromkeys(made.params, "param")}
        self._at_goal = fspa.judge == "goal"

    def text(self) -> str:
        """The whole file."""
        fspa, made = self._fspa, self._program
        functions = called(statement for part in (*made.values, *made.states) for statement in part)
        with recursion_room():
            atoms = _block(self._atoms())
            moves = "\n".join(self._moves())
            step = _block(self._step())
        pieces = {
            "p": fspa.name,
            "title": self._title(),
            "file": self._file,
            "module": self._file.removesuffix(".lua"),
            "example": self._example(),
            "signal_fields": "\n".join(
                _field(signal.name, "boolean | 0 | 1" if signal.type == "bool" else "number", signal.doc)
                for signal in fspa.signals
            ),
            "param_fields": "\n".join(_field(param.name, "number?", param.doc) for param in fspa.params),
            "signals": _list(
                [
                    f"{{ {_names(signal.name, name)}, is_bool = {_bool(signal.type == 'bool')}, "
                    f"{_range(signal.low, signal.high)} }}"
                    for signal, name in zip(fspa.signals, made.signals, strict=True)
                ]
            ),
            "params": _list(
                [
                    f"{{ {_names(param.name, name)}, value = {float(param.value)!r}, {_range(param.low, param.high)} }}"
                    for param, name in zip(fspa.params, made.params, strict=True)
                ]
            ),
            "parts": "\n-- Parts of long predicates.\nlocal part = {}" if "part." in atoms else "",
            "atoms": atoms,
            "exclusive": _list([f"{{ {', '.join(str(atom + 1) for atom in group)} }}" for group in fspa.exclusive]),
            "states": _block(self._states()),
            "returns": ", the progress of the step" if self._at_goal else "",
            "moves": moves,
            "step": step,
        }
        return filled("monitor.lua.txt", pieces, [*functions, *(["failing"] if functions & _FAILING else [])])

    def _title(self) -> str:
        """The first comment: what the spec is called, what it is for, its formula."""
        fspa = self._fspa
        title = f"Monitor of the specification `{fspa.name}`, written by tltlc."
        about = [[f"-- {line}" for line in remark(text)] for text in (title, fspa.doc)]
        about.append([f"--     {line}" for line in remark(fspa.formula.ascii)])
        return "\n--\n".join("\n".join(lines) for lines in about if lines)

    def _example(self) -> str:
        """A sample, as a call gives it."""
        signals = self._fspa.signals
        shown = [f"{_key(signal.name)} = {'true' if signal.type == 'bool' else '…'}" for signal in signals[:2]]
        text = f"{{ {', '.join([*shown, *(['…'] if len(signals) > 2 else [])])} }}" if signals else "{}"
        return visible(text) if len(text) <= 60 else "signals"

    def _returned(self) -> tuple[str, ...]:
        """What the functions of states return; where a spec is judged at its limit, progress is no matter of edges."""
        progress = (states.PROGRESS,) if self._at_goal else ()
        return (states.TARGET, states.ROBUSTNESS, *progress, states.LIMITING)

    # --- tables -----------------------------------------------------------------------------------

    def _atoms(self) -> list[str]:
        """A table for each atom: its name, that of its variable, its function."""
        lines: list[str] = []
        explained: set[str] = {""}
        for place, (atom, name) in enumerate(zip(self._fspa.atoms, self._program.atoms, strict=True)):
            statements = self._program.values[place]
            parts = [declared.name for declared in _declared(statements)]
            fields = {**self._inputs, **(dict.fromkeys(parts, "part") if len(parts) > _MOST_LOCALS else {})}
            printer = _Lua(fields, self._names)
            used = {self._inputs.get(variable) for variable in read(statements)}
            arguments = "signal, param" if "param" in used else "signal" if "signal" in used else ""
            if atom.doc not in explained:
                lines += printer.comment(atom.doc)
                explained.add(atom.doc)
            lines += ["{", f"  {_names(atom.name, name)},", f"  value = function({arguments})"]
            lines += self._body(printer, name, statements)
            lines += ["  end,", "},"]
        return lines

    def _body(self, printer: _Lua, name: str, statements: Sequence[Statement]) -> list[str]:
        """The statements of the function of an atom."""
        *before, last = statements
        if isinstance(last, Assign) and last.name == name:
            return [*printer.lines(before, depth=2), f"    return {printer.text(last.value)}"]
        return [f"    local {name}", *printer.lines(statements, depth=2), f"    return {name}"]

    def _states(self) -> list[str]:
        rows: list[str] = []
        for state in self._fspa.states:
            ends = state.verdict in ("satisfied", "violated") or (self._at_goal and state.accepting)
            values = f'verdict = "{state.verdict}", accepting = {_bool(state.accepting)}, ends = {_bool(ends)}'
            rows.append(f"[{state.id}] = {{ label = {_string(state.label.ascii)}, {values} }},")
        return rows

    def _moves(self) -> list[str]:
        """A function for each state."""
        atoms = set(self._program.atoms)
        printer = _Lua(dict.fromkeys(self._program.atoms, "value"), self._names)
        returned = ", ".join(self._returned())
        lines: list[str] = []
        for state, statements in zip(self._fspa.states, self._program.states, strict=True):
            lines += ["", *printer.comment(state.label.ascii)]
            lines.append(f"MOVES[{state.id}] = function({'value' if read(statements) & atoms else ''})")
            lines += [f"  local {returned}", *printer.lines(shallow(statements), depth=1)]
            lines += [f"  return {returned}", "end"]
        return lines

    # --- the step function ------------------------------------------------------------------------

    def _step(self) -> list[str]:
        """The transition, then progress, reward and the end of the episode."""
        used = read(self._program.judged)
        verdict = f"STATES[{states.TARGET}].verdict"
        given = {
            judge.ENDS: f"STATES[{states.TARGET}].ends",
            judge.VIOLATED: f'{verdict} == "violated"',
            judge.SATISFIED: f'{verdict} == "satisfied"',
        }
        return [
            f"local {', '.join(self._returned())} = MOVES[self.state](self._value)",
            f"local {judge.BEST}, {judge.DONE} = self.progress, self.done",
            f"local {judge.REWARD}",
            *(f"local {name} = {value}" for name, value in given.items() if name in used),
            *_Lua({}, self._names).lines(self._program.judged),
        ]


# --- statements -----------------------------------------------------------------------------------


def _declared(statements: Iterable[Statement]) -> Iterator[Declare]:
    """Every declaration, also in branches."""
    for statement in statements:
        if isinstance(statement, Declare):
            yield statement
        elif isinstance(statement, If):
            for _, body in statement.cases:
                yield from _declared(body)
            yield from _declared(statement.otherwise)


# --- pieces ---------------------------------------------------------------------------------------


def _field(name: str, type_: str, doc: str) -> str:
    """A field of a class, as language servers read it."""
    said = f" {visible(doc)}" if doc else ""
    return f"---@field {visible(_key(name))} {type_}{said}"


def _names(name: str, field: str) -> str:
    return f"name = {_string(name)}, field = {_string(field)}"


def _range(low: float | None, high: float | None) -> str:
    least = "-huge" if low is None else repr(float(low))
    greatest = "huge" if high is None else repr(float(high))
    return f"low = {least}, high = {greatest}"


def _string(text: str) -> str:
    """A string literal; what does not print is escaped, byte by byte."""
    escaped = text.replace("\\", "\\\\").replace('"', '\\"')
    return '"' + "".join(character if character.isprintable() else _escape(character) for character in escaped) + '"'


def _escape(character: str) -> str:
    return "".join(f"\\{byte:03d}" for byte in character.encode("utf-8", "replace"))


def _key(name: str) -> str:
    """A key, where a table lists it."""
    plain = re.fullmatch(r"[A-Za-z_][A-Za-z0-9_]*", name) and name not in _WORDS
    return name if plain else f"[{_string(name)}]"


def _bool(value: bool) -> str:
    return "true" if value else "false"


def _block(lines: Iterable[str]) -> str:
    return "\n".join(f"{_Lua.INDENT}{line}" if line else "" for line in lines)


def _list(items: Sequence[str]) -> str:
    """A list, with a line for each item."""
    return "{\n" + "".join(f"{_Lua.INDENT}{item},\n" for item in items) + "}" if items else "{}"
