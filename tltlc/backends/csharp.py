"""A stand-alone monitor in C# 6, the version Unity accepts, its program, and a Unity component.

A step allocates nothing. Public names are in Pascal case, and a file has the name of its type, as Unity
requires of components.

It gives the same results to the last bit as :class:`tltlc.monitor.Monitor` with its default reward,
if the runtime's ``Math.Pow``, ``Math.Exp`` and ``Math.Tanh`` are those that Python was built with,
as Mono's are on Linux.
"""

from __future__ import annotations

from collections.abc import Sequence

from tltlc.automaton.finite.blowup import recursion_room
from tltlc.automaton.fspa import Fspa
from tltlc.automaton.text import label_text
from tltlc.backends import Files, Options, Target
from tltlc.backends.languages.csharp_syntax import KEYWORDS, CSharpPrinter, string_literal, summary_comment, table_name
from tltlc.backends.templates import fill_template, names_in
from tltlc.monitor.samples import range_text
from tltlc.program import reward_step, snippets, states
from tltlc.program.arithmetic import with_declaration
from tltlc.program.build import program
from tltlc.program.enums import nested_enums, pascal_case
from tltlc.program.label_texts import LabelTexts
from tltlc.program.names import VariableNames
from tltlc.program.printer import CHOICE, Printer
from tltlc.program.shapes import StateTables
from tltlc.program.step_code import StepCode
from tltlc.program.tree import FAILING, Statement
from tltlc.program.used_names import functions_called, variables_read
from tltlc.resolve.spec import Param, Signal

TARGET = Target(
    "csharp",
    "a stand-alone monitor in C#, also for Unity",
    ("Monitor.cs", "MonitorProgram.cs", "MonitorBehaviour.cs"),
    ("c#", "cs", "unity"),
    pascal_case,
)

_INDENT = Printer.INDENT
_TEMPLATE = """
    Array AtomNames Defaults Divide Equals Exp Finalize GetHashCode GetType IsFinite Keep List Math Max
    MemberwiseClone MethodImpl MethodImplOptions Min Missing Note Params Place Power Problem Read ReferenceEquals
    Refuse Result Signals Sqrt States Step System Tltl ToString Verdict Without entered none number own result
    sample EdgeTargets FirstEdges LevelProgress StateLevels StateShapes
""".split()
"""Names in the template that no variable of a step may have, because it would hide them."""

_OBJECT_MEMBERS = ("Equals", "Finalize", "GetHashCode", "GetType", "MemberwiseClone", "ReferenceEquals", "ToString")


def emit(fspa: Fspa, options: Options) -> Files:
    """Return the files of the monitor of an automaton whose name in Pascal case is NAME.

    ``NAMEMonitor.cs`` is the monitor, ``NAMEMonitorProgram.cs`` runs it as a program, and
    ``NAMEMonitorBehaviour.cs`` is a component for Unity.
    """
    monitor, program_, behaviour = TARGET.file_names(fspa.name)
    source = _Source(fspa)
    varies = fspa.clock_varies
    places = {
        "p": fspa.name,
        "type": _type_name(fspa),
        "dt_parameter": "double dt" if varies else "",
        "elapsed": ", elapsed" if varies else "",
        "fixed_dt": "Time.fixedDeltaTime" if varies else "",
    }
    component = fill_template("behaviour.cs.txt", places, ["varies"] if varies else [])
    return {monitor: source.text(), program_: source.program_text(), behaviour: component}


