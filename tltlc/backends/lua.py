"""A stand-alone monitor in Lua 5.1 to 5.4, LuaJIT and Luau: one module, standard library only.

It gives the same results to the last bit as :class:`tltlc.monitor.Monitor` with its default reward,
except for ``tanh``, which newer versions of Lua lack, and for powers in LuaJIT, which computes them
in its own way: these agree within 1e-12. Lua allows at most 200 local variables and 200 nested
blocks. For a spec that needs more, variables become fields of tables, and inner blocks become
functions.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from typing import Final

from tltlc.automaton.finite.blowup import recursion_room
from tltlc.automaton.fspa import Fspa
from tltlc.backends import Files, Options, Target
from tltlc.backends.languages.lua_syntax import (
    DEEPEST_BLOCK,
    KEYWORDS,
    LuaPrinter,
    key_access,
    string_literal,
    table_key,
)
from tltlc.backends.templates import fill_template
from tltlc.program import reward_step, snippets, states
from tltlc.program.arithmetic import with_declaration
from tltlc.program.build import program
from tltlc.program.names import printable_line
from tltlc.program.nesting_limit import split_deep_values
from tltlc.program.tree import FAILING, Declare, If, Statement
from tltlc.program.used_names import functions_called, variables_read
from tltlc.resolve.spec import Param, Signal

TARGET = Target(
    "lua",
    "a stand-alone monitor in Lua, also for LÖVE, Roblox and Defold",
    ("_monitor.lua",),
    ("defold", "love", "luajit", "luau", "roblox"),
)

_MOST_LOCALS: Final = 150
"""The most local variables and arguments for the signals, params and atoms of a spec.

The step function has more local variables, and Lua allows 200 in all.
"""

_FEW_STATES: Final = 8
"""The most states among which a step finds the current one by an ``if`` with a case for each state.

If there are more, each state has a function.
"""

_OWN = """
    MOVES STATES abs at_step divide entered exp failure huge kept max min param part power problem read result self
    signal signals sqrt tanh together type value
