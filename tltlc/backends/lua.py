"""A stand-alone monitor in Lua 5.1 to 5.4, LuaJIT and Luau: one module, standard library only.

It gives the same results to the last bit as :class:`tltlc.monitor.Monitor` with its default reward,
except for ``tanh``, which newer versions of Lua lack, and for powers in LuaJIT, which computes them
in its own way: these agree within 1e-12. Lua allows at most 200 local variables and 200 nested
blocks. For a spec that needs more, variables become fields of tables, and inner blocks become
functions.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final

from tltlc.automaton.finite.blowup import recursion_room
from tltlc.automaton.fspa import Fspa
from tltlc.automaton.text import label_text
from tltlc.backends import Files, Options, Target
from tltlc.backends.languages.lua_declarations import (
    declaration_row,
    failures_table,
    field_annotation,
    label_texts_table,
    signal_type,
)
from tltlc.backends.languages.lua_syntax import (
    KEYWORDS,
    LuaPrinter,
    enum_tables,
    items_from_0,
    key_access,
    string_literal,
    table_key,
    table_text,
)
from tltlc.backends.languages.lua_variables import TABLES, needs_fields, register_fields, variable_fields
from tltlc.backends.templates import fill_template
from tltlc.program import reward_step, snippets, states
from tltlc.program.arithmetic import with_declaration
from tltlc.program.build import DT, program
from tltlc.program.enums import enums_of
from tltlc.program.nesting_limit import split_deep_values
from tltlc.program.printer import CHOICE
from tltlc.program.shapes import StateTables
from tltlc.program.step_code import StepCode
from tltlc.program.tree import FAILING, Statement
from tltlc.program.used_names import functions_called, variables_read
from tltlc.resolve.spec import Signal

TARGET = Target(
    "lua",
    "a stand-alone monitor in Lua, also for LÖVE, Roblox and Defold",
    ("_monitor.lua",),
    ("defold", "love", "luajit", "luau", "roblox"),
)

_FEW_CASES: Final = 8
"""The most states, or shapes of states, for which a step has an ``if`` with a case for each.

If there are more, each has a function.
"""

_OWN = """
    EDGE_TARGETS FAILURES FIRST_EDGES LEVEL_PROGRESS MOVES STATES STATE_LEVELS STATE_SHAPES abs at_step divide entered
    exp huge kept max min no_value param part power problem read refused result self signal signals sqrt state_shape
    tanh together type value
