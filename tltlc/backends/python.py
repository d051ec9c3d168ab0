"""A stand-alone monitor in Python: one file, standard library only, one function per state.

It gives the same results to the last bit as :class:`tltlc.monitor.Monitor` with its default reward.
"""

from __future__ import annotations

import builtins
import keyword
import os
import re
from collections.abc import Sequence
from math import inf

from tltlc.automaton.fspa import Fspa
from tltlc.backends import Files, Options, Target
from tltlc.backends.code.states import INDENT, StateWriter
from tltlc.expression.python import Writer
from tltlc.program.names import Names, call, comment, in_docstring, literal, number
from tltlc.resolve.spec import Signal

TARGET = Target("python", "a stand-alone monitor in Python", ("_monitor.py",), ("py",))

# Names of the step function's own variables, and names that it reads from the module.
_RESERVED = (
    *keyword.kwlist,
    *dir(builtins),
    *("self", "signals", "state", "steps", "best", "done", "label", "verdict", "accepting", "ends", "progress"),
    *("reward", "robustness", "limiting", "nearest", "other", "failing", "error", "values", "main"),
    *("inf", "isfinite", "pow", "sqrt", "exp", "tanh", "csv", "json", "os", "sys", "chain"),
    *("Step", "Monitor", "MonitorError", "Callable", "Iterator", "Mapping", "NamedTuple"),
)


def emit(fspa: Fspa, options: Options) -> Files:
    """Return ``NAME_monitor.py``."""
    name = f"{fspa.name}_monitor.py"
    return {name: _Source(fspa, name).text()}


class _Source:
    """The source of one monitor: the names of its variables, and the pieces that fill the template."""

    def __init__(self, fspa: Fspa, file: str) -> None:
        self._fspa, self._file = fspa, file
        names = Names(_RESERVED)
        self._signals = {signal.name: names.give(signal.name) for signal in fspa.signals}
        self._params = {param.name: names.give(param.name, "param") for param in fspa.params}
        self._atoms = [names.give(atom.name, "atom") for atom in fspa.atoms]
        self._at_goal = fspa.judge == "goal"
        self._expressions = Writer(self._signals, self._params, "_", typed=True)
        self._states = StateWriter(fspa, self._atoms, self._at_goal)

    def text(self) -> str:
        """Return the whole file."""
        fspa = self._fspa
        step = "\n".join(f"{INDENT * 2}{line}" if line else "" for line in self._step())
        functions = [*self._expressions.parts, *(self._states.function(state.id) for state in fspa.states)]
        body = "\n\n\n".join(functions)
        pieces = {
            "title": in_docstring(f"Monitor of the specification `{fspa.name}`, written by tltlc."),
            "about": in_docstring("\n\n".join(filter(None, (fspa.doc, f"{INDENT}{fspa.formula.ascii}")))),
            "file": self._file,
            "step": step,
            "signals": _tuple([_signal(signal) for signal in fspa.signals]),
            "params": _dict(
                [
                    f"{literal(param.name)}: ({number(param.value)}, {_low(param.low)}, {_high(param.high)})"
                    for param in fspa.params
                ]
            ),
            "atoms": _tuple([literal(atom.name) for atom in fspa.atoms]),
            "exclusive": _tuple([_inline([str(atom) for atom in group]) for group in fspa.exclusive]),
            "returns": ", the progress of the step" if self._at_goal else "",
            "states": f"\n\n{body}\n",
            "result": self._states.result,
            "transitions": _tuple([f"_from_{state.id}" for state in fspa.states]),
            "table": _tuple([self._state(state.id) for state in fspa.states]),
        }
        used = [name for name in ("exp", "pow", "sqrt", "tanh") if re.search(rf"\b{name}\(", step + body)]
        used += ["inf"] if any(re.search(r"\binf\b", pieces[name]) for name in ("step", "signals", "params")) else []
        pieces["imports"] = f"from math import {', '.join(sorted([*used, 'isfinite']))}"
        return re.sub(r"@@(\w+)@@", lambda match: pieces[match[1]], _template())

    def _state(self, state: int) -> str:
        fspa_state = self._fspa.states[state]
        ends = fspa_state.verdict in ("satisfied", "violated") or (self._at_goal and fspa_state.accepting)
        return f"({literal(fspa_state.label.ascii)}, {literal(fspa_state.verdict)}, {fspa_state.accepting}, {ends})"

    # --- the step function --------------------------------------------------------------------

    def _step(self) -> list[str]:
        return [*self._read(), *self._compute(), *self._check(), *self._move(), *self._judge()]

    def _read(self) -> list[str]:
        """Return code that reads signals as floats in their ranges, and params, into variables."""
        if not self._signals:
            return [f"({', '.join(self._params.values())},) = self._params"] if self._params else []
        lines = ["try:"]
        lines += [f"{INDENT}{variable} = signals[{literal(name)}]" for name, variable in self._signals.items()]
        lines += ["except KeyError:", f"{INDENT}raise self._missing(signals) from None"]
        for index, signal in enumerate(self._fspa.signals):
            variable = self._signals[signal.name]
            checked = f"type({variable}) is not float or not {_within(signal, variable)}:"
            if signal.type == "bool":
                lines += [f"if type({variable}) is bool:", f"{INDENT}{variable} = 1.0 if {variable} else 0.0"]
                lines.append(f"elif {checked}")
            else:
                lines.append(f"if {checked}")
            lines.append(f"{INDENT}{variable} = self._number({index}, {variable})")
        if self._params:
            lines.append(f"({', '.join(self._params.values())},) = self._params")
        return lines

    def _compute(self) -> list[str]:
        """Return code for the atoms' values."""
        if not self._atoms:
            return []
        lines = ["failing = 0", "try:"]
        explained: set[str] = {""}
        for index, (atom, variable) in enumerate(zip(self._fspa.atoms, self._atoms, strict=True)):
            lines += [f"{INDENT}failing = {index}"] if index else []
            remark = atom.name if atom.doc in explained else f"{atom.name}: {atom.doc}"
            explained.add(atom.doc)
            lines += [f"{INDENT}{line}" for line in comment(remark)]
            lines += self._expressions.assignment(variable, atom.expression, INDENT)
        lines += [
            "except (ZeroDivisionError, OverflowError, ValueError) as error:",
            f"{INDENT}raise self._failed(failing, error) from None",
        ]
        for index, variable in enumerate(self._atoms):
            lines += [
                f"if not -1.0 <= {variable} <= 1.0:",
                f"{INDENT}{variable} = self._in_range({index}, {variable})",
            ]
        return lines

    def _check(self) -> list[str]:
        """Return code that checks exclusive atoms."""
        lines: list[str] = []
        for number_, group in enumerate(self._fspa.exclusive):
            atoms = [self._atoms[atom] for atom in group]
            if len(atoms) > 1:
                lines += [
                    f"if {_two_hold(atoms)}:",
                    f"{INDENT}raise self._together({number_}, {_inline(atoms)})",
                ]
        return lines

    def _move(self) -> list[str]:
        """Return code for the transition and the progress of this step alone."""
        results = "state, robustness, progress, limiting" if self._at_goal else "state, robustness, limiting"
        lines = [
            *call(f"{results} = _TRANSITIONS[self.state]", self._atoms),
            "label, verdict, accepting, ends = _STATES[state]",
            "steps = self.steps + 1",
        ]
        if self._at_goal:
            return lines
        limit = self._fspa.limit_steps
        survived = "0.0" if limit is None else f"min(steps, {limit}) / {limit}"
        otherwise = f'0.0 if verdict == "violated" else {survived}' if limit is not None else survived
        return [*lines, f'progress = 1.0 if verdict == "satisfied" else {otherwise}']

    def _judge(self) -> list[str]:
        """Return code for reward, best progress and the end of the episode (Algorithm 1)."""
        limit = self._fspa.limit_steps
        penalties = [
            f"{INDENT}reward -= 1 / {limit}",
            f'{INDENT}if verdict == "violated":',
            f"{INDENT * 2}reward -= ({limit} - steps) / {limit}",
        ]
        return [
            "best = self.progress",
            "reward = 0.0",
            "if progress > best:",
            f"{INDENT}reward = progress - best",
            f"{INDENT}best = progress",
            "done = self.done",
            "if done:",
            f"{INDENT}reward = 0.0",
            "else:",
            *(penalties if limit is not None else []),
            f"{INDENT}done = ends" + (f" or steps >= {limit}" if limit is not None else ""),
            "self.state = state",
            "self.steps = steps",
            "self.progress = best",
            "self.done = done",
            "# Adding 0 turns -0 into 0.",
            "values = (state, label, verdict, accepting, done, best, reward, robustness + 0.0, limiting)",
            "return tuple.__new__(Step, values)",
        ]