class _Source(StepCode):
    """Makes the C# code of one monitor and its program, by filling two templates."""

    def __init__(self, fspa: Fspa) -> None:
        super().__init__(program(fspa, [*KEYWORDS, *_TEMPLATE], has_bools=True))
        self._type = _type_name(fspa)
        self._signal_fields = _field_names([signal.name for signal in fspa.signals], "Signals", "Missing", "Sparse")
        self._param_fields = _field_names([param.name for param in fspa.params], "Params", "Defaults")
        self._printer = CSharpPrinter()

    def text(self) -> str:
        """Return the text of the monitor's file."""
        fspa, program_ = self._fspa, self._program
        signals = list(zip(fspa.signals, self._signal_fields, strict=True))
        params = list(zip(fspa.params, self._param_fields, strict=True))
        present: list[str] = [
            *snippets.common_blocks(program_),
            *program_.functions,
            *functions_called(statement for case in program_.cases for statement in case.statements),
        ]
        present += ["note"] if program_.functions & FAILING else []
        present += ["fails"] if any(state.verdict == "violated" for state in fspa.states) else []
        present += [] if all(program_.always_in_range) else ["keep"]
        present += ["inlined"] if {"divide", "min", "max"} & {*present} else []
        with recursion_room():
            step = CSharpPrinter.block(self._step(), 3)
        places = {
            "type": self._type,
            "title": snippets.title_comment(fspa, self._printer.comment),
            "dt": ", dt" if fspa.clock_varies else "",
            "dt_parameter": ", double dt" if fspa.clock_varies else "",
            "enums": CSharpPrinter.block(self._enums(), 2),
            "signal_fields": _fields([(name, _type(signal), signal) for signal, name in signals]),
            "param_fields": _fields([(name, "double", param) for param, name in params]),
            "signal_names": _strings([signal.name for signal in fspa.signals]),
            "atom_names": _strings([atom.name for atom in fspa.atoms]),
            "register_names": _strings([register.name for register in fspa.registers]),
            "register_starts": _list([snippets.number_literal(register.initial) for register in fspa.registers]),
            # The beginning of a message about an atom, or perhaps a register.
            "at_fault": 'Computed() + "' if fspa.registers else '"the atom `" + AtomNames[_which] + "`',
            "largest_group": str(max(map(len, fspa.exclusive), default=0)),
            "groups": _list([f"new[] {{{', '.join(map(str, group))}}}" for group in fspa.exclusive]),
            "missing_numbers": CSharpPrinter.block(
                [f"none.{name} = double.NaN;" for signal, name in signals if signal.type != "bool"], 5
            ),
            "false_bools": CSharpPrinter.block(
                [f"none.{name} = false;" for signal, name in signals if signal.type == "bool"], 5
            ),
            "param_defaults": CSharpPrinter.block(
                [f"own.{name} = {snippets.number_literal(param.value)};" for param, name in params], 5
            ),
            "param_checks": CSharpPrinter.block(
                [line for param, name in params for line in _param_check(param, name)], 3
            ),
            **self._failures(),
            "states": CSharpPrinter.block(self._states(), 3),
            **self._state_tables(program_.tables),
            "step": step,
        }
        return fill_template("monitor.cs.txt", places, present)

    def program_text(self) -> str:
        """Return the text of the program's file."""
        places = {
            "type": self._type,
            "row_dt": ", times.Next(trace)" if self._fspa.clock_varies else "",
            "give": CSharpPrinter.block(self._give(), 3),
            "value_names": _list([f"new string[] {{{_strings(signal.values)}}}" for signal in self._fspa.signals]),
        }
        return fill_template("monitor_program.cs.txt", places, snippets.common_blocks(self._program))

    def _enums(self) -> list[str]:
        """Return the lines of a static class with constants for each enum of the spec, each before an empty line."""
        program_ = self._program
        variables = (*program_.signals, *program_.params, *program_.atoms, *program_.registers, *program_.before)
        files = ("monitor.cs.txt", "monitor_program.cs.txt")
        names = {name for file in files for name in names_in(file, r"\b([A-Za-z]\w*)")}
        types = (*KEYWORDS, *_TEMPLATE, *names, *variables, self._type)
        lines: list[str] = []
        for enum in nested_enums(self._fspa, types, _OBJECT_MEMBERS, pascal_case):
            constants: list[str] = []
            for number, (name, value) in enumerate(zip(enum.constants, enum.enum.values, strict=True)):
                constants += ["", *summary_comment(f"{value}."), f"public const double {name} = {number}.0;"]
            lines += [*summary_comment(enum.title), f"public static class {enum.type}", "{"]
            lines += [*CSharpPrinter.block(constants[1:], 1).split("\n"), "}", ""]
        return lines

    def _failures(self) -> dict[str, str]:
        """Return the pieces of the template about what a step can fail at."""
        clauses, atoms = zip(*snippets.failure_texts(self._program), (None, None), strict=True)
        return {
            "failed_clauses": _list(["null" if text is None else string_literal(text) for text in clauses]),
            "failed_atoms": _list(["null" if text is None else string_literal(text) for text in atoms]),
            "failure": states.FAILURE if self._program.failures else "0",
        }

    def _states(self) -> list[str]:
        """Return a row for each state or, if there are tables, for each kind of states."""
        lines: list[str] = []
        for index in self._program.state_rows:
            state = self._fspa.states[index]
            values = (
                f"Verdict.{state.verdict.capitalize()}",
                snippets.boolean_literal(state.accepting),
                snippets.boolean_literal(self._program.ends[index]),
            )
            lines.append(f"new Place({', '.join(values)}),")
        return lines

    def _state_tables(self, tables: StateTables | None) -> dict[str, str]:
        """Return the pieces of the template with the tables of states or, if there are none, with their labels."""
        if tables is None:
            return {
                "labels": _strings([str(state.label) for state in self._fspa.states]),
                "english_labels": _strings([label_text(self._fspa, state.id) for state in self._fspa.states]),
            }
        lines: list[str] = []
        read_in_steps = tables.step_tables(self._fspa.judge)
        for name, numbers in tables.all_tables(self._fspa.judge).items():
            is_short = name in read_in_steps and max(numbers, default=0) < 1 << 16
            type_ = "double" if name == "level_progress" else "ushort" if is_short else "int"
            items = _list([*map(repr, numbers)])
            lines.append(f"{_INDENT * 2}private static readonly {type_}[] {table_name(name)} = {{{items}}};")
        return {
            "tables": "\n".join(lines),
            "label_texts": _label_texts(tables.labels),
            "english_texts": _label_texts(tables.labels_english),
        }

    def _give(self) -> list[str]:
        """Return the body of a generated function that sets one signal, given its index: a case for each signal."""
        if not self._fspa.signals:
            return []
        lines = ["switch (signal)", "{"]
        for index, (signal, name) in enumerate(zip(self._fspa.signals, self._signal_fields, strict=True)):
            lines.append(f"{_INDENT}case {index}:")
            value = "number"
            if signal.type == "bool":
                lines.append(f"{_INDENT * 2}if (number != 0.0 && number != 1.0) return false;")
                value = "number == 1.0"
            lines += [f"{_INDENT * 2}sample.{name} = {value};", f"{_INDENT * 2}break;"]
        return [*lines, "}"]

    # --- a step -----------------------------------------------------------------------------------

    def _read(self) -> list[str]:
        used = self._program.variables_used
        lines: list[str] = []
        signals = zip(self._fspa.signals, self._program.signals, self._signal_fields, strict=True)
        for index, (signal, name, field) in enumerate(signals):
            if signal.type == "bool":
                lines.append(f"if (!sample.{field}.HasValue) return Refuse(Problem.NotSet, {index}, out result);")
                continue
            low, high = (
                snippets.number_literal(signal.low, "double.NegativeInfinity"),
                snippets.number_literal(signal.high, "double.PositiveInfinity"),
            )
            # If a bound is missing, compare with infinity by `<` or `>`, so that infinite values fail the test.
            above, below = ">" if signal.low is None else ">=", "<" if signal.high is None else "<="
            # An enum that is null is missing: in `new Signals()`, 0 would be its first value.
            given = f"sample.{field}.GetValueOrDefault(double.NaN)" if signal.values else f"sample.{field}"
            lines.append(f"double {name} = {given};")
            lines += _check_lines(
                f"{name} {above} {low} && {name} {below} {high}", f"{name} = Read({index}, {name}, {low}, {high});"
            )
        lines += self._bools(None)
        params = zip(self._program.params, self._param_fields, strict=True)
        lines += [f"double {name} = _params.{field};" for name, field in params if name in used]
        for index, name in enumerate(self._program.before):
            if name in used:
                is_bool = name in self._program.booleans
                lines.append(
                    f"bool {name} = _registers[{index}] > 0.0;" if is_bool else f"double {name} = _registers[{index}];"
                )
        return lines

    def _bools(self, case: int | None) -> list[str]:
        """Return the code that converts bool signals to the numbers 0 and 1.

        It converts the signals that only this case reads or, if ``case`` is None, those that every
        step reads.
        """
        fields = dict(zip(self._program.signals, self._signal_fields, strict=True))
        return [
            f"bool {name} = sample.{fields[name]}.GetValueOrDefault();"
            if name in self._program.booleans
            else f"double {name} = sample.{fields[name]}.GetValueOrDefault() ? 1.0 : 0.0;"
            for name in self._program.bools_read_in(case)
        ]

    def _value(self, index: int) -> list[str]:
        program_, statements = self._program, self._program.values[index]
        lines = self._printer.comment(program_.atom_comments[index])
        lines += self._printer.lines(with_declaration(program_.atoms[index], statements))
        return [*lines, *self._problem(statements, index)]

    def _range_check(self, index: int) -> list[str]:
        name = self._program.atoms[index]
        return _check_lines(f"{name} >= -1.0 && {name} <= 1.0", f"{name} = Keep({index}, {name});")

    def _register(self, index: int) -> list[str]:
        program_, statements, name = self._program, self._program.updates[index], self._program.registers[index]
        place = len(program_.atoms) + index
        lines = self._printer.comment(program_.register_comments[index])
        lines += self._printer.lines(with_declaration(name, statements, changes=False))
        lines += self._problem(statements, place)
        if not program_.always_finite[index]:
            lines.append(f"if (!IsFinite({name})) return Refuse(Problem.TooLarge, {place}, out result);")
        return lines

    def _problem(self, statements: Sequence[Statement], place: int) -> list[str]:
        """Return the code that ends a step if one of the statements found a problem; ``place`` is that of its value."""
        fails = functions_called(statements) & FAILING
        return [f"if (_problem != Problem.None) return Refuse(_problem, {place}, out result);"] if fails else []

    def _check(self) -> list[str]:
        lines: list[str] = []
        for index, group in self._program.exclusive:
            names = [self._program.atoms[atom] for atom in group]
            lines += [f"if ({' + '.join(f'({name} > 0.0 ? 1 : 0)' for name in names)} > 1)", "{"]
            lines += [f"{_INDENT}_holding[{number}] = {name} > 0.0;" for number, name in enumerate(names)]
            lines += [f"{_INDENT}return Refuse(Problem.Together, {index}, out result);", "}"]
        return lines

    def _move(self) -> list[str]:
        lines = [f"int {states.TARGET} = _state;", f"int {states.LIMITING} = -1;"]
        lines.append(f"double {states.ROBUSTNESS} = 0.0;")
        lines += [f"double {states.PROGRESS} = 0.0;"] if self._fspa.judge == "goal" else []
        lines += [f"int {states.FAILURE} = -1;"] if self._program.failures else []
        has_tables = self._program.tables is not None
        lines += [f"int {states.FIRST_EDGE} = FirstEdges[_state];"] if has_tables else []
        lines += ["switch (StateShapes[_state])" if has_tables else "switch (_state)", "{"]
        for number, case in enumerate(self._program.cases):
            # A case that contains declarations needs braces.
            lines += [f"{_INDENT}{line}" for line in self._printer.comment(case.comment)]
            lines += [f"{_INDENT}case {number}:", f"{_INDENT}{{"]
            lines += [f"{_INDENT * 2}{line}" for line in (*self._bools(number), *self._values(number))]
            lines += self._printer.lines(case.statements, depth=2)
            lines += [f"{_INDENT * 2}break;", f"{_INDENT}}}"]
        return [*lines, "}"]

    def _judge(self) -> list[str]:
        used = variables_read(self._program.reward_statements)
        verdict = "entered.Verdict"
        lines = [f"Place entered = States[{states.TARGET}];"]
        lines += [
            f"double {reward_step.BEST} = _progress;",
            f"bool {reward_step.DONE} = _done;",
            f"double {reward_step.REWARD};",
        ]
        declarations = {
            reward_step.STEPS_REAL: f"double {reward_step.STEPS_REAL} = {reward_step.STEPS};",
            reward_step.ENDS: f"bool {reward_step.ENDS} = entered.Ends;",
            reward_step.VIOLATED: f"bool {reward_step.VIOLATED} = {verdict} == Verdict.Violated;",
            reward_step.SATISFIED: f"bool {reward_step.SATISFIED} = {verdict} == Verdict.Satisfied;",
        }
        lines += [line for name, line in declarations.items() if name in used]
        return [*lines, *self._printer.lines(self._program.reward_statements)]

    def _remember(self) -> list[str]:
        texts = (self._printer.text(value, CHOICE) for value in self._program.kept)
        return [f"_registers[{index}] = {text};" for index, text in enumerate(texts)]