""".split()
"""Names that the step function uses in the template; no variable of the program may have them."""


def emit(fspa: Fspa, options: Options) -> Files:
    """Return the module ``NAME_monitor.lua``, where NAME is the name of the automaton."""
    name = f"{fspa.name}{TARGET.endings[0]}"
    return {name: _Source(fspa, name).text()}


class _Source:
    """Makes the Lua module of one monitor, by filling the template ``monitor.lua.txt``."""

    def __init__(self, fspa: Fspa, file: str) -> None:
        self._fspa, self._file = fspa, file
        program_ = self._program = program(fspa, [*KEYWORDS, *_OWN])
        self._names = [atom.name for atom in fspa.atoms]
        self._at_goal = fspa.judge == "goal"
        variables = (*program_.signals, *program_.params, *program_.atoms)
        with recursion_room():
            parts = [declaration.name for value in program_.values for declaration in _declarations(value)]
            deepest = max(map(_depth, program_.values), default=0)
        # Each variable counts twice, because it is also an argument of the functions of states.
        self._variables_are_fields = 2 * len(variables) + len(parts) > _MOST_LOCALS or deepest >= DEEPEST_BLOCK
        fields = {
            **{
                name: f"signal{key_access(signal.name)}"
                for signal, name in zip(fspa.signals, program_.signals, strict=True)
            },
            **{
                name: f"param{key_access(param.name)}" for param, name in zip(fspa.params, program_.params, strict=True)
            },
            **{name: f"value{key_access(atom.name)}" for atom, name in zip(fspa.atoms, program_.atoms, strict=True)},
            **{name: f"part.{name}" for name in parts},
        }
        self._few_states = len(fspa.states) <= _FEW_STATES
        self._printer = LuaPrinter(fields if self._variables_are_fields else {}, self._names)

    def text(self) -> str:
        """Return the text of ``NAME_monitor.lua``."""
        fspa, program_ = self._fspa, self._program
        functions = functions_called(statement for part in (*program_.values, *program_.states) for statement in part)
        with recursion_room():
            moves = "\n".join(self._moves())
            step = LuaPrinter.block(self._step())
        present = [
            *functions,
            *(["failing"] if functions & FAILING else []),
            *(["many"] if self._variables_are_fields else []),
        ]
        present += [] if all(program_.always_in_range) else ["kept"]
        present += [] if self._few_states else ["moves"]
        present += ["exclusive"] if program_.exclusive else []
        places = {
            "p": fspa.name,
            "title": snippets.title_comment(fspa, self._printer.comment),
            "file": self._file,
            "module": self._file.removesuffix(".lua"),
            "example": snippets.example_sample(fspa.signals, table_key, " = "),
            "signal_fields": "\n".join(
                _field(
                    signal.name,
                    "boolean | 0 | 1" if signal.type == "bool" else "number",
                    snippets.field_comment(signal.name, signal),
                )
                for signal in fspa.signals
            ),
            "param_fields": "\n".join(
                _field(param.name, "number?", snippets.field_comment(param.name, param)) for param in fspa.params
            ),
            "signals": _list(
                [
                    _row(signal, f"is_bool = {snippets.boolean_literal(signal.type == 'bool')}")
                    for signal in fspa.signals
                ]
            ),
            "params": _list([_row(param, f"value = {snippets.number_literal(param.value)}") for param in fspa.params]),
            "exclusive": _list(
                [f"{{ {', '.join(string_literal(self._names[atom]) for atom in group)} }}" for group in fspa.exclusive]
            ),
            "states": LuaPrinter.block(self._states()),
            "returns": ", the progress of the step" if self._at_goal else "",
            "moves": moves,
            "parts": "\n".join(self._printer.parts).rstrip(),
            "step": step,
        }
        return fill_template("monitor.lua.txt", places, present)

    def _states(self) -> list[str]:
        rows: list[str] = []
        for state, ends in zip(self._fspa.states, map(snippets.boolean_literal, self._program.ends), strict=True):
            values = (
                f'verdict = "{state.verdict}", accepting = {snippets.boolean_literal(state.accepting)}, ends = {ends}'
            )
            rows.append(f"[{state.id}] = {{ label = {string_literal(str(state.label))}, {values} }},")
        return rows

    # --- the functions of states ------------------------------------------------------------------

    def _result_names(self) -> str:
        """Return the names of the values that the function of each state returns, separated by commas.

        Progress is among them only if the spec is judged at its goal (``judge goal``); otherwise it
        does not depend on the edge that is taken.
        """
        progress = (states.PROGRESS,) if self._at_goal else ()
        return ", ".join((states.TARGET, states.ROBUSTNESS, *progress, states.LIMITING))

    def _parameters(self) -> str:
        """Return the parameters that the function of each state has, separated by commas.

        These are all signals, params and atoms computed at every step that any of the functions
        reads. If variables are fields of tables, the parameters are the tables instead.
        """
        if self._variables_are_fields:
            return "signal, param, value"
        program_ = self._program
        lazy_values = [value for value, only in zip(program_.values, program_.only_in, strict=True) if only is not None]
        used = variables_read(statement for statements in (*program_.states, *lazy_values) for statement in statements)
        atoms = [name for name, only in zip(program_.atoms, program_.only_in, strict=True) if only is None]
        return ", ".join(name for name in (*program_.signals, *program_.params, *atoms) if name in used)

    def _moves(self) -> list[str]:
        """Return the lines of a function for each state; an empty list if the automaton has few states."""
        lines: list[str] = []
        for state in [] if self._few_states else self._fspa.states:
            lines += ["", *self._printer.comment(str(state.label))]
            lines += [f"MOVES[{state.id}] = function({self._parameters()})", f"  local {self._result_names()}"]
            lines += [*self._branch(state.id), f"  return {self._result_names()}", "end"]
        return lines

    def _branch(self, state: int) -> list[str]:
        """Return the code of a state: it computes the atoms that only this state needs, and finds the next state."""
        lines: list[str] = []
        for index in self._program.computed_in(state):
            # An empty line separates the comments.
            lines += ["", *(f"  {line}" for line in self._value(index))]
        statements = split_deep_values(self._program.states[state], self._program.atoms)
        return [*lines, *self._printer.lines(statements, depth=1)]

    # --- a step -----------------------------------------------------------------------------------

    def _step(self) -> list[str]:
        parts = [self._tables(), self._read(), self._compute(), self._check(), self._move(), self._judge()]
        return snippets.paragraphs(*parts)

    def _tables(self) -> list[str]:
        """Return the Lua code that declares ``problem`` and, if variables are fields of tables, the tables."""
        lines = ["local problem"] if self._fspa.signals or not all(self._program.always_in_range) else []
        if self._variables_are_fields:
            lines.append("local signal, param, value = self._signal, self.params, self._value")
        return lines

    def _read(self) -> list[str]:
        """Return the code that reads signals, clamped to their ranges, and params into variables."""
        lines: list[str] = []
        if any(signal.type != "bool" for signal in self._fspa.signals):
            lines.append("-- Adding 0 makes floats of whole numbers, which would wrap around in Lua 5.3 and later.")
        for index, (signal, name) in enumerate(zip(self._fspa.signals, self._program.signals, strict=True), start=1):
            variable = self._printer.name(name)
            lines.append(
                f"{'' if self._variables_are_fields else 'local '}{variable} = signals{key_access(signal.name)}"
            )
            lines += _accepting_cases(signal, variable)
            lines += [
                "else",
                f"  {variable}, problem = read(self, {index}, signals)",
                "  if problem then return nil, problem end",
                "end",
            ]
        used = self._program.variables_used
        params = zip(self._fspa.params, self._program.params, strict=True)
        if not self._variables_are_fields:
            lines += [f"local {name} = self.params{key_access(param.name)}" for param, name in params if name in used]
        return lines

    def _compute(self) -> list[str]:
        """Return the code that computes the values, clamped to [-1, 1], of the atoms that every step needs."""
        lines: list[str] = []
        range_checks: list[str] = []
        failing = False
        for index in self._program.computed_in(None):
            atom, name = self._fspa.atoms[index], self._program.atoms[index]
            lines += self._value(index)
            if self._program.always_in_range[index]:
                continue
            if functions_called(self._program.values[index]) & FAILING:
                failing = True
                text = string_literal(f"the atom `{atom.name}` ")
                lines.append(f"if failure then return nil, at_step(self, {text} .. failure) end")
            variable = self._printer.name(name)
            range_checks += [
                f"if not ({variable} >= -1.0 and {variable} <= 1.0) then",
                f"  {variable}, problem = kept(self, {string_literal(atom.name)}, {variable})",
                "  if problem then return nil, problem end",
                "end",
            ]
        return [*(["failure = nil"] if failing else []), *lines, *range_checks]

    def _value(self, index: int) -> list[str]:
        """Return the code that computes the value of an atom, given its index."""
        program_ = self._program
        lines = self._printer.comment(program_.atom_comments[index])
        return [*lines, *self._printer.lines(with_declaration(program_.atoms[index], program_.values[index]))]

    def _check(self) -> list[str]:
        """Return the code that ends a step with an error if two atoms of an ``exclusive`` group hold together."""
        lines: list[str] = []
        for index, group in self._program.exclusive:
            atoms = [self._printer.name(self._program.atoms[atom]) for atom in group]
            holding = " + ".join(f"({atom} > 0.0 and 1 or 0)" for atom in atoms)
            refusal = f"return nil, together(self, {index + 1}, {{ {', '.join(atoms)} }})"
            lines += [f"if {holding} > 1 then", f"  {refusal}", "end"]
        return lines

    def _move(self) -> list[str]:
        """Return the code that finds the next state: a case for each state, or a call of the state's function."""
        if not self._few_states:
            return [f"local {self._result_names()} = MOVES[self.state]({self._parameters()})"]
        lines = ["local state = self.state", f"local {self._result_names()}"]
        for state in self._fspa.states:
            lines.append(f"{'elseif' if state.id else 'if'} state == {state.id} then")
            lines += [f"  {line}" for line in self._printer.comment(str(state.label))]
            lines += self._branch(state.id)
        return [*lines, "end"]

    def _judge(self) -> list[str]:
        """Return the code that computes progress and reward, and whether the episode ends."""
        used = variables_read(self._program.reward_statements)
        definitions = {
            reward_step.ENDS: "entered.ends",
            reward_step.VIOLATED: 'entered.verdict == "violated"',
            reward_step.SATISFIED: 'entered.verdict == "satisfied"',
        }
        running = (reward_step.STEPS, reward_step.BEST, reward_step.DONE)
        return [
            f"local entered = STATES[{states.TARGET}]",
            f"local {', '.join(running)} = self.steps + 1, self.progress, self.done",
            f"local {reward_step.REWARD}",
            *(f"local {name} = {value}" for name, value in definitions.items() if name in used),
            *LuaPrinter({}, self._names).lines(self._program.reward_statements),
        ]


