from __future__ import annotations

import numpy as np
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from tltl_runtime.stealth.enemies.segments import Corners, crosses, is_blocked
from tltl_runtime.stealth.level import Point

POINTS = st.tuples(*[st.floats(-5, 5).map(lambda x: round(x, 2))] * 3)


def around(c: Point, d: Point) -> Corners:
    return (min(c[0], d[0]), min(c[1], d[1]), min(c[2], d[2]), max(c[0], d[0]), max(c[1], d[1]), max(c[2], d[2]))


def exact_length(a: np.ndarray, b: np.ndarray, box: Corners) -> float:
    """Return the fraction of the segment inside the box, from all six planes at once; not positive if it misses."""
    low, high = np.array(box[:3]), np.array(box[3:])
    delta = b - a
    with np.errstate(divide="ignore", invalid="ignore"):
        times = np.stack([(low - a) / delta, (high - a) / delta])
    still = delta == 0
    outside = still & ((a <= low) | (a >= high))
    if outside.any():
        return -1.0
    times[:, still] = [[-np.inf], [np.inf]]
    return float(min(1.0, times.max(axis=0).min()) - max(0.0, times.min(axis=0).max()))


@settings(max_examples=300, deadline=None)
@given(POINTS, POINTS, POINTS, POINTS)
def test_sight_is_blocked_exactly_if_the_segment_crosses_a_box(a: Point, b: Point, c: Point, d: Point) -> None:
    box = around(c, d)
    assume(all(box[i] < box[i + 3] for i in range(3)))
    length = exact_length(np.array(a), np.array(b), box)
    assume(abs(length) > 1e-9 or a == b)
    if a != b:
        assert is_blocked(a, b, [box]) == (length > 0)
        assert is_blocked(b, a, [box]) == (length > 0)


@settings(max_examples=200, deadline=None)
@given(POINTS, POINTS, POINTS, POINTS)
def test_walking_is_blocked_like_sight_without_heights(a: Point, b: Point, c: Point, d: Point) -> None:
    box = around(c, d)
    assume(box[0] < box[3] and box[1] < box[4])
    flat = (box[0], box[1], -1.0, box[3], box[4], 1.0)
    rectangle = (box[0], box[1], box[3], box[4])
    assert crosses(a[0], a[1], b[0], b[1], [rectangle]) == is_blocked((*a[:2], 0.0), (*b[:2], 0.0), [flat])


def test_touching_a_face_or_an_edge_is_not_blocked() -> None:
    box: Corners = (1.0, 1.0, 1.0, 2.0, 2.0, 2.0)
    assert not is_blocked((0.0, 1.0, 1.5), (3.0, 1.0, 1.5), [box])
    assert is_blocked((0.0, 1.5, 1.5), (3.0, 1.5, 1.5), [box])
    assert not is_blocked((0.0, 1.5, 1.5), (0.9, 1.5, 1.5), [box])
