"""The places where a player can stand, and the routes between them."""

from __future__ import annotations

from itertools import pairwise
from math import dist, isinf

import numpy as np
import pytest

from tltl_runtime.stealth.expert.routes import Leg, Routes, routes_of
from tltl_runtime.stealth.expert.surfaces import Surfaces
from tltl_runtime.stealth.levels.file import load_level

START, S2, EXIT = (2.0, 8.0, 0.0), (12.6, 8.3, 1.5), (9.0, 6.2, 0.0)


def test_a_place_has_ground_and_room() -> None:
    surfaces = Surfaces(load_level("navigation"))
    under_lintel, on_platform, in_wall = (7.4, 2.6, 0.0), (20.4, 9.4, 1.5), (9.8, 3.2, 0.0)
    places = [surfaces.nearest(point) for point in (under_lintel, on_platform, in_wall)]
    assert [surfaces.standing.flat[place] for place in places] == [False, True, True]
    assert dist(surfaces.point(places[0]), under_lintel) < 0.2
    assert dist(surfaces.point(places[1]), on_platform) < 0.2
    assert dist(surfaces.point(places[2]), in_wall) > 0.5
    shut = Surfaces(load_level("navigation"), [0])
    assert dist(shut.point(shut.nearest(under_lintel)), under_lintel) > 0.5


@pytest.mark.parametrize(("variant", "there"), [("v0", True), ("v1", True), ("v2", False)])
def test_a_route_leads_to_the_second_switch_of_navigation_except_in_v2(variant: str, there: bool) -> None:
    routes = routes_of(load_level("navigation", variant), frozenset({1}))
    seconds = routes.field(S2).seconds_from(*(np.array([value]) for value in START))
    assert isinf(seconds[0]) is not there


def test_a_route_has_legs_of_several_kinds() -> None:
    level = load_level("navigation")
    up = routes_of(level, frozenset({1})).field(S2).legs(START)
    assert {leg.kind for leg in up} == {"walk", "crouch", "climb", "drop", "leap"}
    (leap,) = (index for index, leg in enumerate(up) if leg.kind == "leap")
    assert up[leap - 1].place[0] > 17.0 and up[leap].place[0] < 15.2
    down = routes_of(level, frozenset()).field(EXIT).legs(S2)
    (fall,) = (leg for leg in down if leg.kind != "walk")
    assert fall.kind in ("drop", "leap") and fall.place[2] == 0.0


def test_a_route_can_be_cut_at_a_length() -> None:
    field = routes_of(load_level("navigation"), frozenset({1})).field(S2)
    whole, piece = field.legs(START), field.legs(START, 3.0)
    assert whole[: len(piece)] == piece
    assert 2.5 < _length(piece) < 5.5 < _length(whole)


def test_without_a_route_the_field_leads_to_the_nearest_place() -> None:
    routes = routes_of(load_level("navigation", "v2"), frozenset({1}))
    end = routes.field_from(START, S2).legs(START)[-1].place
    assert 11.0 < end[0] < 11.5


def _length(legs: tuple[Leg, ...]) -> float:
    return sum(dist(start.place, end.place) for start, end in pairwise(legs))


def test_a_moving_goal_keeps_a_bounded_number_of_fields(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("tltl_runtime.stealth.expert.routes._MOST_CACHED", 2)
    routes = Routes(load_level("navigation"), frozenset())
    first = routes.field(EXIT)
    assert routes.field(EXIT) is first
    for x in (2.0, 2.5):
        routes.field((x, 8.0, 0.0))
    assert routes.field(EXIT) is not first
    assert routes.field(EXIT).seconds.tolist() == first.seconds.tolist()
