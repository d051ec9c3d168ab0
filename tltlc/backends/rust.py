"""A stand-alone monitor in Rust: one module that needs only `core`, except for roots, powers, ``exp`` and ``tanh``.

It gives the same results to the last bit as :class:`tltlc.monitor.Monitor` with its default reward,
if the platform's ``pow``, ``exp`` and ``tanh`` are those that Python was built with.
"""

from __future__ import annotations

from collections.abc import Sequence
from textwrap import wrap

from tltlc.automaton.finite.blowup import recursion_room
from tltlc.automaton.fspa import Fspa
from tltlc.automaton.text import label_text
from tltlc.backends import Files, Options, Target
from tltlc.backends.languages.rust_syntax import MATH_FUNCTIONS, RustPrinter, markdown_lines, string_literal
from tltlc.backends.templates import fill_template, names_in
from tltlc.program import reward_step, snippets, states
from tltlc.program.arithmetic import with_declaration
from tltlc.program.build import program
from tltlc.program.enums import flat_enums, upper_case
from tltlc.program.label_texts import LabelTexts
from tltlc.program.printer import CHOICE, Printer, comment_lines
from tltlc.program.shapes import StateTables
from tltlc.program.step_code import StepCode
from tltlc.program.tree import ProgramVariable
from tltlc.program.used_names import variables_read
from tltlc.resolve.spec import Param, Signal

TARGET = Target("rust", "a stand-alone monitor in Rust", ("_monitor.rs",), ("bevy", "rs"))

_INDENT = Printer.INDENT
_RESERVED = """
    abstract as async await become box break const continue crate do dyn else enum extern false final fn for gen if
    impl in let loop macro match mod move mut override priv pub raw ref return self Self static struct super trait
    true try type typeof union unsafe unsized use virtual where while yield auto default macro_rules safe
    abs core exp f64 bool char str usize isize i8 i16 i32 i64 i128 u8 u16 u32 u64 u128 f16 f32 f128 math max min place
    entered failed sample fmt std alloc main program tltl_math
    ATOM_NAMES Default Err FAILURES GROUPS LARGEST_GROUP Monitor NOTICE_ROOM None Notice Ok Option Params Place Problem
    Refused Result SIGNAL_NAMES STATES Shown Signals Some Step Verdict WrongParam
    EDGE_TARGETS FIRST_EDGES KINDS LABELS LABELS_ENGLISH LEVEL_PROGRESS STATE_KINDS STATE_LEVELS STATE_SHAPES
""".split()
"""Names that no variable may have: words of the language, and names in the template."""

_CORE = "It needs `core` alone."
_MORE = """
It needs `core`, and {names} of `std`.  Without `std`, build with `--cfg tltl_no_std` and give the crate a module
`tltl_math` with {functions} on f64, as the crate `libm` has them.
"""


def emit(fspa: Fspa, options: Options) -> Files:
    """Return the module ``NAME_monitor.rs``, where NAME is the name of the automaton."""
    name = f"{fspa.name}{TARGET.endings[0]}"
    return {name: _Source(fspa, name).text()}


