"""The GDScript of a monitor, and a main script that runs it as a program, for every version of Godot.

The monitor gives the same results as :class:`tltlc.monitor.Monitor` with its default reward, to the
last bit if the engine's ``pow``, ``exp`` and ``tanh`` are those that Python was built with. The
scripts do not use the engine's generic ``min``, ``max`` and ``clamp``, since these round to single
precision in Godot 3. Godot 3 also rounds a number that it parses from a string.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import Final

from tltlc.automaton.finite.blowup import recursion_room
from tltlc.automaton.fspa import Fspa
from tltlc.automaton.text import label_text
from tltlc.backends import Files
from tltlc.backends.godot.dialect import Dialect
from tltlc.backends.godot.names import RESERVED, snake_case
from tltlc.backends.godot.numbers import signed_number
from tltlc.backends.godot.printer import Gd
from tltlc.backends.templates import fill_template, names_in
from tltlc.monitor.samples import range_text
from tltlc.program import reward_step, snippets, states
from tltlc.program.arithmetic import with_declaration
from tltlc.program.build import DT, program
from tltlc.program.enums import nested_enums, upper_case
from tltlc.program.label_texts import LabelTexts
from tltlc.program.printer import CHOICE
from tltlc.program.shapes import StateTables
from tltlc.program.step_code import StepCode
from tltlc.program.tree import FAILING, BinaryNumber, Int, ProgramVariable
from tltlc.program.used_names import functions_called
from tltlc.resolve.spec import Param, Signal

ENDINGS = ("_monitor.gd", "_monitor_main.gd")

_FEW_CASES: Final = 8
"""The most states, or shapes of states, that a step compares with the current one after the other.

If there are more, comparisons halve them.
"""

_MEMBERS = {
    states.TARGET: "state",
    states.ROBUSTNESS: "robustness",
    states.LIMITING: "limiting",
    states.FAILURE: "failure",
    states.PROGRESS: "reached",
    reward_step.BEST: "progress",
    reward_step.REWARD: "reward",
    reward_step.DONE: "done",
    reward_step.STEPS: "steps",
    reward_step.STEPS_REAL: "float(steps)",
    reward_step.ENDS: "ENDS[state]",
    reward_step.VIOLATED: "verdict == Verdict.VIOLATED",
    reward_step.SATISFIED: "verdict == Verdict.SATISFIED",
}
"""The text in the script for some variables of the program; most of them are members of the monitor.

