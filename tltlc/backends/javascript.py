"""A stand-alone monitor in JavaScript: one ES module for browsers and Node, and its TypeScript types.

It gives the same results as :class:`tltlc.monitor.Monitor` with its default reward: to the last bit
if predicates use no ``exp``, ``tanh`` or power, and within 1e-12 if they do, since engines compute
these functions in their own ways.
"""

from __future__ import annotations

from collections.abc import Sequence
from itertools import combinations

from tltlc.automaton.finite.blowup import recursion_room
from tltlc.automaton.fspa import Fspa
from tltlc.automaton.text import label_text
from tltlc.backends import Files, Options, Target
from tltlc.backends.languages.javascript_syntax import (
    JavaScriptPrinter,
    array,
    branch_lines,
    key,
    member,
    number_literal,
    own_key,
    range_test,
    string_literal,
)
from tltlc.backends.templates import fill_template
from tltlc.program import reward_step, snippets, states
from tltlc.program.arithmetic import with_declaration
from tltlc.program.build import DT, program
from tltlc.program.enums import enums_of
from tltlc.program.label_texts import LabelTexts
from tltlc.program.nesting_limit import split_deep_values
from tltlc.program.printer import CHOICE, comment_lines
from tltlc.program.shapes import StateTables
from tltlc.program.step_code import StepCode
from tltlc.program.tree import FAILING
from tltlc.program.used_names import functions_called, variables_read
from tltlc.resolve.spec import Param, Signal

TARGET = Target(
    "javascript",
    "a stand-alone monitor in JavaScript, with types",
    ("_monitor.mjs", "_monitor.d.mts"),
    ("js", "mjs", "node", "ts", "typescript", "web"),
)

_FEW = 3
"""The largest exclusive group whose atoms are tested in pairs; in a larger one, the atoms that hold are counted."""

_VALUES_DOC = "The values of enums, by the name of a signal without its arguments, and the name of the value."

_NAMED_VALUE = (
    "const names = VALUE_NAMES.get(name);",
    'if (names && typeof given === "string") {',
    "  if (names.includes(given)) return names.indexOf(given);",
    "  throw this.#error(`the signal \\`${name}\\` is \\`${given}\\`, ${notValue(name)}`);",
    "}",
)
"""The code that takes the name of a value of an enum in place of its number."""

_ENTERED = "entered"
"""The variable with the entry of the next state in the table of states."""

_RESERVED = """
    abstract arguments as async await boolean break byte case catch char class const continue debugger default delete
    do double else enum eval export extends false final finally float for from function get goto if implements import
    in instanceof int interface let long native new null of package private protected public return set short static
    super switch synchronized this throw throws transient true try typeof undefined var void volatile while with yield
    Infinity Math Monitor MonitorError NaN Number Object Result RowReader Set String TextDecoder globalThis process
    ATOMS EXCLUSIVE FAILURES PARAMS SIGNALS STATES entered listed max min paramValues result shown signals
    EDGE_TARGETS FIRST_EDGES LEVEL_PROGRESS STATE_LEVELS STATE_SHAPES
""".split()
"""Names that no variable may have: words of the language, and other names that the step function uses."""


def emit(fspa: Fspa, options: Options) -> Files:
    """Return the module ``NAME_monitor.mjs`` and its TypeScript types ``NAME_monitor.d.mts``.

    NAME is the name of the automaton.
    """
    module, declarations = (f"{fspa.name}{ending}" for ending in TARGET.endings)
    source = _Source(fspa, module, declarations)
    return {module: source.module(), declarations: source.declarations()}