""".split()
"""Names that the step function uses in the template; no variable of the program may have them."""


def emit(fspa: Fspa, options: Options) -> Files:
    """Return the module ``NAME_monitor.lua``, where NAME is the name of the automaton."""
    name = f"{fspa.name}{TARGET.endings[0]}"
    return {name: _Source(fspa, name).text()}


class _Source(StepCode):
    """Makes the Lua module of one monitor, by filling the template ``monitor.lua.txt``."""

    def __init__(self, fspa: Fspa, file: str) -> None:
        tables = TABLES if fspa.registers else TABLES[:3]
        super().__init__(program(fspa, [*KEYWORDS, *_OWN, *tables]))
        self._file, self._tables_text = file, ", ".join(tables)
        self._names = [atom.name for atom in fspa.atoms]
        self._at_goal = fspa.judge == "goal"
        self._can_fail = any(state.verdict == "violated" for state in fspa.states)
        with recursion_room():
            self._variables_are_fields = needs_fields(self._program)
            fields = variable_fields(self._program) if self._variables_are_fields else {}
        self._few_cases = len(self._program.cases) <= _FEW_CASES
        self._printer = LuaPrinter({**fields, **register_fields(self._program)}, self._names, self._tables_text)

    def text(self) -> str:
        """Return the text of ``NAME_monitor.lua``."""
        fspa, program_ = self._fspa, self._program
        parts = (*program_.values, *program_.updates, *(case.statements for case in program_.cases))
        enums = enums_of(fspa)
        functions = functions_called(statement for part in parts for statement in part)
        with recursion_room():
            moves = "\n".join(self._moves())
            step = LuaPrinter.block(self._step())
        present = [
            *snippets.common_blocks(program_),
            *functions,
            *(["failing"] if functions & FAILING else []),
            *(["many"] if self._variables_are_fields else []),
        ]
        present += [] if all(program_.always_in_range) else ["kept"]
        present += [] if self._few_cases else ["moves"]
        present += ["failures"] if program_.failures else []
        present += ["many_registers"] if fspa.registers and self._variables_are_fields else []
        places = {
            "p": fspa.name,
            "title": snippets.title_comment(fspa, self._printer.comment),
            "file": self._file,
            "module": self._file.removesuffix(".lua"),
            "enums": enum_tables(enums),
            "example": snippets.example_sample(fspa.signals, table_key, " = "),
            "signal_fields": "\n".join(
                field_annotation(signal.name, signal_type(signal), snippets.field_comment(signal.name, signal))
                for signal in fspa.signals
            ),
            "param_fields": "\n".join(
                field_annotation(param.name, "number?", snippets.field_comment(param.name, param))
                for param in fspa.params
            ),
            "signals": table_text(
                [
                    declaration_row(signal, f"is_bool = {snippets.boolean_literal(signal.type == 'bool')}")
                    for signal in fspa.signals
                ]
            ),
            "params": table_text(
                [declaration_row(param, f"value = {snippets.number_literal(param.value)}") for param in fspa.params]
            ),
            "exclusive": table_text(
                [f"{{ {', '.join(string_literal(self._names[atom]) for atom in group)} }}" for group in fspa.exclusive]
            ),
            "register_starts": table_text(
                [
                    f"{{ name = {string_literal(register.name)}, value = {snippets.number_literal(register.initial)} }}"
                    for register in fspa.registers
                ]
            ),
            "states": LuaPrinter.block(self._states()),
            **self._state_tables(program_.tables),
            "returns": ", the progress of the step" if self._at_goal else "",
            "and_limiting": ", the limiting atom, and what a step fails at"
            if program_.failures
            else " and the limiting atom",
            "failures": failures_table(snippets.failure_texts(program_)),
            "moves": moves,
            "dt": f"{DT}, " if fspa.clock_varies else "",
            "length": "length_of(cells, first), " if fspa.clock_varies else "",
            "parts": "\n".join(self._printer.parts).rstrip(),
            "step": step,
        }
        return fill_template("monitor.lua.txt", places, present)

    def _states(self) -> list[str]:
        """Return a row for each state or, if there are tables, for each kind of states, without labels."""
        tables = self._program.tables
        rows: list[str] = []
        for number, index in enumerate(self._program.state_rows):
            state, ends = self._fspa.states[index], snippets.boolean_literal(self._program.ends[index])
            values = (
                f'verdict = "{state.verdict}", accepting = {snippets.boolean_literal(state.accepting)}, ends = {ends}'
            )
            if tables is None:
                english = string_literal(label_text(self._fspa, index))
                values = f"label = {string_literal(str(state.label))}, label_english = {english}, {values}"
            rows.append(f"[{number}] = {{ {values} }},")
        return rows

    def _state_tables(self, tables: StateTables | None) -> dict[str, str]:
        """Return the pieces of the template with the tables of states; they are empty if there are none."""
        if tables is None:
            return {"tables": "", "label_texts": "", "english_texts": ""}
        lines = [
            f"local {name.upper()} = {{{LuaPrinter.items(items_from_0(numbers))}}}"
            for name, numbers in tables.all_tables(self._fspa.judge).items()
        ]
        return {
            "tables": "\n".join(lines),
            "label_texts": label_texts_table(tables.labels),
            "english_texts": label_texts_table(tables.labels_english),
        }

    # --- the functions of states ------------------------------------------------------------------

    def _result_names(self) -> str:
        """Return the names of the values that the function of each state returns, separated by commas.

        Progress is among them only if the spec is judged at its goal (``judge goal``); otherwise it
        does not depend on the edge that is taken.
        """
        progress = (states.PROGRESS,) if self._at_goal else ()
        failure = (states.FAILURE,) if self._program.failures else ()
        return ", ".join((states.TARGET, states.ROBUSTNESS, *progress, states.LIMITING, *failure))

    def _parameters(self) -> str:
        """Return the parameters that the function of each state has, separated by commas.

        These are all signals, params, registers, and atoms computed at every step, that any of the
        functions reads. If variables are fields of tables, the parameters are the tables instead. If
        states share functions, the place of the state's first edge is a parameter, too.
        """
        program_ = self._program
        first_edge = [] if program_.tables is None else [states.FIRST_EDGE]
        if self._variables_are_fields:
            return ", ".join(["signal, param, value", *first_edge])
        lazy_values = [value for value, only in zip(program_.values, program_.only_in, strict=True) if only is not None]
        statements = (*(case.statements for case in program_.cases), *lazy_values)
        used = variables_read(statement for part in statements for statement in part)
        atoms = [name for name, only in zip(program_.atoms, program_.only_in, strict=True) if only is None]
        variables = (*program_.signals, *program_.params, *atoms, *program_.registers)
        return ", ".join([*(name for name in variables if name in used), *first_edge])

    def _moves(self) -> list[str]:
        """Return the lines of a function for each state or shape; an empty list if there are few."""
        lines: list[str] = []
        parameters = self._parameters()
        for number, case in [] if self._few_cases else enumerate(self._program.cases):
            lines += ["", *self._printer.comment(case.comment)]
            lines += [f"MOVES[{number}] = function({parameters})", f"  local {self._result_names()}"]
            lines += [*self._branch(number), f"  return {self._result_names()}", "end"]
        return lines

    def _branch(self, case: int) -> list[str]:
        """Return the code of a case: it computes the atoms that only this case needs, and finds the next state."""
        lines: list[str] = []
        for index in self._program.computed_in(case):
            # An empty line separates the comments.
            lines += ["", *(f"  {line}" for line in self._value(index))]
        statements = split_deep_values(self._program.cases[case].statements, self._program.atoms)
        return [*lines, *self._printer.lines(statements, depth=1)]

    # --- a step -----------------------------------------------------------------------------------

    def _step(self) -> list[str]:
        parts = [self._length(), self._tables(), self._read(), self._compute(), self._check(), self._move()]
        return snippets.paragraphs(*parts, self._judge(), self._remember())

    def _length(self) -> list[str]:
        """Return the code that checks ``dt`` and makes it a float, if the clock varies."""
        if not self._fspa.clock_varies:
            return []
        return [
            f'if type({DT}) ~= "number" or not ({DT} >= 0.0 and {DT} < huge) then',
            f"  return refused(result, at_step(self, length_problem({DT})))",
            "end",
            f"{self._printer.name(DT)} = {DT} + 0.0",
        ]

    def _tables(self) -> list[str]:
        """Return the Lua code that declares ``problem`` and, if variables are fields of tables, the tables."""
        lines = ["local problem"] if self._fspa.signals or not all(self._program.always_in_range) else []
        registers = "local registers = self.registers" if self._fspa.registers else ""
        if self._variables_are_fields:
            registers = ", self._register, self.registers" if registers else ""
            lines.append(f"local {self._tables_text} = self._signal, self.params, self._value{registers}")
        elif registers:
            lines.append(registers)
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
                "  if problem then return refused(result, problem) end",
                "end",
            ]
        used = self._program.variables_used
        params = zip(self._fspa.params, self._program.params, strict=True)
        if not self._variables_are_fields:
            lines += [f"local {name} = self.params{key_access(param.name)}" for param, name in params if name in used]
        return lines

    def _compute(self) -> list[str]:
        return [*(["no_value = nil"] if self._program.functions & FAILING else []), *super()._compute()]

    def _range_check(self, index: int) -> list[str]:
        variable = self._printer.name(self._program.atoms[index])
        return [
            f"if not ({variable} >= -1.0 and {variable} <= 1.0) then",
            f"  {variable}, problem = kept(self, {string_literal(self._names[index])}, {variable})",
            "  if problem then return refused(result, problem) end",
            "end",
        ]

    def _register(self, index: int) -> list[str]:
        program_, statements, name = self._program, self._program.updates[index], self._program.registers[index]
        lines = self._printer.comment(program_.register_comments[index])
        lines += self._printer.lines(with_declaration(name, statements))
        text = f"the register `{self._fspa.registers[index].name}` "
        lines += self._failure(statements, text)
        if not program_.always_finite[index]:
            refusal = f"return refused(result, at_step(self, {string_literal(f'{text}is too large to compute')}))"
            lines += [f"if not is_finite({self._printer.name(name)}) then", f"  {refusal}", "end"]
        return lines

    def _value(self, index: int) -> list[str]:
        program_, statements = self._program, self._program.values[index]
        lines = self._printer.comment(program_.atom_comments[index])
        lines += self._printer.lines(with_declaration(program_.atoms[index], statements))
        return [*lines, *self._failure(statements, f"the atom `{self._names[index]}` ")]

    def _failure(self, statements: Sequence[Statement], text: str) -> list[str]:
        """Return the code that ends a step if one of the statements failed; its message begins with ``text``."""
        fails = functions_called(statements) & FAILING
        refusal = f"return refused(result, at_step(self, {string_literal(text)} .. no_value))"
        return [f"if no_value then {refusal} end"] if fails else []

    def _check(self) -> list[str]:
        lines: list[str] = []
        for index, group in self._program.exclusive:
            atoms = [self._printer.name(self._program.atoms[atom]) for atom in group]
            holding = " + ".join(f"({atom} > 0.0 and 1 or 0)" for atom in atoms)
            refusal = f"return refused(result, together(self, {index + 1}, {{ {', '.join(atoms)} }}))"
            lines += [f"if {holding} > 1 then", f"  {refusal}", "end"]
        return lines

    def _move(self) -> list[str]:
        """Return the code that finds the next state: a case for each state or shape, or a call of its function."""
        has_tables = self._program.tables is not None
        lines = [f"local {states.FIRST_EDGE} = FIRST_EDGES[self.state]"] if has_tables else []
        selected = "STATE_SHAPES[self.state]" if has_tables else "self.state"
        if not self._few_cases:
            return [*lines, f"local {self._result_names()} = MOVES[{selected}]({self._parameters()})"]
        name = "state_shape" if has_tables else "state"
        lines += [f"local {name} = {selected}", f"local {self._result_names()}"]
        for number, case in enumerate(self._program.cases):
            lines.append(f"{'elseif' if number else 'if'} {name} == {number} then")
            lines += [f"  {line}" for line in self._printer.comment(case.comment)]
            lines += self._branch(number)
        return [*lines, "end"]

    def _judge(self) -> list[str]:
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

    def _remember(self) -> list[str]:
        registers = zip(self._program.before, self._program.kept, strict=True)
        kept = [f"{self._printer.name(before)} = {self._printer.text(kept, CHOICE)}" for before, kept in registers]
        return [*kept, *self._fail()]

    def _fail(self) -> list[str]:
        """Return the code that keeps what the trace fails at, at the first step at which it does."""
        if not self._can_fail:
            return []
        if not self._program.failures:
            # The trace has failed before it begins.
            return [f"self._failed_step = self._failed_step or {reward_step.STEPS}"]
        update = f"self._failed_step, self._failure = {reward_step.STEPS}, FAILURES[{states.FAILURE} + 1]"
        return [f"if {states.FAILURE} then", f"  {update}", "end"]


# --- pieces ---------------------------------------------------------------------------------------


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