# --- pieces ---------------------------------------------------------------------------------------


def _type_name(fspa: Fspa) -> str:
    """Return the name of the monitor's class, which is also the name of its file without the ending."""
    return TARGET.file_names(fspa.name)[0].removesuffix(".cs")


def _field_names(names: Sequence[str], struct: str, *properties: str) -> list[str]:
    """Return the names of the fields of a struct, in Pascal case.

    ``names`` are their names in the spec, ``struct`` is the name of the struct, and ``properties`` those of its
    properties.
    """
    field_names = VariableNames((struct, *properties, *_OBJECT_MEMBERS))
    return [field_names.new_name(name, spell=pascal_case) for name in names]


def _check_lines(test: str, otherwise: str) -> list[str]:
    """Return the code that runs ``otherwise`` if a test fails, and then ends the step if that found a problem."""
    return [
        f"if (!({test}))",
        "{",
        f"{_INDENT}{otherwise}",
        f"{_INDENT}if (_problem != Problem.None) return Refuse(out result);",
        "}",
    ]


def _type(signal: Signal) -> str:
    return "bool?" if signal.type == "bool" else "double?" if signal.values else "double"


def _fields(fields: Sequence[tuple[str, str, Signal | Param]]) -> str:
    """Return the fields of a class, each with its documentation."""
    lines: list[str] = []
    for name, type_, declared in fields:
        lines += [*summary_comment(snippets.field_comment(name, declared)), f"public {type_} {name};", ""]
    # An empty line follows every field, also the last one.
    return CSharpPrinter.block(lines, 3)


def _param_check(param: Param, name: str) -> list[str]:
    tests = [f"IsFinite(given.{name})", *snippets.range_tests(f"given.{name}", param)]
    parts = [f"the param `{param.name}` cannot be ", f": its range is {range_text(param.low, param.high)}"]
    message = f" + Shown(given.{name}) + ".join(map(string_literal, parts))
    return [f"if (!({' && '.join(tests)}))", "{", f"{_INDENT}throw new ArgumentException({message});", "}"]


def _label_texts(labels: LabelTexts) -> str:
    return _list([f"new[] {{{', '.join(map(string_literal, pieces))}}}" for pieces in labels.texts])


def _strings(texts: Sequence[str]) -> str:
    """Return the text of an array initializer of strings."""
    return _list([*map(string_literal, texts)])


def _list(items: Sequence[str]) -> str:
    """Return the text of the items of an array initializer."""
    return CSharpPrinter.items(items, depth=2)
