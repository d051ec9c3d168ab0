"""A stand-alone monitor in Python: one file, standard library only, one function per state or shape of states.

The monitor is printed from the program of :mod:`tltlc.program`. It gives the same results to the
last bit as :class:`tltlc.monitor.Monitor` with its default reward.
"""

from __future__ import annotations

import builtins
import keyword
from collections.abc import Sequence
from typing import Final

from tltlc.automaton.finite.blowup import recursion_room
from tltlc.automaton.fspa import Fspa
from tltlc.automaton.memory import Computation
from tltlc.automaton.text import label_text
from tltlc.backends import Files, Options, Target
from tltlc.backends.languages.python_declarations import (
    high_literal,
    label_texts,
    low_literal,
    signal_row,
    two_hold,
    within,
)
from tltlc.backends.languages.python_syntax import PythonPrinter, long_dict, long_tuple, short_tuple, tuple_items
from tltlc.backends.templates import fill_template, names_in
from tltlc.program import reward_step, snippets, states
from tltlc.program.arithmetic import with_declaration
from tltlc.program.build import DT, program
from tltlc.program.enums import enums_of, nested_enums, upper_case
from tltlc.program.names import call_lines, docstring_text, float_literal, string_literal
from tltlc.program.nesting_limit import split_deep_values
from tltlc.program.printer import CHOICE, Printer
from tltlc.program.shapes import StateTables
from tltlc.program.tree import (
    FAILING,
    Assign,
    CommentLine,
    If,
    Int,
    Statement,
)
from tltlc.program.used_names import assigned_in, functions_called, variables_read
from tltlc.resolve.spec import Param, Signal

TARGET = Target("python", "a stand-alone monitor in Python", ("_monitor.py",), ("py",))

_RESERVED: Final = (
    *keyword.kwlist,
    *dir(builtins),
    *("self", "signals", "label", "label_english", "verdict", "accepting", "failing", "error", "values", "main"),
    *("inf", "isfinite", "pow", "sqrt", "exp", "tanh", "json", "os", "re", "sys"),
    *("Step", "Monitor", "MonitorError", "BinaryIO", "Callable", "Iterator", "Mapping", "NamedTuple"),
)
"""Names that the step function uses, which no variable of the program may have."""

_FUNCTIONS: Final[dict[str, str]] = {"power": "pow", "sqrt": "sqrt", "exp": "exp", "tanh": "tanh"}
"""The functions of a program that are in the module ``math``, with their names there."""

_SAMPLE: Final = "dict[str, float]"
"""The type of a sample of a trace."""

_STEP_LENGTHS: Final[dict[str, str]] = {
    "collection": "Collection, ",
    "dt": f", {DT}: float | None = None",
    "and_dt": f", {DT}",
    "sample": f"tuple[{_SAMPLE}, float]",
    "and_length": ", length",
    "lengths": ", lengths: _StepLengths",
    "and_lengths": ", lengths",
    "row_length": ", lengths.of_row(cells, lines)",
    "object_length": ", lengths.of_object(found, lines)",
}
"""The pieces of the template for a clock that varies; with a fixed clock, all but the sample are empty."""

_NO_LIMITING: Final = Assign(states.LIMITING, Int(-1))

INDENT: Final = Printer.INDENT


def emit(fspa: Fspa, options: Options) -> Files:
    """Return the module ``NAME_monitor.py``, where NAME is the name of the automaton."""
    name = f"{fspa.name}_monitor.py"
    return {name: _Source(fspa, name).text()}


