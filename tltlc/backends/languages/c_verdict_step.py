"""Print the parts of a monitor in C for ``TLTL_VERDICT_ONLY``, which finds only state and verdict."""

from __future__ import annotations

from tltlc.backends.languages.c_printer import CPrinter
from tltlc.backends.languages.c_step import StepCode
from tltlc.program import snippets, states
from tltlc.program.build import Program
from tltlc.program.verdict_step import KeptRegister, VerdictStep, verdict_step

_INDENT = CPrinter.INDENT


def verdict_pieces(program: Program, printer: CPrinter) -> dict[str, str]:
    """Return the pieces of the template by their names: fields and starts of registers, and the code of a step."""
    step = verdict_step(program)
    code = StepCode(program, printer, step)
    read = code.bools(step.bools, [name for name, type_ in step.bools.items() if type_ == "bool"])
    if not program.fspa.signals:
        read = ["(void)sample;"]
    read += code.params(step.variables_used)
    read += [
        f"const {printer.TYPES[register.type]} {register.before} = monitor->memory.{register.before};"
        for register in step.kept
    ]
    move = _move(step, code, printer, has_tables=program.tables is not None)
    keep = [f"monitor->memory.{register.before} = {register.now};" for register in step.kept]
    lines = snippets.paragraphs(read, code.compute(), code.check(step.exclusive), move, keep)
    return {
        "verdict_fields": printer.block(
            [printer.field(register.type, register.before) for register in step.kept] or ["bool none;"], 2
        ),
        "verdict_starts": printer.block(
            [f"monitor->memory.{register.before} = {_start(register)};" for register in step.kept]
        ),
        "verdict_step": printer.block(lines),
    }


def _move(step: VerdictStep, code: StepCode, printer: CPrinter, *, has_tables: bool) -> list[str]:
    lines = [f"int {states.TARGET} = monitor->state;"]
    lines += [f"const int {states.FIRST_EDGE} = first_edges[monitor->state];"] if has_tables else []
    lines.append("switch (state_shapes[monitor->state]) {" if has_tables else "switch (monitor->state) {")
    for number, case in enumerate(step.cases):
        lines += [f"{_INDENT}case {state}:" for state in case.numbers[:-1]]
        lines.append(f"{_INDENT}case {case.numbers[-1]}: {{")
        lines += [f"{_INDENT * 2}{line}" for index in step.computed_in(number) for line in code.value(index)]
        lines += printer.lines(case.statements, depth=2)
        lines += [f"{_INDENT * 2}break;", f"{_INDENT}}}"]
    return [*lines, "}"]


def _start(register: KeptRegister) -> str:
    if register.type == "bool":
        return snippets.boolean_literal(register.initial > 0.0)
    return str(int(register.initial)) if register.type == "int" else snippets.number_literal(register.initial)
