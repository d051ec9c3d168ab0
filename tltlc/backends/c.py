"""A stand-alone monitor in C99 that is also valid C++17: one header, standard library only, no allocation.

It gives the same results to the last bit as :class:`tltlc.monitor.Monitor` with its default reward,
if the C library's ``pow``, ``exp`` and ``tanh`` are those that Python was built with. If an atom
cannot be computed for two reasons, such as two divisions by 0, the message may name either one: C
does not specify the order in which operands are evaluated.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final

from tltlc.automaton.finite.blowup import recursion_room
from tltlc.automaton.fspa import Fspa
from tltlc.automaton.text import label_text
from tltlc.backends import Files, Options, Target
from tltlc.backends.languages.c_names import RESERVED
from tltlc.backends.languages.c_printer import CPrinter
from tltlc.backends.languages.c_step import StepCode, refusal
from tltlc.backends.languages.c_tables import Labels, levels_text, shared_labels, tables_text
from tltlc.backends.languages.c_text import bytes_of, string_literal
from tltlc.backends.languages.c_verdict_step import verdict_pieces
from tltlc.backends.templates import fill_template, names_in
from tltlc.monitor.samples import range_text
from tltlc.program import reward_step, snippets, states
from tltlc.program.build import program
from tltlc.program.enums import flat_enums
from tltlc.program.shapes import StateTables
from tltlc.program.tree import FAILING, Choice, Compare, ProgramExpression, ProgramVariable, Real, Type
from tltlc.program.used_names import variables_read
from tltlc.resolve.spec import Param, Signal

TARGET = Target(
    "c", "a stand-alone monitor in C and C++, also for Unreal", ("_monitor.h",), ("c++", "cpp", "h", "unreal")
)

_INDENT = CPrinter.INDENT

_RESERVED: Final = (
    *(*RESERVED, "monitor", "sample", "result", "states", "failures", "none"),
    *("state_kinds", "state_shapes", "first_edges", *CPrinter.TABLES),
)
"""Names that no variable may have: reserved names of C, and the names that the template uses.

