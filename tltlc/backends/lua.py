"""A stand-alone monitor in Lua 5.1 to 5.4, LuaJIT and Luau: one module, the standard library only.

It computes to the last bit what :class:`tltlc.monitor.Monitor` computes with its default reward, but for ``tanh``,
which newer versions lack, and powers in LuaJIT, which has its own: these are within 1e-12.  Lua takes no more than 200
local variables and blocks in each other: where a spec has more, variables are fields, and inner blocks are functions.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Mapping, Sequence
from typing import ClassVar, Final

from tltlc.automaton.finite.blowup import recursion_room
from tltlc.automaton.fspa import Fspa
from tltlc.backends import Files, Options, Target
from tltlc.program import judge, pieces, states
from tltlc.program.arithmetic import defined
from tltlc.program.build import program
from tltlc.program.names import visible
from tltlc.program.printer import Printer
from tltlc.program.shallow import shallow
from tltlc.program.template import filled
from tltlc.program.tree import FAILING, Assign, Compare, Declare, Expression, If, Int, Statement
from tltlc.program.uses import called, read
from tltlc.resolve.spec import Param, Signal

TARGET = Target(
    "lua",
    "a stand-alone monitor in Lua, also for LÖVE, Roblox and Defold",
    ("_monitor.lua",),
    ("defold", "love", "luajit", "luau", "roblox"),
)

_MOST_LOCALS: Final = 150
"""How many local variables and arguments fit beside those of the step itself."""

_FEW_STATES: Final = 8
"""How many are told apart one after the other; those of more have functions of their own."""

_DEEPEST: Final = 60
"""How deep blocks nest; the expressions in them need some of Lua's 200 levels, too."""

_KEYWORDS = """
    and break do else elseif end false for function goto if in local nil not or repeat return then true until while
    continue export typeof
""".split()
"""Words of Lua and Luau."""

_OWN = """
    MOVES STATES abs at_step divide entered exp failure huge kept max min param part power problem read result self
    signal signals sqrt tanh together type value
""".split()
"""What a step reads beside the variables of its program."""


def emit(fspa: Fspa, options: Options) -> Files:
    """``NAME_monitor.lua``."""
    name = f"{fspa.name}{TARGET.endings[0]}"
    return {name: _Source(fspa, name).text()}


class _Lua(Printer):
    """Prints Lua; ``fields`` says how variables are written that are fields of tables, the others are local.

    ``parts`` are the lines of functions that hold what would nest too deep; their variables are all fields.
    """

    INDENT = "  "
    COMMENT = "--"
    """The blank behind it keeps brackets from beginning a long one."""
    WORDS: ClassVar = {"and": "and", "or": "or", "not": "not ", "true": "true", "false": "false"}
    END = ""

    def __init__(self, fields: Mapping[str, str], atoms: Sequence[str]) -> None:
        self._fields, self._atoms = fields, atoms
        self._part_count = 0
        self.parts: list[str] = []

    def name(self, name: str) -> str:
        """There is one kind of numbers."""
        return judge.STEPS if name == judge.STEPS_REAL else self._fields.get(name, name)

    def lines(self, statements: Iterable[Statement], depth: int = 0) -> list[str]:
        """The lines of statements; a field without a value needs no declaration."""
        needed = [
            statement
            for statement in statements
            if not (isinstance(statement, Declare) and statement.value is None and statement.name in self._fields)
        ]
        return super().lines(needed, depth)

    def declaration(self, statement: Declare) -> str:
        """A declaration; of a field, an assignment."""
        local = "" if statement.name in self._fields else "local "
        value = "" if statement.value is None else f" = {self.text(statement.value)}"
        return f"{local}{self.name(statement.name)}{value}"

    def assignment(self, statement: Assign) -> str:
        """The limiting atom is given by its name."""
        match statement:
            case Assign(states.LIMITING, Int(place)):
                return f"{states.LIMITING} = {_string(self._atoms[place]) if place >= 0 else 'nil'}"
        return super().assignment(statement)

    def branches(self, statement: If, depth: int) -> list[str]:
        """A branch, or a call of the function that holds it."""
        if depth < _DEEPEST:
            return super().branches(statement, depth)
        self._part_count += 1
        head = f"part[{self._part_count}] = function(signal, param, value)"
        call = f"part[{self._part_count}](signal, param, value)"
        self.parts += [head, *super().branches(statement, 1), "end", ""]
        return [f"{self.INDENT * depth}{call}"]

    def head(self, test: str, *, first: bool) -> str:
        """The line that begins a case."""
        return f"{'if' if first else 'elseif'} {test} then"

    def otherwise(self) -> str:
        """The line that begins what is done where no test holds."""
        return "else"

    def closing(self) -> list[str]:
        """What ends a branch."""
        return ["end"]

    def _written(self, node: Expression) -> tuple[str, int]:
        text, binding = super()._written(node)
        if isinstance(node, Compare) and node.op == "!=":
            text = text.replace(" != ", " ~= ")
        return text, binding


