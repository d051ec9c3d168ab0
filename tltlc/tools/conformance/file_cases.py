"""Cases whose specs are files: those of the paper, each with a recorded trace, and some of our own."""

from __future__ import annotations

import os
from functools import partial
from typing import Final

from tltlc.core.source import SourceFile
from tltlc.pipeline import CompileOptions, compile_source
from tltlc.tools.conformance.case import CaseBuilders, ConformanceCase
from tltlc.tools.conformance.draw import Draw
from tltlc.tools.conformance.traces import Pools, lively_trace, random_trace

_ABOUT: Final = {
    "cover_and_hide": "Formula (3) of the paper, with a recorded episode.",
    "navigation": "Formula (4) of the paper, with a recorded episode.",
    "branching": "Formula (5) of the paper, with a recorded episode.",
    "platform": "Ranges, comparisons, bounds in seconds.",
    "endure": "Judged at the limit.",
    "functions": "Every operator and function, as the language writes them.",
    "watch": "Over infinite traces, judged at the limit.",
    "errand": "Over infinite traces, judged at the goal.",
    "counting": "Six hundred states, most of which only count.",
    "counts": "How often something began.",
    "timers": "Times and windows of the trace so far.",
    "recall": "Numbers of earlier samples.",
    "past": "Past operators.",
    "recurring": "Memory over infinite traces.",
    "deadlines": "Deadlines beside memory of the trace so far.",
    "integers": "Integers, and values between them.",
    "enums": "Enums, and values that are none of theirs.",
}
_RECORDED: Final = ("cover_and_hide", "navigation", "branching", "counting")

_CLOSE: Final = (0.0, 0.5, 1.0, 3.0, 9.5, 20.0, 25.0)
_POOLS: Final[dict[str, Pools]] = {
    "cover_and_hide": {f"distance({x})": _CLOSE for x in ("s1", "s2", "exit")} | {"health": (0.2, 0.6, 1.0)},
    "navigation": {f"distance({x})": _CLOSE for x in ("s1", "s2", "exit")},
    "branching": {f"distance({x})": _CLOSE for x in ("s1", "s2", "s3", "e_right", "e_left")} | {"health": (0.5, 1.0)},
    "endure": {"health": (0.5, 0.7, 1.0, 1.2), "distance(guard)": (4.5, 6.0, 9.0), "distance(lamp)": (0.0, 5.0, 15.0)},
    "platform": {"speed": (1.0, 2.5, 5.5), "heading": (0.0, 1.0, -1.5), "height": (0.0, 11.0, 12.5)},
    "watch": {f"distance({x})": (0.25, 0.75, 1.0, 20.0, 61.0) for x in ("office", "north", "south")},
    "errand": {"fuel": (0.15, 0.5, 1.0)},
    "counting": {"noise": (0.0, 0.25, 0.5), "lever": (-1.0, 0.0, 0.125)},
    "timers": {"x": (-1.0, -0.5, 0.0, 0.25, 0.75, 1.0)},
    "recall": {"health": (50.0, 60.0, 65.0), "height": (-3.0, 0.0, 5.0, 80.0), "speed": (-1.0, 0.0, 0.5, 2.0)},
    "past": {"x": (-1.0, -0.6, -0.0, 0.0, 0.25, 1.0)},
    "recurring": {"x": (0.0, 1.0, 5.0, 9.5)},
    "integers": {
        "phase": (0.0, 1.0, 1.0, 2.4, 2.5, 3.0, 4.0, 4.0, 3.9999999, 5.0, 5.5, -1.0),
        "keys": (-2.0, 0.0, 1.5, 2.0, 3.0, 5.0, 1e6, 1000000.5),
        "combo": (-3.0, 0.0, 1.0, 2.0, 3.0, 3.49, 3.5, 1e15),
    },
    "enums": {
        "mode(g1)": (0.0, 0.0, 1.0, 2.0, 2.0, 1.4, 1.5, 3.0, -0.0),
        "mode(g2)": (0.0, 0.0, 1.0, 1.0, 2.0, 1.6, 2.5),
        "weather": (0.0, 0.0, 1.0, 0.5),
        "step": (0.0, 1.0, 2.0, 3.0, 3.0, 2.5, 4.0),
    },
    "deadlines": {"alarm": (0.0, 0.0, 0.0, 1.0), "hidden": (0.0, 1.0), "near": (-1.0, 0.0, 0.25, 1.0)},
}


def _case(number: int, name: str) -> ConformanceCase:
    text = _read(f"{name}.tltl").decode()
    (fspa,) = compile_source(SourceFile(f"{name}.tltl", text), CompileOptions(specs=(name,))).automata
    draw = Draw(7000 + number)
    traces = [lively_trace(fspa, draw, 40, _POOLS.get(name, {})), random_trace(fspa, draw, 20)]
    if name in _RECORDED:
        traces.insert(0, _read(f"{name}.csv"))
    return ConformanceCase(fspa, _ABOUT[name], tuple(traces), text)


def _read(name: str) -> bytes:
    with open(os.path.join(os.path.dirname(__file__), "specs", name), "rb") as file:  # noqa: PTH118, PTH120, PTH123
        return file.read()


CASES: Final[CaseBuilders] = {name: partial(_case, number, name) for number, name in enumerate(_ABOUT)}
