"""The predicates of the standard library agree with values that are computed by hand."""

from __future__ import annotations

from math import isclose, pi, tanh

import pytest

from tests.resolve.helpers import only_spec, robustness_of


@pytest.mark.parametrize(
    ("use", "signals", "expected"),
    [
        # above: clamp((x - threshold) / margin)
        ("above(x, 50, 25)", {"x": 50}, 0.0),
        ("above(x, 50, 25)", {"x": 60}, 0.4),
        ("above(x, 50, 25)", {"x": 100}, 1.0),
        ("above(x, 50, 25)", {"x": 0}, -1.0),
        ("below(x, 50, 25)", {"x": 60}, -0.4),
        ("below(x, 50, 25)", {"x": 40}, 0.4),
        ("between(x, 20, 60)", {"x": 40}, 1.0),
        ("between(x, 20, 60)", {"x": 20}, 0.0),
        ("between(x, 20, 60)", {"x": 50}, 0.5),
        ("between(x, 20, 60)", {"x": 70}, -0.5),
        ("between(x, 20, 60)", {"x": 100}, -1.0),
        ("outside(x, 20, 60)", {"x": 40}, -1.0),
        ("outside(x, 20, 60)", {"x": 70}, 0.5),
        ("outside(x, 20, 60)", {"x": 100}, 1.0),
        ("about(x, 40, 10)", {"x": 40}, 1.0),
        ("about(x, 40, 10)", {"x": 45}, 0.5),
        ("about(x, 40, 10)", {"x": 30}, 0.0),
        ("about(x, 40, 10)", {"x": 0}, -1.0),
        ("more(x, 40, 10)", {"x": 50}, tanh(1)),
        ("more(x, 40, 10)", {"x": 40}, 0.0),
        ("less(x, 40, 10)", {"x": 35}, tanh(0.5)),
    ],
)
def test_values_of_core(use: str, signals: dict[str, float], expected: float) -> None:
    spec = only_spec(f"import core signal x in [0, 100] spec s = F {use}")
    assert isclose(robustness_of(spec, use, **signals), expected, abs_tol=1e-12)


BOX = "inside_box(0 m, 10 m, -2 m, 2 m, 0 m, 4 m)"


@pytest.mark.parametrize(
    ("use", "signals", "expected"),
    [
        # near, eq. 2 with close = 1 m, far = 20 m (level_size) or 10 m
        ("near(e)", {"distance(e)": 0}, 1.0),
        ("near(e)", {"distance(e)": 0.25}, 0.75),
        ("near(e)", {"distance(e)": 1}, 0.0),
        ("near(e)", {"distance(e)": 10.5}, -0.75),
        ("near(e)", {"distance(e)": 20}, -1.0),
        ("near(e)", {"distance(e)": 1e9}, -1.0),
        ("near(e, far = 10 m)", {"distance(e)": 5}, -56 / 81),
        ("near(e, close = 2 m, far = 10 m)", {"distance(e)": 6}, -0.75),
        ("inside_sphere(e, 4 m)", {"distance(e)": 1}, 0.75),
        ("inside_sphere(e, 4 m)", {"distance(e)": 4}, 0.0),
        ("inside_sphere(e, 4 m)", {"distance(e)": 6}, -0.5),
        ("inside_sphere(e, 4 m)", {"distance(e)": 40}, -1.0),
        ("inside_rectangle(0 m, 10 m, -2 m, 2 m)", {"position.x": 5, "position.y": 0}, 1.0),
        ("inside_rectangle(0 m, 10 m, -2 m, 2 m)", {"position.x": 9, "position.y": 1}, 0.2),
        ("inside_rectangle(0 m, 10 m, -2 m, 2 m)", {"position.x": 5, "position.y": 3}, -0.5),
        ("inside_rectangle(0 m, 10 m, -2 m, 2 m)", {"position.x": -90, "position.y": 0}, -1.0),
        (BOX, {"position.x": 5, "position.y": 0, "position.z": 2}, 1.0),
        (BOX, {"position.x": 5, "position.y": 0, "position.z": 4}, 0.0),
        (BOX, {"position.x": 5, "position.y": 1, "position.z": 3.5}, 0.25),
        (BOX, {"position.x": 5, "position.y": 0, "position.z": 5}, -0.5),
        ("facing(e)", {"bearing(e)": 0}, 1.0),
        ("facing(e)", {"bearing(e)": pi / 12}, 0.5),
        ("facing(e)", {"bearing(e)": -pi / 6}, 0.0),
        ("facing(e)", {"bearing(e)": pi}, -1.0),
        ("facing(e)", {"bearing(e)": -(pi / 6 + 5 * pi / 12)}, -0.5),
        ("line_of_sight(e)", {"line_of_sight(e)": 1}, 1.0),
        ("line_of_sight(e)", {"line_of_sight(e)": 0}, -1.0),
    ],
)
def test_values_of_spatial(use: str, signals: dict[str, float], expected: float) -> None:
    spec = only_spec(f"import spatial entity e spec s = F {use}")
    assert isclose(robustness_of(spec, spec.atoms[0].name, **signals), expected, abs_tol=1e-12)


@pytest.mark.parametrize("close", [0.5, 1.0, 1.5])
def test_near_is_minus_three_quarters_halfway(close: float) -> None:
    spec = only_spec(f"import spatial entity e spec s = F near(e, close = {close} m)")
    assert isclose(robustness_of(spec, spec.atoms[0].name, **{"distance(e)": (close + 20) / 2}), -0.75)


@pytest.mark.parametrize("distance", [1.0, 1.5, 3.0, 5.0, 8.25, 10.0])
def test_near_agrees_with_the_second_case_of_equation_2(distance: float) -> None:
    b, big = 1.0, 10.0
    printed = (distance**2 - 2 * big * distance + 2 * b * big - b**2) / (b - big) ** 2
    spec = only_spec("import spatial entity e spec s = F near(e, far = 10 m)")
    assert isclose(robustness_of(spec, "near(e, far=10)", **{"distance(e)": distance}), printed, abs_tol=1e-12)


@pytest.mark.parametrize(
    ("use", "signals", "expected"),
    [
        ("alive", {"health": 0.3}, 0.3),
        ("alive", {"health": 0}, 0.0),
        ("healthy", {"health": 0.75}, 0.5),
        ("healthy", {"health": 0.5}, 0.0),
        ("healthy", {"health": 0.1}, -0.8),
        ("healthy(20 %)", {"health": 0.6}, 0.5),
        ("healthy(20 %)", {"health": 0.1}, -0.5),
        ("hidden", {"seen": 0}, 1.0),
        ("hidden", {"seen": 1}, -1.0),
        ("covered", {"seen": 0, "visible": 0}, 1.0),
        ("covered", {"seen": 0, "visible": 1}, -1.0),
        ("sneaking", {"crouching": 1, "grounded": 1}, 1.0),
        ("sneaking", {"crouching": 1, "grounded": 0}, -1.0),
        ("before(60 s)", {"time": 15}, 0.75),
        ("before(60 s)", {"time": 60}, 0.0),
        ("before(60 s)", {"time": 90}, -0.5),
        ("before(60 s)", {"time": 600}, -1.0),
        ("active(e)", {"active(e)": 1}, 1.0),
        ("open(e)", {"open(e)": 0}, -1.0),
    ],
)
def test_values_of_stealth(use: str, signals: dict[str, float], expected: float) -> None:
    spec = only_spec(f"import stealth entity e spec s = F {use}")
    assert isclose(robustness_of(spec, spec.atoms[0].name, **signals), expected, abs_tol=1e-12)