A step that refuses its sample returns before it assigns to any of these members, so the monitor
stays unchanged.
"""


def files(fspa: Fspa, dialect: Dialect) -> Files:
    """Return the monitor ``NAME_monitor.gd``, and ``NAME_monitor_main.gd``, which runs it as a program.

    NAME is the name of the automaton.
    """
    script, main = (f"{fspa.name}{ending}" for ending in ENDINGS)
    places = {"file": script, "main": main, "title": dialect.title, **dialect.types()}
    places["and_length"] = ", _length" if fspa.clock_varies else ""
    places["value_names"] = _list(_list(map(dialect.string_literal, signal.values)) for signal in fspa.signals)
    present = [dialect.version, snippets.enum_block(fspa), *(["varies"] if fspa.clock_varies else [])]
    return {script: _Source(fspa, dialect).text(), main: fill_template("monitor_main.gd.txt", places, present)}


class _Source(StepCode):
    """Makes the script of one monitor, by filling the template ``monitor.gd.txt``."""

    def __init__(self, fspa: Fspa, dialect: Dialect) -> None:
        reserved = RESERVED | ({"registers"} if fspa.registers else set()) | ({DT} if fspa.clock_varies else set())
        super().__init__(program(fspa, reserved, has_bools=True))
        self._dialect, program_ = dialect, self._program
        variables = [*program_.signals, *program_.params, *program_.atoms, *program_.registers, *program_.before]
        renamed = snake_case(variables, reserved)
        self._printer = Gd({**renamed, **_MEMBERS}, dialect.functions, dialect.swapped)
        self._signals = [self._printer.name(name) for name in program_.signals]
        self._params = [self._printer.name(name) for name in program_.params]
        self._atoms = [self._printer.name(name) for name in program_.atoms]
        self._registers = [self._printer.name(name) for name in program_.registers]

    def text(self) -> str:
        """Return the text of ``NAME_monitor.gd``."""
        fspa, program_ = self._fspa, self._program
        failing = program_.functions & FAILING
        present = [*snippets.common_blocks(program_), *failing, *(["note"] if failing else [])]
        present += [] if all(program_.always_in_range) else ["atom"]
        present += ["number"] if any(signal.type != "bool" for signal in fspa.signals) else []
        present += ["params"] if fspa.params else []
        present += ["failures"] if program_.failures else []
        with recursion_room():
            step = Gd.block(self._step())
        present += [name for name in ("min", "max") if f"_{name}(" in step]
        first = fspa.states[0]
        places = {
            **self._dialect.types(),
            "title": snippets.title_comment(fspa, self._printer.comment),
            "engine": self._dialect.title,
            "base": self._dialect.base,
            "file": f"{fspa.name}{ENDINGS[0]}",
            "enums": "\n".join(self._enums()),
            "signals": self._strings(signal.name for signal in fspa.signals),
            "fields": self._strings(self._signals),
            "atoms": self._strings(atom.name for atom in fspa.atoms),
            "registers": self._strings(register.name for register in fspa.registers),
            "register_starts": _list([signed_number(register.initial) for register in fspa.registers]),
            "labels": self._strings(str(state.label) for state in fspa.states),
            "labels_english": self._strings(label_text(fspa, state.id) for state in fspa.states),
            **self._failures(),
            "verdicts": _list([f"Verdict.{state.verdict.upper()}" for state in fspa.states]),
            "first_verdict": f"Verdict.{first.verdict.upper()}",
            "first_accepting": snippets.boolean_literal(first.accepting),
            "accepting": _list([snippets.boolean_literal(state.accepting) for state in fspa.states]),
            "ends": _list(map(snippets.boolean_literal, program_.ends)),
            **self._tables(program_.tables),
            "exclusive": _list([str(list(group)) for group in fspa.exclusive]),
            "params": self._strings(param.name for param in fspa.params),
            "param_ranges": self._strings(range_text(param.low, param.high) for param in fspa.params),
            "sample_fields": self._sample_fields(),
            "sample_start": self._assignments("null"),
            "sample_sparse": self._assignments("false"),
            "param_fields": self._param_fields(),
            "param_checks": Gd.block(line for index in range(len(fspa.params)) for line in self._param_check(index)),
            "param_copies": Gd.block([f"_params.{name} = given.{name}" for name in self._params]),
            "sample": "sample" if fspa.signals else "_sample",
            "dt": f", {DT}: float" if fspa.clock_varies else "",
            "and_delta": ", delta" if fspa.clock_varies else "",
            "wrong_length": ", WRONG_LENGTH" if fspa.clock_varies else "",
            "step": step,
        }
        return fill_template("monitor.gd.txt", places, present)

    def _enums(self) -> list[str]:
        """Return the lines of an enum for each enum of the spec, each after an empty line.

        The names of types end in ``Value``, since the engine has classes such as ``Timer``.
        """
        types = names_in("monitor.gd.txt", r"\b([A-Z]\w*)")
        lines: list[str] = []
        for enum in nested_enums(self._fspa, types, ("INF", "NAN", "PI", "TAU"), upper_case, "Value"):
            comments = [f"#{line}" for line in self._printer.comment(enum.title)]
            lines += ["", *comments, f"enum {enum.type} {{ {', '.join(enum.constants)} }}"]
        return lines

    def _failures(self) -> dict[str, str]:
        """Return the pieces of the template about what a step can fail at."""
        failures = snippets.failure_texts(self._program)
        return {
            "failed_clauses": self._strings(clause or "" for clause, _ in failures),
            "failed_atoms": self._strings(atom or "" for _, atom in failures),
            "failed_clause": '"" if failure < 0 else FAILED_CLAUSES[failure]' if failures else '""',
            "failed_atom": '"" if failure < 0 else FAILED_ATOMS[failure]' if failures else '""',
        }

    def _tables(self, tables: StateTables | None) -> dict[str, str]:
        """Return the pieces of the template with the tables of states; they are empty if there are none.

        The script has the verdict of each state instead of the state's kind.
        """
        if tables is None:
            return {"tables": "", "label_texts": "", "english_texts": ""}
        columns = tables.all_tables(self._fspa.judge)
        columns["first_numbers"] = tables.labels.first_numbers
        columns["english_first"] = tables.labels_english.first_numbers
        del columns["state_kinds"]
        types, lines = self._dialect.types(), []
        for name, numbers in columns.items():
            is_real = name == "level_progress"
            items = map(signed_number if is_real else repr, numbers)
            lines.append(f"const _{name.upper()}: {types['floats' if is_real else 'ints']} = {_list(items)}")
        return {
            "tables": "\n".join(lines),
            "label_texts": self._label_texts(tables.labels),
            "english_texts": self._label_texts(tables.labels_english),
        }

    # --- records ----------------------------------------------------------------------------------

    def _sample_fields(self) -> str:
        fields = zip(self._fspa.signals, self._signals, strict=True)
        return self._fields(
            [
                (name, "", "null", signal) if signal.type == "bool" else (name, "float", "INF", signal)
                for signal, name in fields
            ]
        )

    def _assignments(self, bool_value: str) -> str:
        """Return the lines that make all numbers of a sample missing, and give a value to its bools."""
        lines = [
            f"{name} = {bool_value if signal.type == 'bool' else 'INF'}"
            for signal, name in zip(self._fspa.signals, self._signals, strict=True)
        ]
        return Gd.block(lines or ["pass"], depth=2)

    def _param_fields(self) -> str:
        fields = zip(self._fspa.params, self._params, strict=True)
        return self._fields([(name, "float", signed_number(param.value), param) for param, name in fields])

    def _fields(self, fields: Sequence[tuple[str, str, str, Signal | Param]]) -> str:
        """Return the lines that declare the variables of a class, each with its documentation.

        Each of ``fields`` has the variable's name, its type (empty for any), its first value, and the
        signal or param that it is for.
        """
        lines: list[str] = []
        for name, type_, value, declared in fields:
            # Godot 4 shows `##` comments as documentation. There, `[` begins a tag, except before a number.
            description = snippets.field_comment(name, declared, lambda text: text.replace("[", "[lb]"))
            comments = [f"#{line}" for line in self._printer.comment(description)]
            field = f"var {name}{f': {type_}' if type_ else ''} = {value}"
            # A short comment goes on the line of its field.
            if len(comments) == 1 and len(field) + len(comments[0]) < 90:
                lines.append(f"{field}  {comments[0]}")
            else:
                lines += [*comments, field]
        return Gd.block(lines)

    def _param_check(self, index: int) -> list[str]:
        param, name = self._fspa.params[index], f"given.{self._params[index]}"
        refused = [f"\t_wrong = {name}", f"\treturn _refuse(Problem.WRONG_PARAM, {index})"]
        return [f"if not ({_within(name, param)}):", *refused]

    # --- the step function ------------------------------------------------------------------------

    def _read(self) -> list[str]:
        """Return the code that checks ``dt``, and reads signals, clamped to their ranges, and params into variables."""
        used = self._program.variables_used
        lines: list[str] = []
        if self._fspa.clock_varies:
            lines += [f"if not ({DT} >= 0.0 and {DT} < INF):", f"\t_wrong_length = {DT}"]
            lines.append("\treturn _refuse(Problem.WRONG_LENGTH, 0)")
        for index, (signal, name) in enumerate(zip(self._fspa.signals, self._signals, strict=True)):
            if signal.type == "bool":
                lines.append(f"if sample.{name} == null and problem == Problem.NONE:")
                lines += ["\tproblem = Problem.NOT_SET", f"\twhich = {index}"]
                continue
            is_used = self._program.signals[index] in used
            value = name if is_used else f"sample.{name}"
            low, high = _ends(signal)
            call = f"_read({index}, {value}, {low}, {high})"
            lines += [f"var {name}: float = sample.{name}"] if is_used else []
            lines += [f"if not ({_within(value, signal)}):", f"\t{f'{name} = ' if is_used else ''}{call}"]
        lines += self._stop() if self._signals else []
        lines += self._bools(None)
        lines += [
            f"var {name}: float = _params.{name}"
            for name, variable in zip(self._params, self._program.params, strict=True)
            if variable in used
        ]
        lines += [
            f"var {self._printer.name(variable)}: bool = registers[{index}] > 0.0"
            if variable in self._program.booleans
            else f"var {self._printer.name(variable)}: float = registers[{index}]"
            for index, variable in enumerate(self._program.before)
            if variable in used
        ]
        return lines

    def _bools(self, case: int | None) -> list[str]:
        """Return the code that converts bool signals to the numbers 0 and 1.

        It converts the signals that only this case reads or, if ``case`` is None, those that every
        step reads.
        """
        lines = []
        for variable in self._program.bools_read_in(case):
            name = self._printer.name(variable)
            is_bool = variable in self._program.booleans
            lines.append(
                f"var {name}: {f'bool = sample.{name}' if is_bool else f'float = 1.0 if sample.{name} else 0.0'}"
            )
        return lines

    def _stop(self) -> list[str]:
        return ["if problem != Problem.NONE:", "\treturn false"]

    def _compute(self) -> list[str]:
        last_check = not self._program.registers and not all(self._program.always_in_range)
        return [*super()._compute(), *(self._stop() if last_check else [])]

    def _range_check(self, index: int) -> list[str]:
        name = self._atoms[index]
        lines = [f"if not ({name} >= -1.0 and {name} <= 1.0):", f"\t{name} = _value({index}, {name})"]
        return [*lines, *(self._stop() if self._program.registers else [])]

    def _value(self, index: int) -> list[str]:
        program_, statements = self._program, self._program.values[index]
        lines = self._printer.comment(program_.atom_comments[index])
        lines += self._printer.lines(with_declaration(program_.atoms[index], statements))
        if functions_called(statements) & FAILING:
            lines += ["if problem != Problem.NONE:", f"\treturn _refuse(problem, {index})"]
        return lines

    def _register(self, index: int) -> list[str]:
        program_, statements = self._program, self._program.updates[index]
        place = len(self._atoms) + index
        lines = self._printer.comment(program_.register_comments[index])
        lines += self._printer.lines(with_declaration(program_.registers[index], statements, changes=False))
        if functions_called(statements) & FAILING:
            lines += ["if problem != Problem.NONE:", f"\treturn _refuse(problem, {place})"]
        if not program_.always_finite[index]:
            lines += [f"if not _is_number({self._registers[index]}):"]
            lines.append(f"\treturn _refuse(Problem.TOO_LARGE, {place})")
        return lines

    def _check(self) -> list[str]:
        lines: list[str] = []
        for index, group in self._program.exclusive:
            names = [self._atoms[atom] for atom in group]
            holding = " + ".join(f"int({name} > 0.0)" for name in names)
            lines += [f"if {holding} > 1:", f"\t_clashing = [{', '.join(names)}]"]
            lines.append(f"\treturn _refuse(Problem.TOGETHER, {index})")
        return lines

    def _move(self) -> list[str]:
        """Return the code that finds the next state, by tests of the current state or its shape.

        The tests are faster than ``match``.
        """
        lines = ["var reached: float = 0.0"] if self._fspa.judge == "goal" else []
        count = len(self._program.cases)
        if self._program.tables is not None:
            lines.append(f"var {states.FIRST_EDGE}: int = _FIRST_EDGES[state]")
            lines.append("var state_shape: int = _STATE_SHAPES[state]")
            return [*lines, *self._halved("state_shape", 0, count)]
        if count > _FEW_CASES:
            return [*lines, *self._halved("state", 0, count)]
        for place in range(count):
            lines.append(self._printer.head(f"state == {place}", first=place == 0))
            lines += [f"\t{line}" for line in self._case(place)]
        return lines

    def _halved(self, variable: str, first: int, end: int) -> list[str]:
        """Return the code that finds the case among ``first``, …, ``end - 1`` whose number is in a variable."""
        if end - first == 1:
            return self._case(first)
        middle = (first + end) // 2
        lines = [self._printer.head(f"{variable} < {middle}", first=True)]
        lines += [f"\t{line}" for line in self._halved(variable, first, middle)]
        lines.append(self._printer.otherwise())
        return [*lines, *(f"\t{line}" for line in self._halved(variable, middle, end))]

    def _case(self, place: int) -> list[str]:
        case = self._program.cases[place]
        lines = [*self._printer.comment(case.comment), *self._bools(place), *self._values(place)]
        # `steps` counts this step only at its end.
        number = BinaryNumber("+", ProgramVariable(reward_step.STEPS), Int(1))
        return [*lines, *self._printer.lines(states.with_failed_step(case.statements, number))]

    def _judge(self) -> list[str]:
        # Adding 0 replaces -0 by 0, as in all monitors.
        lines = ["robustness += 0.0", "verdict = VERDICTS[state]", "accepting = ACCEPTING[state]", "steps += 1"]
        lines += ["failed_step = 1"] if self._fspa.states[0].verdict == "violated" else []
        return [*lines, *self._printer.lines(self._program.reward_statements)]

    def _remember(self) -> list[str]:
        texts = (self._printer.text(value, CHOICE) for value in self._program.kept)
        return [f"registers[{index}] = {text}" for index, text in enumerate(texts)]

    # --- pieces -----------------------------------------------------------------------------------

    def _label_texts(self, labels: LabelTexts) -> str:
        return _list([f"[{', '.join(map(self._dialect.string_literal, pieces))}]" for pieces in labels.texts])

    def _strings(self, texts: Iterable[str]) -> str:
        return _list(map(self._dialect.string_literal, texts))


def _ends(field: Signal | Param) -> tuple[str, str]:
    """Return the lowest and the highest value of a signal or a param, as GDScript: ``("0.0", "INF")``."""
    low = "-INF" if field.low is None else signed_number(field.low)
    return low, "INF" if field.high is None else signed_number(field.high)


def _within(value: str, field: Signal | Param) -> str:
    """Return a GDScript expression that is true if ``value`` is finite and in the range of a signal or param."""
    low, high = _ends(field)
    return (
        f"{value} {'>' if field.low is None else '>='} {low} and {value} {'<' if field.high is None else '<='} {high}"
    )


def _list(items: Iterable[str]) -> str:
    return f"[{Gd.items([*items])}]"
