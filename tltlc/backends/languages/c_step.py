"""Print what a step in C does before a transition: it reads the sample, and computes atoms and registers."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Mapping, Sequence
from functools import reduce
from textwrap import wrap

from tltlc.backends.languages.c_printer import CPrinter
from tltlc.program import snippets
from tltlc.program.arithmetic import with_declaration
from tltlc.program.build import Program
from tltlc.program.tree import FAILING, ProgramExpression
from tltlc.program.used_names import functions_called
from tltlc.program.verdict_step import VerdictStep
from tltlc.resolve.spec import Signal

_INDENT = CPrinter.INDENT


class StepCode:
    """Prints the code of a step, which is that of ``program`` or, if there is a ``verdict_step``, this one."""

    def __init__(self, program: Program, printer: CPrinter, verdict_step: VerdictStep | None = None) -> None:
        self._program, self._printer, self._prefix = program, printer, program.fspa.name
        self._every_step = (verdict_step or program).every_step
        self._values, self._updates = (verdict_step or program).values, (verdict_step or program).updates

    # --- the sample -------------------------------------------------------------------------------

    def numbers(self) -> list[str]:
        """Return the code that reads the signals that are numbers, clamped to their ranges, and checks all signals."""
        signals = list(zip(self._program.fspa.signals, self._program.signals, strict=True))
        lines = [f"double {name} = sample->{name};" for signal, name in signals if signal.type != "bool"]
        return [*lines, *self._checked_reads(signals)] if signals else []

    def bools(self, names: Iterable[str], booleans: Collection[str]) -> list[str]:
        """Return the code that reads bool signals: the variables in ``booleans`` as bools, the others as 0 or 1."""
        return [
            f"const bool {name} = sample->{name} != 0;"
            if name in booleans
            else f"const double {name} = sample->{name} ? 1.0 : 0.0;"
            for name in names
        ]

    def params(self, used: Collection[str]) -> list[str]:
        """Return the code that reads the params among the variables that are used."""
        return [f"const double {name} = monitor->params.{name};" for name in self._program.params if name in used]

    def _checked_reads(self, signals: Sequence[tuple[Signal, str]]) -> list[str]:
        """Return the code that checks and clamps signals.

        One test for all signals comes first. Only if it fails are the signals checked one by one.
        """
        tests = self._range_tests([(signal, name) for signal, name in signals if signal.type != "bool"])
        bools = [f"sample->{name}" for signal, name in signals if signal.type == "bool"]
        tests += [f"{self._prefix}_given_({' | '.join(bools)})"] if bools else []
        lines = _wrapped(f"if (!({' && '.join(tests)})) {{")
        for index, (signal, name) in enumerate(signals):
            if signal.type == "bool":
                lines.append(f"{_INDENT}if ({self._prefix}_unset_(monitor, {index}, sample->{name})) return false;")
                continue
            low, high = (
                snippets.number_literal(signal.low, "-HUGE_VAL"),
                snippets.number_literal(signal.high, "HUGE_VAL"),
            )
            lines.append(f"{_INDENT}{name} = {self._prefix}_read_(monitor, {index}, {low}, {high}, {name});")
            lines.append(f"{_INDENT}if (monitor->problem) return false;")
        return [*lines, "}"]

    def _range_tests(self, numbers: Sequence[tuple[Signal, str]]) -> list[str]:
        """Return C expressions that are all true only if every signal is finite and in its range.

        Signals that lack a bound are tested by their sum, which is finite only if all of them are.
        If the sum of finite values overflows, the test fails, although the signals are valid. Then
        they are checked one by one.
        """
        bounded: list[str] = []
        least: dict[float, list[str]] = {}
        greatest: dict[float, list[str]] = {}
        summed: list[str] = []
        for signal, name in numbers:
            low, high = signal.low, signal.high
            if low is not None and high is not None:
                bounded += [f"{name} >= {snippets.number_literal(low)}", f"{name} <= {snippets.number_literal(high)}"]
                continue
            summed.append(name)
            if low is not None:
                least.setdefault(low, []).append(name)
            if high is not None:
                greatest.setdefault(high, []).append(name)
        tests = [f"{self._fold('min', names)} >= {snippets.number_literal(low)}" for low, names in least.items()]
        tests += [f"{self._fold('max', names)} <= {snippets.number_literal(high)}" for high, names in greatest.items()]
        tests += [f"isfinite({' + '.join(summed)})"] if summed else []
        return tests + bounded

    def _fold(self, function: str, names: Sequence[str]) -> str:
        return reduce(lambda left, right: f"{self._prefix}_{function}_({left}, {right})", names)

    # --- atoms and registers ----------------------------------------------------------------------

    def compute(self) -> list[str]:
        """Return the code that computes the atoms, clamped to [-1, 1], and the registers that every step needs."""
        program_ = self._program
        lines: list[str] = []
        later: list[str] = []
        for step in self._every_step:
            if step.kind == "register":
                lines += self._register(step.index)
                continue
            name = program_.atoms[step.index]
            lines += self.value(step.index)
            if not program_.always_in_range[step.index]:
                check = [
                    f"if (!(fabs({name}) <= 1.0)) {{",
                    f"{_INDENT}{name} = {self._prefix}_value_(monitor, {step.index}, {name});",
                    *(f"{_INDENT}if (monitor->problem) return false;", "}"),
                ]
                (lines if program_.registers else later).extend(check)
        return [*lines, *later]

    def value(self, index: int) -> list[str]:
        """Return the code that computes the value of an atom, given its index."""
        statements = with_declaration(self._program.atoms[index], self._values[index])
        lines = self._printer.comment(self._program.atom_comments[index])
        lines += self._printer.lines(statements)
        if functions_called(statements) & FAILING:
            lines += ["if (monitor->problem) {", *self._refusal("monitor->problem", index), "}"]
        return lines

    def _register(self, index: int) -> list[str]:
        """Return the code that computes the value of a register after the sample, given its index."""
        program_, place = self._program, len(self._program.atoms) + index
        name = program_.registers[index]
        statements = with_declaration(name, self._updates[index], changes=False)
        lines = self._printer.comment(program_.register_comments[index])
        lines += self._printer.lines(statements)
        if functions_called(statements) & FAILING:
            lines += ["if (monitor->problem) {", *self._refusal("monitor->problem", place), "}"]
        if not program_.always_finite[index]:
            lines += [f"if (!isfinite({name})) {{", *self._refusal(f"{self._prefix}_too_large", place), "}"]
        return lines

    def check(self, groups: Iterable[tuple[int, Mapping[int, ProgramExpression]]]) -> list[str]:
        """Return the code that ends a step with an error if two atoms of a group hold together.

        Each group has the index of an ``exclusive``, and the test of each of its atoms.
        """
        lines: list[str] = []
        for index, group in groups:
            tests = {atom: self._printer.text(test) for atom, test in group.items()}
            lines.append(f"if ({' + '.join(f'({test})' for test in tests.values())} > 1) {{")
            lines += [f"{_INDENT}monitor->holding[{atom}] = {test};" for atom, test in tests.items()]
            lines += [*self._refusal(f"{self._prefix}_together", index), "}"]
        return lines

    def _refusal(self, problem: str, index: int) -> list[str]:
        return refusal(self._prefix, problem, index)


def refusal(prefix: str, problem: str, index: int) -> list[str]:
    """Return the C lines that refuse a sample or params: they record the problem and return false.

    ``problem`` is the name of the problem in C, and ``index`` the index of the param, atom or
    exclusive group with the problem. Registers count from the number of atoms on. These lines
    contain the ``return``, and not the function that records the problem, so that compilers see
    that the step ends here.
    """
    call = f"{prefix}_refuse_(monitor, {problem}, {index});"
    return [f"{_INDENT}{line}" for line in (call, "return false;")]


def _wrapped(line: str) -> list[str]:
    """Break a line that begins with ``if (!(`` into lines of about 100 characters."""
    return wrap(line, 100, subsequent_indent=" " * len("if (!("), break_long_words=False, break_on_hyphens=False)