class _Source(StepCode):
    """Makes the Rust module of one monitor, by filling the template ``monitor.rs.txt``."""

    def __init__(self, fspa: Fspa, file: str) -> None:
        self._enums = flat_enums(fspa, [*_RESERVED, *names_in("monitor.rs.txt", r"\b([A-Z]\w*)")], upper_case)
        constants = [name for enum in self._enums for name in enum.constants]
        super().__init__(program(fspa, [*_RESERVED, *constants], has_bools=True))
        self._file = file
        self._printer = RustPrinter()
        program_ = self._program
        used = variables_read(statement for case in program_.cases for statement in case.statements)
        used |= {program_.atoms[atom] for _, group in program_.exclusive for atom in group} | program_.variables_kept
        self._used = used

    def text(self) -> str:
        """Return the text of ``NAME_monitor.rs``."""
        fspa, program_ = self._fspa, self._program
        signals = list(zip(fspa.signals, program_.signals, strict=True))
        params = list(zip(fspa.params, program_.params, strict=True))
        present = [*snippets.common_blocks(program_), *program_.functions]
        present += [] if all(program_.always_in_range) else ["keep"]
        present += ["math"] if program_.functions & MATH_FUNCTIONS else []
        present += ["number"] if any(signal.type != "bool" for signal in fspa.signals) else []
        present += ["bool"] if any(signal.type == "bool" for signal in fspa.signals) else []
        present += ["failures" if program_.failures else "no_failures"]
        with recursion_room():
            step = RustPrinter.block(self._step(), 2)
        give_code = self._give()
        places = {
            "p": fspa.name,
            "title": "\n".join(self._title()),
            "dt": ", dt" if fspa.clock_varies else "",
            "dt_parameter": ", dt: f64" if fspa.clock_varies else "",
            "file": self._file,
            "enums": "\n".join(self._enum_lines()),
            "needs": "\n".join(self._needs(program_.functions & MATH_FUNCTIONS)),
            "signal_fields": _fields([(name, _type(signal), signal) for signal, name in signals]),
            "param_fields": _fields([(name, "f64", param) for param, name in params]),
            "signal_count": str(len(signals)),
            "atom_count": str(len(fspa.atoms)),
            "group_count": str(len(fspa.exclusive)),
            "state_count": str(len(fspa.states)),
            "signal_names": RustPrinter.items([string_literal(signal.name) for signal in fspa.signals]),
            "atom_names": RustPrinter.items([string_literal(atom.name) for atom in fspa.atoms]),
            "register_count": str(len(fspa.registers)),
            "register_names": RustPrinter.items([string_literal(register.name) for register in fspa.registers]),
            "register_starts": RustPrinter.items(
                [snippets.number_literal(register.initial) for register in fspa.registers]
            ),
            # What a problem is about: an atom, or perhaps a register.
            "at_fault": "{}" if fspa.registers else "atom `{}`",
            "name_at_fault": "Computed(self.which)" if fspa.registers else "ATOM_NAMES[self.which]",
            "largest_group": str(max(map(len, fspa.exclusive), default=0)),
            "groups": RustPrinter.items([f"&[{', '.join(map(str, group))}]" for group in fspa.exclusive]),
            "signal_defaults": RustPrinter.block(self._sample("None"), 3),
            "sparse_defaults": RustPrinter.block(self._sample("Some(false)"), 2),
            "param_defaults": RustPrinter.block(
                [f"{name}: {snippets.number_literal(param.value)}," for param, name in params], 3
            ),
            "param_checks": RustPrinter.block(
                [line for param, name in params for line in _param_check(param, name)], 2
            ),
            "states": RustPrinter.block(self._states(), 1),
            **self._state_tables(program_.tables),
            "failure_count": str(len(program_.failures)),
            "failures": RustPrinter.block(self._failures(), 1),
            "failed_step": "NonZeroU64::new(1)" if fspa.states[0].verdict == "violated" else "None",
            "sample": "sample" if fspa.signals else "_",
            "step": step,
            "given": "sample" if give_code else "_",
            "value_names": RustPrinter.items(
                [f"&[{', '.join(map(string_literal, signal.values))}]" for signal in fspa.signals], 2
            ),
            "give": RustPrinter.block(give_code or ["signal < SIGNAL_NAMES.len() && value.is_finite()"], 2),
        }
        return fill_template("monitor.rs.txt", places, present)

    def _enum_lines(self) -> list[str]:
        """Return the lines of the constants for each enum of the spec, each after an empty line."""
        lines: list[str] = []
        for enum in self._enums:
            lines.append("")
            for number, (name, value) in enumerate(zip(enum.constants, enum.enum.values, strict=True)):
                about = markdown_lines(f"The value `{value}` of the signal `{enum.enum.base}`.")
                lines += [*(f"/// {line}" for line in about), f"pub const {name}: f64 = {number}.0;"]
        return lines

    def _title(self) -> list[str]:
        """Return a list with one text, the comment that begins the file: the spec's name, documentation and formula."""
        fspa = self._fspa
        title = f"Monitor of the specification `{fspa.name}`, written by tltlc."
        formula = ["```text", *comment_lines(str(fspa.formula).replace("```", "'''")), "```"]
        about = [markdown_lines(title), markdown_lines(fspa.doc), formula]
        parts = ["\n".join(f"//! {line}" for line in lines) for lines in about if lines]
        return ["\n//!\n".join(parts)]

    def _needs(self, functions: frozenset[str]) -> list[str]:
        """Return the lines of a comment that says what the file needs besides ``core``.

        ``functions`` are the numeric functions in the file that ``core`` lacks.
        """
        if not functions:
            return [f"//! {_CORE}"]
        names = [f"`{'pow' if function == 'power' else function}`" for function in sorted(functions)]
        listed = " and ".join([*([", ".join(names[:-1])] if names[1:] else []), names[-1]])
        text = " ".join(_MORE.format(names=listed, functions=listed).split())
        return [f"//! {line}" for line in wrap(text, 115, break_on_hyphens=False)]

    def _states(self) -> list[str]:
        """Return a row for each state or, if there are tables, for each kind of states."""
        tables = self._program.tables
        lines: list[str] = []
        for index in self._program.state_rows:
            state = self._fspa.states[index]
            values = (
                string_literal(str(state.label) if tables is None else ""),
                string_literal(label_text(self._fspa, index) if tables is None else ""),
                f"Verdict::{state.verdict.capitalize()}",
                snippets.boolean_literal(state.accepting),
                snippets.boolean_literal(self._program.ends[index]),
            )
            lines.append(f"place({', '.join(values)}),")
        return lines

    def _state_tables(self, tables: StateTables | None) -> dict[str, str]:
        """Return the pieces of the template with the tables of states; they are empty if there are none."""
        if tables is None:
            names = ("tables", "label_macros", "labels", "english_macros", "english_labels", "kind_count")
            return dict.fromkeys(names, "")
        lines: list[str] = []
        for name, numbers in tables.step_tables(self._fspa.judge).items():
            type_ = "f64" if name == "level_progress" else "u16" if max(numbers) < 1 << 16 else "u32"
            items = RustPrinter.items([*map(repr, numbers)])
            lines.append(f"static {name.upper()}: [{type_}; {len(numbers)}] = [{items}];")
        (macros, labels), (english_macros, english) = map(_shared_labels, (tables.labels, tables.labels_english))
        return {
            "tables": "\n".join(lines),
            "label_macros": macros,
            "labels": labels,
            "english_macros": english_macros,
            "english_labels": english,
            "kind_count": str(len(tables.kind_states)),
        }

    def _failures(self) -> list[str]:
        """Return a row for each pair of a clause and an atom that a step can fail at."""
        return [
            f"({', '.join('None' if text is None else f'Some({string_literal(text)})' for text in texts)}),"
            for texts in snippets.failure_texts(self._program)
        ]

    def _sample(self, bool_: str) -> list[str]:
        """Return the fields of a sample in which numbers are missing, and bools have the value ``bool_``."""
        return [
            f"{name}: {bool_ if signal.type == 'bool' else 'f64::NAN'},"
            for signal, name in zip(self._fspa.signals, self._program.signals, strict=True)
        ]

    def _give(self) -> list[str]:
        """Return the body of a generated function that sets one signal, given its index: a case for each signal."""
        if not self._fspa.signals:
            return []
        lines = ["match signal {"]
        for index, (signal, name) in enumerate(zip(self._fspa.signals, self._program.signals, strict=True)):
            if signal.type == "bool":
                lines.append(f"{_INDENT}{index} if value != 0.0 && value != 1.0 => return false,")
            value = "Some(value == 1.0)" if signal.type == "bool" else "value"
            lines.append(f"{_INDENT}{index} => sample.{name} = {value},")
        return [*lines, f"{_INDENT}_ => {{}}", "}", "true"]

    # --- a step -----------------------------------------------------------------------------------

    def _read(self) -> list[str]:
        used = self._program.variables_used
        lines: list[str] = []
        for index, (signal, name) in enumerate(zip(self._fspa.signals, self._program.signals, strict=True)):
            if signal.type == "bool":
                lines.append(f"self.given({index}, sample.{name})?;")
                continue
            low, high = (
                snippets.number_literal(signal.low, "f64::NEG_INFINITY"),
                snippets.number_literal(signal.high, "f64::INFINITY"),
            )
            head = f"let {name} = " if name in used else ""
            lines.append(f"{head}self.read({index}, sample.{name}, {low}, {high})?;")
        lines += self._bools(None)
        lines += [f"let {name} = self.params.{name};" for name in self._program.params if name in used]
        for index, name in enumerate(self._program.before):
            test = " > 0.0" if name in self._program.booleans else ""
            lines += [f"let {name} = self.registers[{index}]{test};"] if name in used else []
        return lines

    def _bools(self, case: int | None) -> list[str]:
        """Return the code that converts bool signals to the numbers 0 and 1.

        It converts the signals that only this case reads or, if ``case`` is None, those that every
        step reads.
        """
        names = self._program.bools_read_in(case)
        booleans = self._program.booleans
        return [
            f"let {name} = sample.{name} == Some(true);"
            if name in booleans
            else f"let {name} = if sample.{name} == Some(true) {{ 1.0 }} else {{ 0.0 }};"
            for name in names
        ]

    def _value(self, index: int) -> list[str]:
        program_ = self._program
        self._printer.atom = index
        lines = self._printer.comment(program_.atom_comments[index])
        statements = with_declaration(program_.atoms[index], program_.values[index], changes=False)
        return [*lines, *self._printer.lines(statements)]

    def _range_check(self, index: int) -> list[str]:
        name = self._program.atoms[index]
        head = f"let {name} = " if name in self._used else ""
        return [f"{head}self.keep({index}, {name})?;"]

    def _register(self, index: int) -> list[str]:
        program_, name = self._program, self._program.registers[index]
        self._printer.atom = len(program_.atoms) + index
        lines = self._printer.comment(program_.register_comments[index])
        lines += self._printer.lines(with_declaration(name, program_.updates[index], changes=False))
        if not program_.always_finite[index]:
            refusal = f"return Err(self.refuse(Problem::TooLarge, {self._printer.atom}));"
            lines += [f"if !{name}.is_finite() {{", f"{_INDENT}{refusal}", "}"]
        return lines

    def _check(self) -> list[str]:
        lines: list[str] = []
        for index, group in self._program.exclusive:
            tests = [f"{self._program.atoms[atom]} > 0.0" for atom in group]
            lines.append(f"if {' + '.join(f'u32::from({test})' for test in tests)} > 1 {{")
            lines += [f"{_INDENT}return Err(self.together({index}, &[{', '.join(tests)}]));", "}"]
        return lines

    def _move(self) -> list[str]:
        lines = [f"let mut {states.TARGET} = self.state;", f"let mut {states.LIMITING}: isize = -1;"]
        lines.append(f"let mut {states.ROBUSTNESS} = 0.0;")
        lines += [f"let mut {states.PROGRESS} = 0.0;"] if self._fspa.judge == "goal" else []
        has_tables = self._program.tables is not None
        lines += [f"let {states.FIRST_EDGE} = FIRST_EDGES[self.state] as usize;"] if has_tables else []
        lines.append("match STATE_SHAPES[self.state] {" if has_tables else "match self.state {")
        for number, case in enumerate(self._program.cases):
            lines += [f"{_INDENT}{line}" for line in self._printer.comment(case.comment)]
            lines.append(f"{_INDENT}{number} => {{")
            lines += [f"{_INDENT * 2}{line}" for line in (*self._bools(number), *self._values(number))]
            statements = states.with_failed_step(case.statements, ProgramVariable(reward_step.STEPS))
            lines += [*self._printer.lines(statements, depth=2), f"{_INDENT}}}"]
        return [*lines, f"{_INDENT}_ => {{}}", "}"]

    def _judge(self) -> list[str]:
        used = variables_read(self._program.reward_statements)
        verdict = "entered.verdict"
        lines = [f"let entered = &STATES[{states.TARGET}];"]
        changes = "mut " if reward_step.BEST in used else ""
        lines += [f"let {changes}{reward_step.BEST} = self.progress;", f"let mut {reward_step.DONE} = self.done;"]
        # The variable is mutable if penalties may be subtracted from the reward.
        lines.append(f"let {'' if self._fspa.limit_steps is None else 'mut '}{reward_step.REWARD};")
        declarations = {
            reward_step.STEPS_REAL: f"let {reward_step.STEPS_REAL} = {reward_step.STEPS} as f64;",
            reward_step.ENDS: f"let {reward_step.ENDS} = entered.ends;",
            reward_step.VIOLATED: f"let {reward_step.VIOLATED} = {verdict} == Verdict::Violated;",
            reward_step.SATISFIED: f"let {reward_step.SATISFIED} = {verdict} == Verdict::Satisfied;",
        }
        lines += [line for name, line in declarations.items() if name in used]
        return [*lines, *self._printer.lines(self._program.reward_statements)]

    def _remember(self) -> list[str]:
        values = [self._printer.text(value, CHOICE) for value in self._program.kept]
        return [f"self.registers = [{RustPrinter.items(values)}];"] if values else []