class _Source(StepCode):
    """Makes the module of one monitor and its TypeScript types, by filling their templates."""

    def __init__(self, fspa: Fspa, module: str, declarations: str) -> None:
        super().__init__(program(fspa, _RESERVED))
        self._module, self._declarations = module, declarations
        self._names = (*self._program.signals, *self._program.params, *self._program.atoms)
        names = [atom.name for atom in fspa.atoms]
        self._printer = JavaScriptPrinter(names)
        self._can_fail = any(state.verdict == "violated" for state in fspa.states)
        # Math.min may return 0 for -0, which does not matter for atoms, and is faster than a method of the monitor.
        self._moves = JavaScriptPrinter(names, ("min", "max"))

    def module(self) -> str:
        """Return the text of ``NAME_monitor.mjs``, the module with the monitor."""
        fspa = self._fspa
        program_ = self._program
        with recursion_room():
            step = JavaScriptPrinter.block(self._step(), depth=2)
        present: list[str] = [*snippets.common_blocks(program_), *program_.functions]
        present += ["failing"] if program_.functions & FAILING else []
        present += ["signal"] if fspa.signals else []
        present += [] if all(program_.always_in_range) else ["range"]
        present += ["computed"] if fspa.registers and "failing" in present else []
        present += ["atom"] if {"failing", "range", "exclusive"} & {*present} else []
        needs_errors = fspa.clock_varies or "atom" in present or not all(program_.always_finite)
        present += ["some"] if fspa.signals or needs_errors else []
        present += ["clamp"] if fspa.signals or "range" in present else []
        present += ["params"] if program_.variables_used & {*program_.params} else []
        present += ["fails"] if self._can_fail else []
        present += ["causes"] if program_.failures else []
        places = {
            "title": snippets.title_comment(fspa, self._printer.comment),
            "file": self._module,
            "declarations": self._declarations,
            "example": snippets.example_sample(fspa.signals, key, ": "),
            "signals": array(
                [_row(signal, f"isBool: {snippets.boolean_literal(signal.type == 'bool')}") for signal in fspa.signals]
            ),
            "enums": self._enums(),
            # Blocks of a template cannot be nested.
            "named_value": JavaScriptPrinter.block(_NAMED_VALUE if enums_of(fspa) else [], depth=2),
            "params": array([_row(param, f"value: {number_literal(param.value)}") for param in fspa.params]),
            "atoms": array([string_literal(atom.name) for atom in fspa.atoms]),
            "registers": array([string_literal(register.name) for register in fspa.registers]),
            "register_starts": array([number_literal(register.initial) for register in fspa.registers]),
            "computed": "${computed(this.#atom)}" if fspa.registers else "atom \\`${ATOMS[this.#atom]}\\`",
            # The monitor checks the names of params even if no atom reads a param.
            "params_kept": "this.#params = " if "params" in present else "",
            "options": ", options = {}" if fspa.signals else "",
            "failures": array(self._failures()),
            "exclusive": array([f"[{', '.join(map(str, group))}]" for group in fspa.exclusive]),
            "states": array(self._states()),
            **self._state_tables(program_.tables),
            "dt": f"{DT}, " if fspa.clock_varies else "",
            "length": "lengths.next(cells, reader.first), " if fspa.clock_varies else "",
            "step": step,
        }
        return fill_template("monitor.mjs.txt", places, present)

    def declarations(self) -> str:
        """Return the text of ``NAME_monitor.d.mts``, the TypeScript types of the module."""
        fspa = self._fspa
        signals = [
            (
                signal.name,
                _type(signal),
                snippets.field_comment(signal.name, signal),
            )
            for signal in fspa.signals
        ]
        params = [(param.name, "number", snippets.field_comment(param.name, param)) for param in fspa.params]
        title = f"// Types of {self._module}, written by tltlc."
        places = {"title": title, "signal_fields": _fields(signals), "param_fields": _fields(params)}
        places["dt"] = f"{DT}: number, " if fspa.clock_varies else ""
        places["enums"] = self._enum_types()
        places["sparse"] = _sparse_signals(fspa.signals)
        present = ["signals" if signals else "no_signals", "params" if params else "no_params"]
        present += ["registers"] if fspa.registers else []
        present += ["varies"] if fspa.clock_varies else []
        return fill_template("monitor.d.mts.txt", places, present)

    def _enums(self) -> str:
        """Return the values of enums, and their names by signal; an empty text if there are none."""
        enums = enums_of(self._fspa)
        if not enums:
            return ""
        lines = ["", f"/** {_VALUES_DOC} */", "export const VALUES = Object.freeze({"]
        for enum in enums:
            values = ", ".join(f"{own_key(value)}: {number}" for number, value in enumerate(enum.values))
            lines.append(f"  {own_key(enum.base)}: Object.freeze({{ {values} }}),")
        lines += ["});", "", "/** @type {ReadonlyMap<string, ReadonlyArray<string>>} */"]
        lines.append("const VALUE_NAMES = new Map([")
        for enum in enums:
            names = ", ".join(map(string_literal, enum.values))
            lines += [f"  [{string_literal(signal)}, [{names}]]," for signal in enum.signals]
        return "\n".join([*lines, "]);"])

    def _enum_types(self) -> str:
        """Return the types of the values of enums, and an empty line; an empty text if there are none."""
        enums = enums_of(self._fspa)
        if not enums:
            return ""
        lines = [f"/** {_VALUES_DOC} */", "export const VALUES: {"]
        for enum in enums:
            values = " ".join(f"readonly {key(value)}: {number};" for number, value in enumerate(enum.values))
            lines.append(f"  readonly {key(enum.base)}: {{ {values} }};")
        return "\n".join([*lines, "};", ""])

    def _states(self) -> list[str]:
        """Return a row for each state or, if there are tables, for each kind of states, without labels."""
        tables = self._program.tables
        rows: list[str] = []
        for index in self._program.state_rows:
            state, ends = self._fspa.states[index], snippets.boolean_literal(self._program.ends[index])
            values = f'verdict: "{state.verdict}", accepting: {snippets.boolean_literal(state.accepting)}, ends: {ends}'
            if tables is None:
                english = string_literal(label_text(self._fspa, index))
                values = f"label: {string_literal(str(state.label))}, label_english: {english}, {values}"
            rows.append(f"{{ {values} }}")
        return rows

    def _failures(self) -> list[str]:
        """Return a row for what a step can fail at."""
        return [
            f"{{ clause: {_text_or_null(clause)}, atom: {_text_or_null(atom)} }}"
            for clause, atom in snippets.failure_texts(self._program)
        ]

    def _state_tables(self, tables: StateTables | None) -> dict[str, str]:
        """Return the pieces of the template with the tables of states; they are empty if there are none."""
        if tables is None:
            return {"tables": "", "label_texts": "", "english_texts": ""}
        lines = [
            f"const {name.upper()} = [{JavaScriptPrinter.items([*map(number_literal, numbers)])}];"
            for name, numbers in tables.all_tables(self._fspa.judge).items()
        ]
        return {
            "tables": "\n".join(lines),
            "label_texts": _label_texts(tables.labels),
            "english_texts": _label_texts(tables.labels_english),
        }

    # --- the step function ------------------------------------------------------------------------

    def _read(self) -> list[str]:
        """Return the code that checks ``dt``, and reads signals, clamped to their ranges, and params into variables."""
        used = self._program.variables_used
        lines: list[str] = []
        if self._fspa.clock_varies:
            lines += branch_lines([f"!({range_test(DT, 0.0, None)})"], f"throw this.#length({DT});")
        for index, (signal, name) in enumerate(zip(self._fspa.signals, self._program.signals, strict=True)):
            checked = f"this.#signal({index}, signals)"
            if name not in used:
                # The monitor checks unused signals, too.
                lines.append(f"{checked};")
                continue
            given = member("signals", signal.name)
            if signal.type == "bool":
                lines.append(f"const {name} = {given} === true ? 1 : {given} === false ? 0 : {checked};")
            else:
                # The names of values fail the test of the range.
                number = f"/** @type {{number}} */ ({given})" if signal.values else given
                lines.append(f"let {name} = {number};")
                lines += branch_lines([f"!({range_test(name, signal.low, signal.high)})"], f"{name} = {checked};")
        for index, name in enumerate(self._program.params):
            lines += [f"const {name} = this.#params[{index}];"] if name in used else []
        for index, name in enumerate(self._program.before):
            lines += [f"const {name} = this.registers[{index}];"] if name in used else []
        return lines

    def _value(self, index: int) -> list[str]:
        program_, statements = self._program, self._program.values[index]
        lines = self._printer.comment(program_.atom_comments[index])
        if functions_called(statements) & FAILING:
            lines.append(f"this.#atom = {index};")
        changes = not program_.always_in_range[index]
        return [*lines, *self._printer.lines(with_declaration(program_.atoms[index], statements, changes=changes))]

    def _range_check(self, index: int) -> list[str]:
        name = self._program.atoms[index]
        return [f"if (!(-1 <= {name} && {name} <= 1)) {name} = this.#inRange({index}, {name});"]

    def _register(self, index: int) -> list[str]:
        program_, statements, name = self._program, self._program.updates[index], self._program.registers[index]
        lines = self._printer.comment(program_.register_comments[index])
        if functions_called(statements) & FAILING:
            lines.append(f"this.#atom = {len(self._fspa.atoms) + index};")
        lines += self._printer.lines(with_declaration(name, statements, changes=False))
        if not program_.always_finite[index]:
            text = string_literal(f"the register `{self._fspa.registers[index].name}` is too large to compute")
            lines += branch_lines([f"!Number.isFinite({name})"], f"throw this.#error({text});")
        return lines

    def _check(self) -> list[str]:
        lines: list[str] = []
        for index, group in self._program.exclusive:
            names = [self._program.atoms[atom] for atom in group]
            refusal = f"throw this.#together({index}, [{', '.join(names)}]);"
            if len(names) <= _FEW:
                pairs = [f"{first} > 0 && {second} > 0" for first, second in combinations(names, 2)]
                tests = pairs if len(pairs) == 1 else [f"({pair})" for pair in pairs]
                lines += branch_lines(tests, refusal, "||")
            else:
                *before, last = [f"({name} > 0 ? 1 : 0)" for name in names]
                lines += branch_lines([*before, f"{last} > 1"], refusal, "+")
        return lines

    def _move(self) -> list[str]:
        lines = [f"let {states.TARGET} = this.state;", f"let {states.ROBUSTNESS} = 0;"]
        lines += [f"let {states.PROGRESS} = 0;"] if self._fspa.judge == "goal" else []
        lines.append(f"let {states.LIMITING} = null;")
        lines += [f"let {states.FAILURE} = -1;"] if self._program.failures else []
        has_tables = self._program.tables is not None
        lines += [f"const {states.FIRST_EDGE} = FIRST_EDGES[this.state];"] if has_tables else []
        lines.append(f"switch ({'STATE_SHAPES[this.state]' if has_tables else 'this.state'}) {{")
        for number, case in enumerate(self._program.cases):
            # A case that contains declarations needs braces.
            lines += [f"  {line}" for line in self._printer.comment(case.comment)]
            lines.append(f"  case {number}: {{")
            lines += [f"    {line}" for line in self._values(number)]
            lines += self._moves.lines(split_deep_values(case.statements, self._names), depth=2)
            lines += ["    break;", "  }"]
        return [*lines, "}"]

    def _judge(self) -> list[str]:
        used = variables_read(self._program.reward_statements)
        lines = [f"const {_ENTERED} = STATES[{states.TARGET}];", f"let {reward_step.BEST} = this.progress;"]
        lines += [f"let {reward_step.DONE} = this.done;", f"let {reward_step.REWARD};"]
        definitions = {
            reward_step.ENDS: f"{_ENTERED}.ends",
            reward_step.VIOLATED: f'{_ENTERED}.verdict === "violated"',
            reward_step.SATISFIED: f'{_ENTERED}.verdict === "satisfied"',
        }
        lines += [f"const {name} = {value};" for name, value in definitions.items() if name in used]
        return [*lines, *self._printer.lines(self._program.reward_statements)]

    def _remember(self) -> list[str]:
        texts = (self._printer.text(value, CHOICE) for value in self._program.kept)
        return [*(f"this.registers[{index}] = {text};" for index, text in enumerate(texts)), *self._fail()]

    def _fail(self) -> list[str]:
        """Return the code that keeps what the trace fails at, at the first step at which it does."""
        if not self._can_fail:
            return []
        step = f"step: {reward_step.STEPS}"
        if self._program.failures:
            return [f"if ({states.FAILURE} >= 0) this.#failure = {{ ...FAILURES[{states.FAILURE}], {step} }};"]
        # The trace has failed before it begins.
        return [f"if (this.#failure === NOT_FAILED) this.#failure = {{ clause: null, atom: null, {step} }};"]


