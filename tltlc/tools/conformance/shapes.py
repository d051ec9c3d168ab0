"""Cases with unusual automata or traces.

They have exclusive atoms, verdicts that are final at the start, names that are hard to quote, or
files in unusual notation.
"""

from __future__ import annotations

from functools import partial
from typing import Final

from tltlc.core.record import replace
from tltlc.expression.tree import Const, Expression, Op, ParamValue, SignalValue
from tltlc.logic import formula as f
from tltlc.resolve import spec
from tltlc.tools.conformance.case import CaseBuilders, ConformanceCase, automaton
from tltlc.tools.conformance.draw import Draw
from tltlc.tools.conformance.traces import random_trace, table

_VALUES: Final = (-1.0, -0.5, -0.25, 0.0, 0.25, 0.5, 1.0)


def _exclusive_case(name: str, count: int) -> ConformanceCase:
    """Return a case about ``count`` places, some of which must be visited in order.

    Each place has an atom, and the atoms are exclusive: the player is in at most one place at a time.
    """
    atoms = [f"at_{number}" for number in range(count)]
    order = f.atom(atoms[-1])
    for atom in reversed(atoms[:3]):
        order = f.then(f.atom(atom), order)
    formula = f.and_(order, *(f.not_(f.eventually(f.and_(f.atom(a), f.atom("alarm")))) for a in atoms[3:-1]))
    groups = [atoms] if count > 4 else [atoms, [atoms[0], "alarm"]]
    fspa = automaton(
        name, formula if count > 4 else f.and_(formula, f.always(f.not_(f.atom("alarm")))), exclusive=groups
    )
    fspa, draw = replace(fspa, limit_steps=30), Draw(3000 + count)
    names = [signal.name for signal in fspa.signals]
    quiet = [["0.75" if other == at else "-0.5" for other in names] for at in (*atoms[:3], "", atoms[-1])]
    clash = ["0.5" if other in (atoms[0], atoms[1]) else "0" for other in names]
    border = ["0.5" if other == atoms[0] else "0" for other in names]
    pools = dict.fromkeys(names, (-0.9, -0.5, -0.25, -0.0))
    traces = (
        table(names, [*quiet, *quiet]),
        table(names, [quiet[0], border, quiet[3], clash, quiet[1]]),
        random_trace(fspa, draw, 20, {**pools, atoms[0]: _VALUES, "alarm": (-1.0,)}),
    )
    return ConformanceCase(fspa, "At most one atom of a group holds at a time.", traces)


def _decided_case(name: str, formula: f.Formula, limit: int | None) -> ConformanceCase:
    """Return a case whose verdict is final before the first step."""
    fspa = automaton(name, f.and_(formula, f.or_(f.atom("a"), f.not_(f.atom("a")))), limit=limit)
    rows: list[list[object]] = [[0.5], [-0.5], [0], [1]]
    traces = (table([s.name for s in fspa.signals] or ["a"], rows),)
    return ConformanceCase(fspa, f"Decided before anything happens: {fspa.formula}.", traces)


def _one_step_case() -> ConformanceCase:
    fspa = automaton("one_step", f.or_(f.eventually(f.atom("a")), f.always(f.atom("b"))), limit=1)
    files: tuple[list[list[float]], ...] = ([[-0.5, -0.5], [1, 1]], [[-0.5, 0.5]] * 3, [[1, -1], [-1, -1]])
    traces = tuple(table(["a", "b"], rows) for rows in files)
    return ConformanceCase(fspa, "A limit of one step.", traces)


def _constants_case() -> ConformanceCase:
    expressions: dict[str, Expression] = {
        "a": SignalValue("x"),
        "b": Const(0.25),
        "c": Op("-", (ParamValue("p"), Const(0.5))),
    }
    formula = f.and_(f.eventually(f.and_(f.atom("a"), f.atom("b"))), f.always(f.not_(f.atom("c"))))
    signals = (spec.Signal("x", "number", -1.0, 1.0),)
    fspa = automaton("constants", formula, expressions, signals, (spec.Param("p", "number", 0.1, 0.0, 1.0),), limit=9)
    return ConformanceCase(fspa, "Atoms that no signal moves.", (random_trace(fspa, Draw(3100), 15),))


def _many_states_case() -> ConformanceCase:
    order = f.atom("g8")
    for number in range(7, 0, -1):
        order = f.then(f.atom(f"g{number}"), order)
    fspa = automaton("many_states", f.and_(order, f.always(f.atom("alive"))), limit=60)
    names = [signal.name for signal in fspa.signals]
    rows = []
    for number in range(1, 9):
        for share in (-0.8, -0.3, 0.6):
            held = {f"g{number}": share, "alive": 0.9}
            rows.append([held.get(name, -0.9) for name in names])
    draw = Draw(3200)
    pools = dict.fromkeys(names, (-0.9, -0.4, 0.3)) | {"alive": (0.5, 0.8, 1.0)}
    return ConformanceCase(fspa, "Eight goals in order.", (table(names, rows), random_trace(fspa, draw, 40, pools)))


# --- names ----------------------------------------------------------------------------------------


