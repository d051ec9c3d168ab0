"""The data of a case that the page's scripts draw, as JSON."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, Final

from tltl_runtime.game.geometry import Box
from tltl_runtime.regression.explain.account import Account
from tltl_runtime.regression.report.page.contents import ReportedCase
from tltl_runtime.regression.report.page.heat import Heat, failed_ends, time_spent
from tltl_runtime.regression.report.page.packing import across, down, runs
from tltl_runtime.regression.report.page.stealth.level_map import map_data
from tltl_runtime.regression.report.page.stealth.recorded import recorded
from tltlc.api import label_text

_FINE_CM: Final = 5
"""The resolution of trajectories, in centimetres.  There are many, and at this resolution a step takes one letter."""


def case_data(case: ReportedCase, slug: str) -> dict[str, Any] | None:
    """The data that is drawn on the map and the automaton of a case; None if it has no level or automaton."""
    level, fspa = case.level, case.fspa
    if level is None or fspa is None:
        return None
    return {
        "slug": slug,
        "map": map_data(level),
        "states": [label_text(fspa, state.id) for state in fspa.states],
        "now": _all_of(level.bounds, case.report.accounts),
        "before": _all_of((case.designed or level).bounds, case.before),
        "episodes": [recorded(index, case.episodes[index]) for index in sorted(case.episodes)],
    }


def _all_of(bounds: Box, accounts: Sequence[Account]) -> dict[str, Any]:
    return {
        "ways": [_way(bounds, account) for account in accounts],
        "time": _heat(time_spent(bounds, accounts)),
        "failed": _heat(failed_ends(bounds, accounts)),
    }


def _way(bounds: Box, account: Account) -> dict[str, Any]:
    """The trajectory of an episode on the map, and how it ended."""
    place = account.place
    return {
        "index": account.summary.index,
        "unit": _FINE_CM,
        "end": account.summary.end,
        "cause": account.cause,
        "by": list(account.by),
        "x": across(bounds, [x for x, *_ in account.way], _FINE_CM),
        "y": down(bounds, [y for _, y, *_ in account.way], _FINE_CM),
        "state": runs(state for *_, state, _ in account.way),
        "place": [across(bounds, place[:1]), down(bounds, place[1:2])],
    }


def _heat(heat: Heat) -> dict[str, Any]:
    return {
        "cell": round(100 * heat.cell),
        "columns": heat.columns,
        "cells": [number for pair in heat.values for number in pair],
        "most": max((value for _, value in heat.values), default=0),
    }