# --- pieces ---------------------------------------------------------------------------------------


def _fields(fields: Sequence[tuple[str, str, str]]) -> str:
    """Return the properties of a TypeScript interface, each after its documentation.

    Each of ``fields`` has the name, the type and the documentation of a property.
    """
    lines: list[str] = []
    for name, type_, doc in fields:
        doc_lines = [line.replace("*/", "* /") for line in comment_lines(doc)]
        if len(doc_lines) == 1:
            lines.append(f"/** {doc_lines[0]} */")
        elif doc_lines:
            lines += ["/**", *(f" * {line}" for line in doc_lines), " */"]
        lines.append(f"{key(name)}: {type_};")
    return JavaScriptPrinter.block(lines)


def _text_or_null(text: str | None) -> str:
    return "null" if text is None else string_literal(text)


def _label_texts(labels: LabelTexts) -> str:
    return array([f"[{', '.join(map(string_literal, pieces))}]" for pieces in labels.texts])


def _row(field: Signal | Param, properties: str) -> str:
    least = "-Infinity" if field.low is None else number_literal(field.low)
    greatest = "Infinity" if field.high is None else number_literal(field.high)
    return f"{{ name: {string_literal(field.name)}, {properties}, low: {least}, high: {greatest} }}"


def _sparse_signals(signals: Sequence[Signal]) -> str:
    """Return the TypeScript type of a sample in which bools may be missing."""
    bools = " | ".join(string_literal(signal.name) for signal in signals if signal.type == "bool")
    return f"Omit<Signals, {bools}> & Partial<Pick<Signals, {bools}>>" if bools else "Signals"


def _type(signal: Signal) -> str:
    if signal.type == "bool":
        return "boolean | 0 | 1"
    return " | ".join(["number", *map(string_literal, signal.values)])