# --- statements -----------------------------------------------------------------------------------


def _declarations(statements: Iterable[Statement]) -> Iterator[Declare]:
    """Yield every declaration among the statements, including those in branches."""
    for statement in statements:
        if isinstance(statement, Declare):
            yield statement
        elif isinstance(statement, If):
            for body in _bodies(statement):
                yield from _declarations(body)


def _depth(statements: Iterable[Statement]) -> int:
    """Return how deep ``if`` statements are nested; 0 if there are none."""
    bodies = [body for statement in statements if isinstance(statement, If) for body in _bodies(statement)]
    return 1 + max(map(_depth, bodies)) if bodies else 0


def _bodies(statement: If) -> tuple[tuple[Statement, ...], ...]:
    return (*(body for _, body in statement.cases), statement.otherwise)


# --- pieces ---------------------------------------------------------------------------------------


def _field(name: str, type_: str, doc: str) -> str:
    """Return a comment ``---@field``, from which language servers read the type of a field of a class."""
    description = f" {printable_line(doc)}" if doc else ""
    return f"---@field {printable_line(table_key(name))} {type_}{description}"


def _accepting_cases(signal: Signal, variable: str) -> list[str]:
    """Return the first cases of the ``if`` that checks a signal: if the value is valid, they convert it to a float.

    ``variable`` is the Lua variable with the value. The caller adds the ``else``.
    """
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


def _row(field: Signal | Param, entries: str) -> str:
    low, high = snippets.number_literal(field.low, "-huge"), snippets.number_literal(field.high, "huge")
    return f"{{ name = {string_literal(field.name)}, {entries}, low = {low}, high = {high} }}"


def _list(items: Sequence[str]) -> str:
    """Return the text of a list in Lua, with a line for each item; ``{}`` if there are no items."""
    return "{\n" + "".join(f"{LuaPrinter.INDENT}{item},\n" for item in items) + "}" if items else "{}"