class _Source:
    """Makes the Python module of one monitor, by filling the template ``monitor.py.txt``."""

    def __init__(self, fspa: Fspa, file: str) -> None:
        self._fspa, self._file = fspa, file
        self._program = program(fspa, _RESERVED)
        self._names = (*self._program.signals, *self._program.params, *self._program.atoms)
        self._names += (*self._program.registers, *self._program.before)
        progress = [states.PROGRESS] if fspa.judge == "goal" else []
        failure = [states.FAILURE] if self._program.failures else []
        self._results = (states.TARGET, states.ROBUSTNESS, *progress, states.LIMITING, *failure)
        # Atoms that nothing needs are not computed. Functions of states do not get those that only registers read.
        read = variables_read(statement for case in self._program.cases for statement in case.statements)
        only_kept = self._program.variables_kept - read
        needed = zip(self._program.atoms, self._program.only_in, strict=True)
        self._computed = [name for name, only in needed if only != -1 and name not in only_kept]
        self._printer = PythonPrinter([atom.name for atom in fspa.atoms])

    def text(self) -> str:
        """Return the text of ``NAME_monitor.py``."""
        fspa, at_goal = self._fspa, self._fspa.judge == "goal"
        with recursion_room():
            step = PythonPrinter.block(self._step(), depth=2)
            body = "\n\n\n".join(map(self._function, range(len(self._program.cases))))
        pieces = {
            "title": docstring_text(f"Monitor of the specification `{fspa.name}`, written by tltlc."),
            "about": docstring_text("\n\n".join(filter(None, (fspa.doc, f"{INDENT}{fspa.formula}")))),
            "file": self._file,
            "step": step,
            "signals": long_tuple([signal_row(signal) for signal in fspa.signals]),
            "params": long_dict(
                [
                    f"{string_literal(param.name)}: "
                    f"({float_literal(param.value)}, {low_literal(param.low)}, {high_literal(param.high)})"
                    for param in fspa.params
                ]
            ),
            "atoms": long_tuple([string_literal(atom.name) for atom in fspa.atoms]),
            "exclusive": long_tuple([short_tuple([str(atom) for atom in group]) for group in fspa.exclusive]),
            "returns": ", the progress of the step" if at_goal else "",
            "and_limiting": ", the limiting atom, and an index into _FAILURES"
            if self._program.failures
            else " and the limiting atom",
            "failures": self._failures(),
            "states": f"\n\n{body}\n",
            "result": self._result,
            "transitions": long_tuple([f"_from_{number}" for number in range(len(self._program.cases))]),
            **self._states(self._program.tables),
        }
        if fspa.registers:
            pieces |= {
                "register_names": long_tuple([string_literal(register.name) for register in fspa.registers]),
                "register_starts": short_tuple([float_literal(register.initial) for register in fspa.registers]),
            }
        pieces["slots"] = '"registers", ' if fspa.registers else ""
        bools = [string_literal(signal.name) for signal in fspa.signals if signal.type == "bool"]
        pieces["slot_of_sparse"] = '"_sparse", ' if bools else ""
        pieces["false"] = long_dict([f"{name}: False" for name in bools])
        pieces["computed"] = "{_computed(index)}" if fspa.registers else "atom `{_ATOMS[index]}`"
        used = [_FUNCTIONS[function] for function in self._program.functions if function in _FUNCTIONS]
        fields: tuple[Signal | Param, ...] = (*fspa.signals, *fspa.params)
        # Where a bound is missing, `inf` is printed.
        used += ["inf"] if any(None in (field.low, field.high) for field in fields) else []
        used += ["inf"] if fspa.clock_varies else []
        pieces |= _STEP_LENGTHS if fspa.clock_varies else {**dict.fromkeys(_STEP_LENGTHS, ""), "sample": _SAMPLE}
        enums = self._enums()
        pieces["imports"] = "from enum import IntEnum\n" if enums else ""
        pieces["imports"] += f"from math import {', '.join(sorted({*used, 'isfinite'}))}"
        pieces["enums"], pieces["given"] = enums, "float | str" if enums else "float"
        if enums:
            pieces["value_names"] = long_dict(
                [
                    f"{string_literal(signal)}: {short_tuple([*map(string_literal, enum.values)])}"
                    for enum in enums_of(fspa)
                    for signal in enum.signals
                ]
            )
        present = [*snippets.common_blocks(self._program), *(["bools"] if bools else [])]
        return fill_template("monitor.py.txt", pieces, present)

    def _enums(self) -> str:
        """Return a class for each enum of the spec, each after two empty lines; an empty text if there are none."""
        types = (*keyword.kwlist, *dir(builtins), "IntEnum", *names_in("monitor.py.txt", r"\b([A-Za-z]\w*)"))
        lines: list[str] = []
        for enum in nested_enums(self._fspa, types, (), upper_case):
            lines += ["", "", f"class {enum.type}(IntEnum):", f'{INDENT}"""{docstring_text(enum.title)}"""', ""]
            lines += [f"{INDENT}{name} = {number}" for number, name in enumerate(enum.constants)]
        return "\n".join(lines)

    def _failures(self) -> str:
        """Return the table of what a step can fail at, which ends with the entry of a failure that has no cause."""
        rows = [
            short_tuple(["None" if text is None else string_literal(text) for text in row])
            for row in (*snippets.failure_texts(self._program), (None, None))
        ]
        return long_tuple(rows)

    def _states(self, tables: StateTables | None) -> dict[str, str]:
        """Return the pieces of the template with rows of states or, if there are tables, of kinds, and the tables."""
        if tables is None:
            rows = [
                f"({string_literal(str(state.label))}, {string_literal(label_text(self._fspa, state.id))}, "
                f"{self._verdict(state.id)})"
                for state in self._fspa.states
            ]
            return {"table": long_tuple(rows), "tables": "", "label_texts": "", "english_texts": ""}
        lines = [
            f"_{name.upper()}: list[{'float' if name == 'level_progress' else 'int'}] = "
            f"[{Printer.items([*map(repr, numbers)])}]"
            for name, numbers in tables.all_tables(self._fspa.judge).items()
        ]
        return {
            "table": long_tuple([f"({self._verdict(state)})" for state in tables.kind_states]),
            "tables": "\n".join(lines),
            "label_texts": label_texts(tables.labels),
            "english_texts": label_texts(tables.labels_english),
        }

    def _verdict(self, state: int) -> str:
        fspa_state, ends = self._fspa.states[state], self._program.ends[state]
        return f"{string_literal(fspa_state.verdict)}, {fspa_state.accepting}, {ends}"

    @property
    def _result(self) -> str:
        """The return type of the functions of states, as text."""
        progress = "float, " if states.PROGRESS in self._results else ""
        return f"tuple[int, float, {progress}str | None{', int' if self._program.failures else ''}]"

    def _function(self, number: int) -> str:
        """Return the source of the function of a case, which finds the edge to take, and returns its results.

        The results are the next state, the robustness, the progress if the spec is judged at its
        goal, the limiting atom, and the number of what the step fails at, -1 if it does not fail.
        """
        parameters = [] if self._program.tables is None else [f"{states.FIRST_EDGE}: int"]
        parameters += [f"{atom}: float" for atom in self._computed]
        lines = call_lines(f"def _from_{number}", parameters, f" -> {self._result}:")
        lines += self._printer.lines([CommentLine(self._program.cases[number].comment)], depth=1)
        body = split_deep_values(self._program.cases[number].statements, self._names)
        match body:
            case (If(cases, otherwise),):
                # Each case is an `if` of its own that returns: a long chain of `elif` would nest too deep for Python.
                for test, taken in cases:
                    lines.append(f"{INDENT}{self._printer.head(self._printer.text(test), first=True)}")
                    lines += self._edge_lines(taken, depth=2)
                body = otherwise
        return "\n".join([*lines, *self._edge_lines(body, depth=1)])

    def _edge_lines(self, body: Sequence[Statement], depth: int) -> list[str]:
        """Return the lines that run when an edge is taken; the last line returns the results.

        ``body`` has the statements that assign the results. A result with a single assignment is
        returned directly, without a variable, unless other statements read it.
        """
        once = {
            statement.name: statement
            for statement in body
            if isinstance(statement, Assign) and statement.name in self._results
        }
        if once.get(states.LIMITING, _NO_LIMITING) != _NO_LIMITING:
            del once[states.LIMITING]
        if states.TARGET in variables_read(body):
            once.pop(states.TARGET, None)
        rest = [statement for statement in body if statement not in once.values()]
        results = [self._printer.result(once[name]) if name in once else name for name in self._results]
        if self._program.failures:
            if states.FAILURE not in assigned_in(body):
                results[-1] = "-1"
            elif states.TARGET not in {line.name for line in body if isinstance(line, Assign)}:
                # The statements are those of several edges, and not all of them lead into a trap.
                rest.insert(0, Assign(states.FAILURE, Int(-1)))
        return [*self._printer.lines(rest, depth), f"{INDENT * depth}return {', '.join(results)}"]

    # --- the step function --------------------------------------------------------------------

    def _step(self) -> list[str]:
        parts = (self._read(), self._recall(), self._compute(), self._check(), self._move(), self._judge())
        return [line for part in parts for line in part]

    def _read(self) -> list[str]:
        """Return the code that reads ``dt`` and signals, as floats in their ranges, and params into variables."""
        params = f"({', '.join(self._program.params)},) = self._params"
        lines: list[str] = []
        if self._fspa.clock_varies:
            lines += [f"if type({DT}) is not float or not 0.0 <= {DT} < inf:", f"{INDENT}{DT} = self._length({DT})"]
        if not self._program.signals:
            return [*lines, params] if self._program.params else lines
        signals = [*zip(self._fspa.signals, self._program.signals, strict=True)]
        if any(signal.type == "bool" for signal in self._fspa.signals):
            lines += ["if self._sparse:", f"{INDENT}signals = {{**_FALSE, **signals}}"]
        lines += ["try:"]
        lines += [f"{INDENT}{variable} = signals[{string_literal(signal.name)}]" for signal, variable in signals]
        lines += ["except KeyError:", f"{INDENT}raise self._missing(signals) from None"]
        for index, (signal, variable) in enumerate(signals):
            checked = f"type({variable}) is not float or not {within(signal, variable)}:"
            if signal.type == "bool":
                lines += [f"if type({variable}) is bool:", f"{INDENT}{variable} = 1.0 if {variable} else 0.0"]
                lines.append(f"elif {checked}")
            else:
                lines.append(f"if {checked}")
            lines.append(f"{INDENT}{variable} = self._number({index}, {variable})")
        return [*lines, params] if self._program.params else lines

    def _recall(self) -> list[str]:
        """Return the code that reads the values of the registers before the sample."""
        names = self._program.before
        return call_lines("", tuple_items(names), " = self.registers") if names else []

    def _compute(self) -> list[str]:
        """Return the code that computes the registers, and all atoms that a step may need, clamped to [-1, 1].

        What every step needs comes first, then the atoms that a step from a single state needs.
        """
        program_ = self._program
        lines: list[str] = []
        later: list[str] = []
        cases = range(len(program_.cases))
        lazy = [Computation("atom", atom) for case in cases for atom in program_.computed_in(case)]
        for step in (*program_.every_step, *lazy):
            lines += self._register(step.index) if step.kind == "register" else self._value(step.index)
            name = program_.atoms[step.index] if step.kind == "atom" else ""
            if name and not program_.always_in_range[step.index]:
                check = [f"if not -1.0 <= {name} <= 1.0:", f"{INDENT}{name} = self._in_range({step.index}, {name})"]
                (lines if program_.registers else later).extend(check)
        if program_.functions & FAILING:
            lines = ["failing = 0", "try:", *(f"{INDENT}{line}" for line in lines)]
            # A MonitorError is a ValueError.
            lines += ["except MonitorError:", f"{INDENT}raise"] if program_.registers else []
            lines.append("except (ZeroDivisionError, OverflowError, ValueError) as error:")
            lines.append(f"{INDENT}raise self._failed(failing, error) from None")
        return [*lines, *later]

    def _value(self, index: int) -> list[str]:
        """Return the code that computes the value of an atom, given its index."""
        program_, statements = self._program, self._program.values[index]
        lines = self._printer.comment(program_.atom_comments[index])
        lines += [f"failing = {index}"] if functions_called(statements) & FAILING else []
        return [*lines, *self._printer.lines(with_declaration(program_.atoms[index], statements))]

    def _register(self, index: int) -> list[str]:
        """Return the code that computes the value of a register after the sample, given its index."""
        program_, statements, name = self._program, self._program.updates[index], self._program.registers[index]
        lines = self._printer.comment(program_.register_comments[index])
        lines += [f"failing = {len(program_.atoms) + index}"] if functions_called(statements) & FAILING else []
        lines += self._printer.lines(with_declaration(name, statements))
        if not program_.always_finite[index]:
            text = string_literal(f"the register `{self._fspa.registers[index].name}` is too large to compute")
            lines += [f"if not isfinite({name}):", f"{INDENT}raise self._error({text})"]
        return lines

    def _check(self) -> list[str]:
        """Return the code that ends a step with an error if two atoms of an ``exclusive`` group hold together."""
        lines: list[str] = []
        for index, group in self._program.exclusive:
            atoms = [self._program.atoms[atom] for atom in group]
            lines += [f"if {two_hold(atoms)}:", f"{INDENT}raise self._together({index}, {short_tuple(atoms)})"]
        return lines

    def _move(self) -> list[str]:
        """Return the code that finds the next state: a call of the function of the current state or its shape."""
        results = ", ".join(self._results)
        if self._program.tables is None:
            return call_lines(f"{results} = _TRANSITIONS[self.state]", self._computed)
        arguments = ["_FIRST_EDGES[self.state]", *self._computed]
        return call_lines(f"{results} = _TRANSITIONS[_STATE_SHAPES[self.state]]", arguments)

    def _judge(self) -> list[str]:
        """Return the code that computes reward and best progress, and whether the episode ends."""
        used = variables_read(self._program.reward_statements)
        definitions = {
            reward_step.VIOLATED: 'verdict == "violated"',
            reward_step.SATISFIED: 'verdict == "satisfied"',
        }
        return [
            f"label, label_english, verdict, accepting, {reward_step.ENDS} = _STATES[{states.TARGET}]",
            f"{reward_step.STEPS} = self.steps + 1",
            *(f"{name} = {value}" for name, value in definitions.items() if name in used),
            f"{reward_step.BEST} = self.progress",
            f"{reward_step.DONE} = self.done",
            *self._printer.lines(self._program.reward_statements),
            f"self.state = {states.TARGET}",
            f"self.steps = {reward_step.STEPS}",
            f"self.progress = {reward_step.BEST}",
            f"self.done = {reward_step.DONE}",
            *self._remember(),
            *self._fail(),
            "# Adding 0 turns -0 into 0.",
            "values = (target, label, verdict, accepting, done, best, reward, robustness + 0.0, limiting)",
            "return tuple.__new__(Step, (*values, label_english, *self.failure))",
        ]

    def _fail(self) -> list[str]:
        """Return the code that keeps what the trace fails at, at the first step at which it does."""
        if all(state.verdict != "violated" for state in self._fspa.states):
            return []
        number = states.FAILURE if self._program.failures else "-1"
        return [
            'if verdict == "violated" and self.failure[2] is None:',
            f"{INDENT}self.failure = (*_FAILURES[{number}], {reward_step.STEPS})",
        ]

    def _remember(self) -> list[str]:
        """Return the code that keeps the values of the registers for the next sample."""
        values = [self._printer.text(value, CHOICE) for value in self._program.kept]
        return call_lines("self.registers = ", tuple_items(values)) if values else []