def _names_case(name: str, names: tuple[str, str, str]) -> ConformanceCase:
    """Return a case whose three atoms have names that are hard to quote.

    A generated monitor has these names in its code, reads them in traces, and prints them.
    """
    first, second, third = names
    formula = f.and_(f.eventually(f.and_(f.atom(first), f.next_(f.atom(second)))), f.always(f.atom(third)))
    fspa = replace(automaton(name, formula, limit=20), doc=f"{first} */ {second}\n\\ {third}")
    pools = {first: _VALUES, second: _VALUES, third: (0.25, 0.5, 0.75)}
    draw = Draw(3300 + len("".join(names)))
    return ConformanceCase(fspa, "Names that quote, comment and escape.", (random_trace(fspa, draw, 24, pools),))


_NAMES: Final = {
    "names_with_commas": ("distance(s1, s2)", "a,b,,c", ",d"),
    "names_with_quotes": ('say "hi"', '"', "it's \\\"n\\' '"),
    "names_in_unicode": ("höhe_µ", "漢字 ∧ ◇", "𝒰\U0001f600\u202egnihton\u202c"),
    "names_with_line_ends": ("two\nlines", 'one "quoted"\nand, more', "tail\\"),
    "names_of_code": ("*/ return; /*", "%s %d ${x} {0} #{y} ]] --", "??/"),
    "names_of_variables": ("step", "state", "best"),
}


# --- files ----------------------------------------------------------------------------------------


def _ranges_case() -> ConformanceCase:
    """Return a case with values out of range: monitors clamp them, and warn once for each signal."""
    expressions: dict[str, Expression] = {
        "near": Op("-", (Const(1.0), Op("/", (SignalValue("distance"), Const(4.0))))),
        "loud": Op("*", (Const(3.0), SignalValue("noise"))),
        "seen": Op("-", (Op("*", (Const(2.0), SignalValue("seen"))), Const(1.0))),
    }
    signals = (
        spec.Signal("distance", "length", 0.0, None),
        spec.Signal("noise", "number", None, 0.5),
        spec.Signal("seen", "bool", 0.0, 1.0),
    )
    formula = f.and_(f.eventually(f.and_(f.atom("near"), f.atom("loud"))), f.eventually(f.atom("seen")))
    fspa = automaton("ranges", formula, expressions, signals, limit=10)
    rows: list[list[object]] = [
        [5, -0.1, "false"],
        [-2, -0.25, 0],
        [9, -4, "true"],
        [-1, 0.2, 1],
        [3, 7, "false"],
        [1e300, -1e300, 0],
    ]
    return ConformanceCase(fspa, "Values outside their ranges.", (table(["distance", "noise", "seen"], rows),))


_GOOD: Final = ("0.5", "true")

_BAD_CELLS: Final = ("", "x", "0x10", "1_000", "1 2", "+-1", "1e", "1,5", ".", "--1", "1.5f", "tru", "0b1", "1d")
_INFINITE: Final = ("nan", "inf", "-inf", "1e400", "-1e999", "NaN", "Infinity")


def _cells_case() -> ConformanceCase:
    """Return a case with traces in several notations, some of which must be rejected."""
    expressions: dict[str, Expression] = {
        "a": SignalValue("x"),
        "b": Op("-", (Op("*", (Const(2.0), SignalValue("seen"))), Const(1.0))),
    }
    signals = (spec.Signal("x", "number", None, 1.0), spec.Signal("seen", "bool", 0.0, 1.0))
    formula = f.always(f.eventually(f.and_(f.atom("a"), f.atom("b"))))
    fspa = automaton("cells", formula, expressions, signals, limit=50)
    good = (
        b"\xef\xbb\xbfx,seen\r\n0.5,true\r\n-0.25,false\r\n",
        b'seen , x ,note\n\n 1, .5 ,"a, ""b""\nc"\n\n0 ,-5e-1,\n true, +0.125 ,?\nfalse,1.,\n"1" ,"-0",x\n'.replace(
            b'"1" ,', b'"1",'
        ),
        b'\n\n"x","seen"\n1E-1,1\n  \t0.1e+0\t ,0\n5e-324,true\n0.1000000000000000055511151231257827,1\n-1e-400,1',
    )
    start = ",".join(("x", "seen")) + "\n" + ",".join(_GOOD) + "\n" + "-0.5,0\n"
    bad = [f'{start}"{cell}",true\n0.1,1\n'.encode() for cell in (*_BAD_CELLS, *_INFINITE)]
    bad += [f"{start}0.1,{cell}\n0.1,1\n".encode() for cell in ("0.5", "yes", "2")]
    bad += [f"{start}{row}\n0.1,1\n".encode() for row in ("0.1", "0.1,1,2", '0.1,"1')]
    bad += [b"x\n0.5\n", b"seen,y\n1,1\n", b"x,seen,x\n1,1,1\n", b"x,seen\n", b"", b"\n\n"]
    return ConformanceCase(fspa, "Ways to write a trace, and cells that must be refused.", (*good, *bad))


CASES: Final[CaseBuilders] = {
    "exclusive_few": partial(_exclusive_case, "exclusive_few", 4),
    "exclusive_many": partial(_exclusive_case, "exclusive_many", 10),
    "never": partial(_decided_case, "never", f.FALSE, 5),
    "anything": partial(_decided_case, "anything", f.TRUE, None),
    "one_step": _one_step_case,
    "constants": _constants_case,
    "many_states": _many_states_case,
    **{name: partial(_names_case, name, names) for name, names in _NAMES.items()},
    "ranges": _ranges_case,
    "cells": _cells_case,
}