:mod:`tltlc.program.build` adds the variables of the step function.
"""


def emit(fspa: Fspa, options: Options) -> Files:
    """Return the C header ``NAME_monitor.h``, where NAME is the name of the automaton."""
    name = f"{fspa.name}{TARGET.endings[0]}"
    return {name: _Source(fspa, name).text()}


class _Source:
    """Makes the C header of one monitor, by filling the template ``monitor.h.txt``."""

    def __init__(self, fspa: Fspa, file: str) -> None:
        self._fspa, self._file, self._prefix = fspa, file, fspa.name
        self._enums = flat_enums(fspa, names_in("monitor.h.txt", r"@@p@@_(\w+)"))
        constants = [f"{fspa.name}_{name}" for enum in self._enums for name in enum.constants]
        self._program = program(fspa, (*_RESERVED, *constants, *(("signs",) if fspa.registers else ())), has_bools=True)
        self._entered = states.TARGET if self._program.tables is None else f"state_kinds[{states.TARGET}]"
        self._printer = CPrinter(fspa.name, fspa.atoms)
        self._code = StepCode(self._program, self._printer)

    def text(self) -> str:
        """Return the text of the header file."""
        fspa, program_ = self._fspa, self._program
        signals = list(zip(fspa.signals, program_.signals, strict=True))
        params = list(zip(fspa.params, program_.params, strict=True))
        failing = program_.functions & FAILING
        present = [*failing, *(["note"] if failing else []), *([] if all(program_.always_in_range) else ["atom"])]
        present += ["number"] if any(signal.type != "bool" for signal in fspa.signals) else []
        present += ["bool" if any(signal.type == "bool" for signal in fspa.signals) else "no_bool"]
        present += ["failures" if program_.failures else "no_failures"]
        present += ["exclusive"] if program_.exclusive else []
        present += ["params"] if fspa.params else []
        present += ["states"] if program_.tables is None else ["tables"]
        present += ["registers"] if fspa.registers else []
        present += ["varies"] if fspa.clock_varies else []
        present += [snippets.enum_block(fspa)]
        with recursion_room():
            exclusive = [(number, {atom: self._holds(atom) for atom in group}) for number, group in program_.exclusive]
            steps = self._code.compute(), self._code.check(exclusive), self._move(), self._judge()
            verdict = verdict_pieces(program_, self._printer)
            # With registers, what a step recalls stands between what it reads and the rest.
            read, before = (self._read(), []) if fspa.registers else ([], self._read())
            step = CPrinter.block(snippets.paragraphs(before, *steps))
        labels, english = self._labels(program_.tables)
        places = {
            "p": self._prefix,
            "title": snippets.title_comment(fspa, self._printer.comment),
            "dt": ", dt" if fspa.clock_varies else "",
            "dt_parameter": ", double dt" if fspa.clock_varies else "",
            "row_dt": ", row->dt" if fspa.clock_varies else "",
            "file": self._file,
            "signal_count": str(len(signals)),
            "atom_count": str(len(fspa.atoms)),
            "register_count": str(len(fspa.registers)),
            "text_size": str(self._text_size()),
            "enums": "\n".join(self._enum_lines()),
            "signal_room": str(max(1, len(signals))),
            "atom_room": str(max(1, len(fspa.atoms))),
            "notice_room": str(max(1, len(signals) + len(fspa.atoms))),
            "signal_fields": self._fields([(name, self._type(signal), signal) for signal, name in signals]),
            "param_fields": self._fields([(name, "double", param) for param, name in params]),
            "signal_names": _list([string_literal(signal.name) for signal in fspa.signals], '""'),
            "atom_names": _list([string_literal(atom.name) for atom in fspa.atoms], '""'),
            "register_names": _list([string_literal(register.name) for register in fspa.registers], '""'),
            "register_starts": _list([snippets.number_literal(register.initial) for register in fspa.registers], "0.0"),
            "label_macros": labels.macros,
            "labels": labels.items,
            "label_ends": labels.ends,
            "english_macros": english.macros,
            "english_labels": english.items,
            "english_ends": english.ends,
            "sparse_defaults": CPrinter.block(
                [f"sample.{name} = {'false' if signal.type == 'bool' else 'HUGE_VAL'};" for signal, name in signals]
                or ["sample.none = false;"]
            ),
            "missing_bools": CPrinter.block(
                [f"sample.{name} = -1;" for signal, name in signals if signal.type == "bool"]
            ),
            "failures": "\n".join(self._failures()),
            "failed_step": str(int(fspa.states[0].verdict == "violated")),
            "param_defaults": CPrinter.block(
                [f"params.{name} = {snippets.number_literal(param.value)};" for param, name in params]
                or ["params.none = false;"]
            ),
            "param_checks": CPrinter.block([line for index in range(len(params)) for line in self._param_check(index)]),
            "param_names": _list([string_literal(param.name) for param in fspa.params], '""'),
            "param_ranges": _list([string_literal(range_text(param.low, param.high)) for param in fspa.params], '""'),
            "members": _list(
                [f"{{{group}, {atom}}}" for group, atoms in enumerate(fspa.exclusive) for atom in atoms], "{0, 0}"
            ),
            "states": "\n".join(self._states()),
            "entered": self._entered,
            "tables": "" if program_.tables is None else tables_text(program_.tables),
            "levels": "" if program_.tables is None else levels_text(program_.tables, fspa.judge),
            "numbers": CPrinter.block(self._code.numbers()),
            "read": CPrinter.block(read),
            "recall": CPrinter.block(self._recall()),
            "step": step,
            "remember": CPrinter.block(self._remember()),
            **self._memory(),
            **verdict,
            **self._value_names(),
            "give": CPrinter.block(self._give()),
        }
        return fill_template("monitor.h.txt", places, present)

    def _text_size(self) -> int:
        """Return the size in bytes of a buffer that is large enough for every message.

        The longest message is about an exclusive group, and names the atoms of the group twice.
        """
        atoms = sum(2 * len(bytes_of(atom.name)) + 12 for atom in self._fspa.atoms)
        signals = max((len(bytes_of(signal.name)) for signal in self._fspa.signals), default=0)
        params = max((len(bytes_of(param.name)) for param in self._fspa.params), default=0)
        registers = max((len(bytes_of(register.name)) for register in self._fspa.registers), default=0)
        return 200 + max(atoms, signals, params, registers)

    def _enum_lines(self) -> list[str]:
        """Return the lines of an ``enum`` for each enum of the spec, each after an empty line."""
        lines: list[str] = []
        for enum in self._enums:
            rows = [f"{_INDENT}{self._prefix}_{name} = {number}" for number, name in enumerate(enum.constants)]
            lines += ["", *self._printer.comment(enum.title), "enum {", ",\n".join(rows), "};"]
        return lines

    # --- records ----------------------------------------------------------------------------------

    def _type(self, signal: Signal) -> str:
        return f"{self._prefix}_bool_" if signal.type == "bool" else "double"

    def _fields(self, fields: Sequence[tuple[str, str, Signal | Param]]) -> str:
        """Return the fields of a struct, each with its comment.

        A struct without fields gets an unused one.
        """
        lines: list[str] = []
        for name, type_, declared in fields:
            comments = self._printer.comment(snippets.field_comment(name, declared))
            field = f"{type_} {name};"
            # A short comment goes on the line of its field.
            if len(comments) == 1 and len(field) + len(comments[0]) < 100:
                lines.append(f"{field}    {comments[0]}")
            else:
                lines += [*comments, field]
        return CPrinter.block(lines or ["bool none;"])

    def _param_check(self, index: int) -> list[str]:
        param, name = self._fspa.params[index], f"params->{self._program.params[index]}"
        tests = [f"isfinite({name})"]
        tests += [] if param.low is None else [f"{name} >= {snippets.number_literal(param.low)}"]
        tests += [] if param.high is None else [f"{name} <= {snippets.number_literal(param.high)}"]
        lines = refusal(self._prefix, f"{self._prefix}_wrong_param", index)
        # The message shows the value.
        lines.insert(0, f"{_INDENT}monitor->wrong = {name};")
        return [f"if (!({' && '.join(tests)})) {{", *lines, "}"]

    def _states(self) -> list[str]:
        """Return a row for each state or, if there are tables, for each kind of states."""
        tables = self._program.tables
        lines: list[str] = []
        for index in range(len(self._fspa.states)) if tables is None else tables.kind_states:
            state = self._fspa.states[index]
            values = (
                f"{self._prefix}_{state.verdict}",
                snippets.boolean_literal(state.accepting),
                snippets.boolean_literal(self._program.ends[index]),
            )
            lines.append(f"{_INDENT * 2}{{{', '.join(values)}}},")
        return lines

    def _labels(self, tables: StateTables | None) -> tuple[Labels, Labels]:
        """Return the labels of the states as formulas, and in words."""
        if tables is not None:
            return (
                shared_labels(tables.labels, f"{self._prefix}_label_"),
                shared_labels(tables.labels_english, f"{self._prefix}_english_"),
            )
        states_ = self._fspa.states
        return (
            Labels(_list([string_literal(str(state.label)) for state in states_], '""')),
            Labels(_list([string_literal(label_text(self._fspa, state.id)) for state in states_], '""')),
        )

    def _failures(self) -> list[str]:
        """Return a row for each pair of a clause and an atom that a step can fail at."""
        return [
            f"{_INDENT * 2}{{{', '.join('NULL' if text is None else string_literal(text) for text in texts)}}},"
            for texts in snippets.failure_texts(self._program)
        ]

    def _value_names(self) -> dict[str, str]:
        """Return the names of the values of enums, each list ended by NULL, and where the list of each signal starts.

        The first list is empty, for signals that are no enums.
        """
        names, starts = ["NULL"], dict.fromkeys((signal.name for signal in self._fspa.signals), 0)
        for enum in self._enums:
            starts |= dict.fromkeys(enum.enum.signals, len(names))
            names += [*map(string_literal, enum.enum.values), "NULL"]
        return {"value_names": _list(names, ""), "value_starts": _list([*map(str, starts.values())], "0")}

    def _give(self) -> list[str]:
        """Return the body of a generated function that sets one signal, given its index: a case for each signal."""
        if not self._fspa.signals:
            return ["(void)sample, (void)signal, (void)value;"]
        lines = ["switch (signal) {"]
        for index, (signal, name) in enumerate(zip(self._fspa.signals, self._program.signals, strict=True)):
            lines.append(f"{_INDENT}case {index}:")
            if signal.type == "bool":
                lines.append(f"{_INDENT * 2}sample->{name} = value != 0.0;")
                lines.append(f"{_INDENT * 2}return value == 0.0 || value == 1.0;")
            else:
                lines += [f"{_INDENT * 2}sample->{name} = value;", f"{_INDENT * 2}break;"]
        return [*lines, "}"]

    # --- the step function ------------------------------------------------------------------------

    def _read(self) -> list[str]:
        """Return the code that reads bool signals and params into local variables."""
        program_ = self._program
        unread = [] if self._fspa.signals else ["(void)sample;"]
        return [*self._bools(None), *unread, *self._code.params(program_.variables_used)]

    def _holds(self, atom: int) -> ProgramExpression:
        return Compare(">", ProgramVariable(self._program.atoms[atom]), Real(0.0))

    def _remembered(self) -> list[tuple[int, str, Type]]:
        """Return the registers that a step reads: the number of each, its variable before the sample, and its type."""
        used, booleans = self._program.variables_used, self._program.booleans
        before = enumerate(self._program.before)
        return [(index, name, "bool" if name in booleans else "real") for index, name in before if name in used]

    def _recall(self) -> list[str]:
        """Return the code that reads the values of the registers before the sample."""
        return [
            f"const {CPrinter.TYPES[type_]} {name} = monitor->registers[{index}]{' > 0.0' if type_ == 'bool' else ''};"
            for index, name, type_ in self._remembered()
        ]

    def _memory(self) -> dict[str, str]:
        """Return the code for monitors that keep nothing but what a step reads: its fields, and how they are used."""
        remembered, registers = self._remembered(), self._fspa.registers
        starts = {
            index: snippets.boolean_literal(registers[index].initial > 0.0)
            if type_ == "bool"
            else snippets.number_literal(registers[index].initial)
            for index, _, type_ in remembered
        }
        names, kept = self._program.registers, {index for index, _, _ in remembered}
        keep = [f"monitor->memory.{name} = {names[index]};" for index, name, _ in remembered]
        # Nothing reads such a register but the game.
        used = self._program.variables_used
        keep += [f"(void){name};" for index, name in enumerate(names) if index not in kept and name not in used]
        return {
            "memory_fields": CPrinter.block(
                [self._printer.field(type_, name) for _, name, type_ in remembered] or ["bool none;"], 2
            ),
            "memory_starts": CPrinter.block(
                [f"monitor->memory.{name} = {starts[index]};" for index, name, _ in remembered]
            ),
            "memory_recall": CPrinter.block(
                [f"const {CPrinter.TYPES[type_]} {name} = monitor->memory.{name};" for _, name, type_ in remembered]
            ),
            "memory_keep": CPrinter.block(keep),
        }

    def _bools(self, case: int | None) -> list[str]:
        """Return the code that reads the bool signals that only this case reads; if it is None, every step."""
        return self._code.bools(self._program.bools_read_in(case), self._program.booleans)

    def _move(self) -> list[str]:
        """Return the code that finds the next state of the automaton, with a case for each state or shape."""
        lines = [f"int {states.TARGET} = monitor->state;", f"const char *{states.LIMITING} = NULL;"]
        lines.append(f"double {states.ROBUSTNESS} = 0.0;")
        lines += [f"double {states.PROGRESS} = 0.0;"] if self._fspa.judge == "goal" else []
        has_tables = self._program.tables is not None
        lines += [f"const int {states.FIRST_EDGE} = first_edges[monitor->state];"] if has_tables else []
        lines.append("switch (state_shapes[monitor->state]) {" if has_tables else "switch (monitor->state) {")
        for number, case in enumerate(self._program.cases):
            # A case that contains declarations needs braces.
            lines += [f"{_INDENT}{line}" for line in self._printer.comment(case.comment)]
            lines.append(f"{_INDENT}case {number}: {{")
            values = [line for index in self._program.computed_in(number) for line in self._code.value(index)]
            lines += [f"{_INDENT * 2}{line}" for line in (*self._bools(number), *values)]
            statements = states.with_failed_step(case.statements, ProgramVariable(reward_step.STEPS))
            lines += self._printer.lines(statements, depth=2)
            lines += [f"{_INDENT * 2}break;", f"{_INDENT}}}"]
        return [*lines, "}"]

    def _judge(self) -> list[str]:
        """Return the code that computes progress and reward, and whether the episode ends."""
        used = variables_read(self._program.reward_statements)
        ends, verdict = f"states[{self._entered}].ends", f"states[{self._entered}].verdict"
        lines = [f"double {reward_step.BEST} = monitor->progress;", f"bool {reward_step.DONE} = monitor->done;"]
        lines.append(f"double {reward_step.REWARD};")
        declarations = {
            reward_step.STEPS_REAL: f"double {reward_step.STEPS_REAL} = (double){reward_step.STEPS};",
            reward_step.ENDS: f"bool {reward_step.ENDS} = {ends};",
            reward_step.VIOLATED: f"bool {reward_step.VIOLATED} = {verdict} == {self._prefix}_violated;",
            reward_step.SATISFIED: f"bool {reward_step.SATISFIED} = {verdict} == {self._prefix}_satisfied;",
        }
        lines += [f"const {line}" for name, line in declarations.items() if name in used]
        return [*lines, *self._printer.lines(self._program.reward_statements)]

    def _remember(self) -> list[str]:
        """Return the code that keeps the values of the registers for the next sample."""
        kept = list(zip(self._program.registers, self._program.kept, strict=True))
        # Compilers make a branch of a conditional expression.
        lines = ["static const double signs[] = {-1.0, 1.0};"] if any(isinstance(v, Choice) for _, v in kept) else []
        for index, (name, value) in enumerate(kept):
            text = f"signs[{name}]" if isinstance(value, Choice) else self._printer.text(value)
            lines.append(f"monitor->registers[{index}] = {text};")
        return lines


# --- pieces ---------------------------------------------------------------------------------------


def _list(items: Sequence[str], otherwise: str) -> str:
    """Return the text of the items of an array initializer.

    If there are no items, use ``otherwise`` as the only item, because C needs at least one.
    """
    return CPrinter.items(items or [otherwise], depth=1)