class _Source:
    """The source of one monitor: the pieces that fill the template."""

    def __init__(self, fspa: Fspa, file: str) -> None:
        self._fspa, self._file = fspa, file
        made = self._program = program(fspa, [*_KEYWORDS, *_OWN])
        self._names = [atom.name for atom in fspa.atoms]
        self._at_goal = fspa.judge == "goal"
        variables = (*made.signals, *made.params, *made.atoms)
        with recursion_room():
            parts = [declared.name for value in made.values for declared in _declared(value)]
            deepest = max(map(_depth, made.values), default=0)
        # Variables count twice: they are arguments, too.
        self._many = 2 * len(variables) + len(parts) > _MOST_LOCALS or deepest >= _DEEPEST
        fields = {
            **{name: f"signal{_index(signal.name)}" for signal, name in zip(fspa.signals, made.signals, strict=True)},
            **{name: f"param{_index(param.name)}" for param, name in zip(fspa.params, made.params, strict=True)},
            **{name: f"value{_index(atom.name)}" for atom, name in zip(fspa.atoms, made.atoms, strict=True)},
            **{name: f"part.{name}" for name in parts},
        }
        self._few_states = len(fspa.states) <= _FEW_STATES
        self._printer = _Lua(fields if self._many else {}, self._names)

    def text(self) -> str:
        """The whole file."""
        fspa, made = self._fspa, self._program
        functions = called(statement for part in (*made.values, *made.states) for statement in part)
        with recursion_room():
            moves = "\n".join(self._moves())
            step = _Lua.block(self._step())
        present = [*functions, *(["failing"] if functions & FAILING else []), *(["many"] if self._many else [])]
        present += [] if all(made.sure) else ["kept"]
        present += [] if self._few_states else ["moves"]
        present += ["exclusive"] if made.exclusive else []
        places = {
            "p": fspa.name,
            "title": pieces.title(fspa, self._printer.comment),
            "file": self._file,
            "module": self._file.removesuffix(".lua"),
            "example": pieces.example(fspa.signals, _key, " = "),
            "signal_fields": "\n".join(
                _field(
                    signal.name,
                    "boolean | 0 | 1" if signal.type == "bool" else "number",
                    pieces.described(signal.name, signal),
                )
                for signal in fspa.signals
            ),
            "param_fields": "\n".join(
                _field(param.name, "number?", pieces.described(param.name, param)) for param in fspa.params
            ),
            "signals": _list(
                [_row(signal, f"is_bool = {pieces.boolean(signal.type == 'bool')}") for signal in fspa.signals]
            ),
            "params": _list([_row(param, f"value = {pieces.number(param.value)}") for param in fspa.params]),
            "exclusive": _list(
                [f"{{ {', '.join(_string(self._names[atom]) for atom in group)} }}" for group in fspa.exclusive]
            ),
            "states": _Lua.block(self._states()),
            "returns": ", the progress of the step" if self._at_goal else "",
            "moves": moves,
            "parts": "\n".join(self._printer.parts).rstrip(),
            "step": step,
        }
        return filled("monitor.lua.txt", places, present)

    def _states(self) -> list[str]:
        rows: list[str] = []
        for state, ends in zip(self._fspa.states, map(pieces.boolean, self._program.ends), strict=True):
            values = f'verdict = "{state.verdict}", accepting = {pieces.boolean(state.accepting)}, ends = {ends}'
            rows.append(f"[{state.id}] = {{ label = {_string(state.label.ascii)}, {values} }},")
        return rows

    # --- the functions of states ------------------------------------------------------------------

    def _returned(self) -> str:
        """What the functions of states return; where a spec is judged at its limit, progress is no matter of edges."""
        progress = (states.PROGRESS,) if self._at_goal else ()
        return ", ".join((states.TARGET, states.ROBUSTNESS, *progress, states.LIMITING))

    def _given(self) -> str:
        """What they take: all atoms but those that one state alone needs, and what these are computed from."""
        if self._many:
            return "signal, param, value"
        made = self._program
        alone = [value for value, only in zip(made.values, made.only_in, strict=True) if only is not None]
        used = read(statement for statements in (*made.states, *alone) for statement in statements)
        atoms = [name for name, only in zip(made.atoms, made.only_in, strict=True) if only is None]
        return ", ".join(name for name in (*made.signals, *made.params, *atoms) if name in used)

    def _moves(self) -> list[str]:
        """A function for each state."""
        lines: list[str] = []
        for state in [] if self._few_states else self._fspa.states:
            lines += ["", *self._printer.comment(state.label.ascii)]
            lines += [f"MOVES[{state.id}] = function({self._given()})", f"  local {self._returned()}"]
            lines += [*self._branch(state.id), f"  return {self._returned()}", "end"]
        return lines

    def _branch(self, state: int) -> list[str]:
        """What is done in a state: the values of the atoms that nothing else needs, and the transition."""
        lines: list[str] = []
        for place in self._program.computed_in(state):
            # A line between the comments.
            lines += ["", *(f"  {line}" for line in self._value(place))]
        statements = shallow(self._program.states[state], self._program.atoms)
        return [*lines, *self._printer.lines(statements, depth=1)]

    # --- a step -----------------------------------------------------------------------------------

    def _step(self) -> list[str]:
        parts = [self._tables(), self._read(), self._compute(), self._check(), self._move(), self._judge()]
        return pieces.paragraphs(*parts)

    def _tables(self) -> list[str]:
        """What is wrong with the sample, and the tables that variables are fields of."""
        lines = ["local problem"] if self._fspa.signals or not all(self._program.sure) else []
        if self._many:
            lines.append("local signal, param, value = self._signal, self.params, self._value")
        return lines

    def _read(self) -> list[str]:
        """Signals in their range, and params, in variables of their own."""
        lines: list[str] = []
        if any(signal.type != "bool" for signal in self._fspa.signals):
            lines.append("-- Adding 0 makes floats of whole numbers, which would wrap around in Lua 5.3 and later.")
        for place, (signal, name) in enumerate(zip(self._fspa.signals, self._program.signals, strict=True), start=1):
            variable = self._printer.name(name)
            lines.append(f"{'' if self._many else 'local '}{variable} = signals{_index(signal.name)}")
            lines += _taken(signal, variable)
            lines += [
                "else",
                f"  {variable}, problem = read(self, {place}, signals)",
                "  if problem then return nil, problem end",
                "end",
            ]
        used = self._program.used
        params = zip(self._fspa.params, self._program.params, strict=True)
        if not self._many:
            lines += [f"local {name} = self.params{_index(param.name)}" for param, name in params if name in used]
        return lines

    def _compute(self) -> list[str]:
        """The atoms' values."""
        lines: list[str] = []
        kept: list[str] = []
        failing = False
        for place in self._program.computed_in(None):
            atom, name = self._fspa.atoms[place], self._program.atoms[place]
            lines += self._value(place)
            if self._program.sure[place]:
                continue
            if called(self._program.values[place]) & FAILING:
                failing = True
                text = _string(f"the atom `{atom.name}` ")
                lines.append(f"if failure then return nil, at_step(self, {text} .. failure) end")
            variable = self._printer.name(name)
            kept += [
                f"if not ({variable} >= -1.0 and {variable} <= 1.0) then",
                f"  {variable}, problem = kept(self, {_string(atom.name)}, {variable})",
                "  if problem then return nil, problem end",
                "end",
            ]
        return [*(["failure = nil"] if failing else []), *lines, *kept]

    def _value(self, place: int) -> list[str]:
        """What gives an atom its value."""
        made = self._program
        lines = self._printer.comment(made.remarks[place])
        return [*lines, *self._printer.lines(defined(made.atoms[place], made.values[place]))]

    def _check(self) -> list[str]:
        """Exclusive atoms."""
        lines: list[str] = []
        for place, group in self._program.exclusive:
            atoms = [self._printer.name(self._program.atoms[atom]) for atom in group]
            holding = " + ".join(f"({atom} > 0.0 and 1 or 0)" for atom in atoms)
            refusal = f"return nil, together(self, {place + 1}, {{ {', '.join(atoms)} }})"
            lines += [f"if {holding} > 1 then", f"  {refusal}", "end"]
        return lines

    def _move(self) -> list[str]:
        """The transition, by state."""
        if not self._few_states:
            return [f"local {self._returned()} = MOVES[self.state]({self._given()})"]
        lines = ["local state = self.state", f"local {self._returned()}"]
        for state in self._fspa.states:
            lines.append(f"{'elseif' if state.id else 'if'} state == {state.id} then")
            lines += [f"  {line}" for line in self._printer.comment(state.label.ascii)]
            lines += self._branch(state.id)
        return [*lines, "end"]

    def _judge(self) -> list[str]:
        """Progress, reward and the end of the episode."""
        used = read(self._program.judged)
        given = {
            judge.ENDS: "entered.ends",
            judge.VIOLATED: 'entered.verdict == "violated"',
            judge.SATISFIED: 'entered.verdict == "satisfied"',
        }
        return [
            f"local entered = STATES[{states.TARGET}]",
            f"local {judge.STEPS}, {judge.BEST}, {judge.DONE} = self.steps + 1, self.progress, self.done",
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
            for body in _bodies(statement):
                yield from _declared(body)


def _depth(statements: Iterable[Statement]) -> int:
    """How deep branches nest."""
    bodies = [body for statement in statements if isinstance(statement, If) for body in _bodies(statement)]
    return 1 + max(map(_depth, bodies)) if bodies else 0


def _bodies(statement: If) -> tuple[tuple[Statement, ...], ...]:
    return (*(body for _, body in statement.cases), statement.otherwise)


# --- pieces ---------------------------------------------------------------------------------------


def _field(name: str, type_: str, doc: str) -> str:
    """A field of a class, as language servers read it."""
    said = f" {visible(doc)}" if doc else ""
    return f"---@field {visible(_key(name))} {type_}{said}"


def _taken(signal: Signal, variable: str) -> list[str]:
    """The lines that begin the branch of a signal: what is done where its value needs no second look."""
    if signal.type == "bool":
        return [
            f"if {variable} == true then",
            f"  {variable} = 1.0",
            f"elseif {variable} == false then",
            f"  {variable} = 0.0",
        ]
    low = f"{variable} > -huge" if signal.low is None else f"{variable} >= {float(signal.low)!r}"
    high = f"{variable} < huge" if signal.high is None else f"{variable} <= {float(signal.high)!r}"
    return [f'if type({variable}) == "number" and {low} and {high} then', f"  {variable} = {variable} + 0.0"]


def _row(of: Signal | Param, more: str) -> str:
    low, high = pieces.number(of.low, "-huge"), pieces.number(of.high, "huge")
    return f"{{ name = {_string(of.name)}, {more}, low = {low}, high = {high} }}"


def _string(text: str) -> str:
    """A string literal; what does not print is escaped, byte by byte."""
    return pieces.quoted(text, _escape)


def _escape(character: str) -> str:
    return "".join(f"\\{byte:03d}" for byte in character.encode("utf-8", "replace"))


def _key(name: str) -> str:
    """A key, where a table lists it."""
    plain = re.fullmatch(r"[A-Za-z_][A-Za-z0-9_]*", name) and name not in _KEYWORDS
    return name if plain else f"[{_string(name)}]"


def _index(name: str) -> str:
    """A key, behind a table."""
    key = _key(name)
    return key if key[0] == "[" else f".{key}"


def _list(items: Sequence[str]) -> str:
    """A list, with a line for each item."""
    return "{\n" + "".join(f"{_Lua.INDENT}{item},\n" for item in items) + "}" if items else "{}"