# --- pieces ---------------------------------------------------------------------------------------


def _within(signal: Signal, variable: str) -> str:
    """Return a test that a float is in the range of a signal; infinities and NaN fail it."""
    if signal.type == "bool":
        return f"({variable} == 0.0 or {variable} == 1.0)"
    low = f"-inf < {variable}" if signal.low is None else f"{number(signal.low)} <= {variable}"
    return f"{low} < inf" if signal.high is None else f"{low} <= {number(signal.high)}"


def _two_hold(atoms: Sequence[str]) -> str:
    """Return a test that two of the atoms hold, which is fast if none does."""
    if len(atoms) > 8:
        return f"sum(value > 0.0 for value in {_inline(atoms)}) > 1"
    tests = [f"{atom} > 0.0" for atom in atoms]
    later_tests = [" or ".join(tests[index + 1 :]) for index in range(len(tests) - 1)]
    pairs = [f"({test} and {f'({rest})' if ' or ' in rest else rest})" for test, rest in zip(tests, later_tests)]  # noqa: B905
    return " or ".join(pairs)


def _signal(signal: Signal) -> str:
    return f"({literal(signal.name)}, {signal.type == 'bool'}, {_low(signal.low)}, {_high(signal.high)})"


def _low(low: float | None) -> str:
    return "-inf" if low is None else number(low)


def _high(high: float | None) -> str:
    return number(inf if high is None else high)


def _inline(items: Sequence[str]) -> str:
    return f"({items[0]},)" if len(items) == 1 else f"({', '.join(items)})"


def _tuple(items: Sequence[str]) -> str:
    """Return a tuple, one item per line."""
    return "\n".join(["(", *(f"{INDENT}{item}," for item in items), ")"]) if items else "()"


def _dict(items: Sequence[str]) -> str:
    return "\n".join(["{", *(f"{INDENT}{item}," for item in items), "}"]) if items else "{}"


def _template() -> str:
    path = os.path.join(os.path.dirname(__file__), "templates", "monitor.py.txt")  # noqa: PTH118, PTH120 (as codes.py)
    with open(path, encoding="utf-8") as file:  # noqa: PTH123
        return file.read()