# --- pieces ---------------------------------------------------------------------------------------


def _type(signal: Signal) -> str:
    return "Option<bool>" if signal.type == "bool" else "f64"


def _shared_labels(labels: LabelTexts) -> tuple[str, str]:
    """Return the labels of all states as items, after the macros of the texts that several of them share."""
    numbers, items = iter(labels.numbers), []
    for place in labels.state_texts:
        first, *rest = labels.texts[place]
        arguments = ", ".join(str(next(numbers)) for _ in rest)
        items.append(f"l{place}!({arguments})" if rest else string_literal(first))
    macros: list[str] = []
    for place, (first, *rest) in enumerate(labels.texts):
        if not rest:
            continue
        names = [f"$n{number}" for number in range(len(rest))]
        pieces = [f"{name}, {string_literal(text)}" for name, text in zip(names, rest, strict=True)]
        arguments = ", ".join(f"{name}:literal" for name in names)
        text = f"concat!({string_literal(first)}, {', '.join(pieces)})"
        macros.append(f"macro_rules! l{place} {{ ({arguments}) => {{ {text} }} }}")
    return RustPrinter.block(macros), RustPrinter.items(items, 1)


def _fields(fields: Sequence[tuple[str, str, Signal | Param]]) -> str:
    """Return the fields of a struct, each after its documentation."""
    lines: list[str] = []
    for name, type_, declared in fields:
        lines += [f"/// {line}" for line in markdown_lines(snippets.field_comment(name, declared))]
        lines.append(f"pub {name}: {type_},")
    return RustPrinter.block(lines, 1)


def _param_check(param: Param, name: str) -> list[str]:
    value = f"params.{name}"
    tests = [f"{value}.is_finite()", *snippets.range_tests(value, param)]
    low, high = (
        snippets.number_literal(param.low, "f64::NEG_INFINITY"),
        snippets.number_literal(param.high, "f64::INFINITY"),
    )
    test = f"!({' && '.join(tests)})" if tests[1:] else f"!{tests[0]}"
    wrong = f"WrongParam {{ name: {string_literal(param.name)}, value: {value}, low: {low}, high: {high} }}"
    return [f"if {test} {{", f"{_INDENT}return Err({wrong});", "}"]
