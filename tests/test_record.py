"""Records behave like frozen dataclasses with slots."""

from __future__ import annotations

import pickle

import pytest

from tltlc.core.record import EMPTY, record, replace


@record
class Point:
    """A point."""

    x: int
    y: int = 2

    @property
    def total(self) -> int:
        """The sum."""
        return self.x + self.y


@record
class Other:
    """The same fields, another class."""

    x: int
    y: int = 2


@record
class Nothing:
    """No fields."""


def test_fields_are_set_by_position_name_or_default() -> None:
    assert (Point(1).x, Point(1).y, Point(1, 3).y, Point(y=4, x=1).total) == (1, 2, 3, 5)
    assert repr(Point(1)) == "Point(x=1, y=2)"


@pytest.mark.parametrize(
    ("positional", "keywords", "message"),
    [
        ((), {}, "Point lacks x"),
        ((1, 2, 3), {}, "Point takes 2 values, 3 were given"),
        ((1,), {"x": 2}, "Point has two values for field x"),
        ((1,), {"z": 2}, "Point has no field z"),
    ],
)
def test_wrong_arguments_are_an_error(positional: tuple[int, ...], keywords: dict[str, int], message: str) -> None:
    with pytest.raises(TypeError, match=message):
        Point(*positional, **keywords)


def test_equality_and_hash_are_by_class_and_fields() -> None:
    assert Point(1) == Point(1, 2)
    assert Point(1) != Point(2)
    assert Point(1) != Other(1)
    assert len({Point(1), Point(1, 2), Other(1)}) == 2
    assert Nothing() == Nothing()


def test_records_cannot_be_changed() -> None:
    point = Point(1)
    with pytest.raises(AttributeError, match="cannot be changed"):
        point.x = 2  # type: ignore[misc]
    with pytest.raises(AttributeError, match="cannot be changed"):
        del point.x
    with pytest.raises(AttributeError):
        point.z = 2  # type: ignore[attr-defined]


def test_records_can_be_replaced_pickled_and_matched() -> None:
    assert replace(Point(1), y=5) == Point(1, 5)
    with pytest.raises(TypeError, match="no field z"):
        replace(Point(1), z=5)
    assert pickle.loads(pickle.dumps(Point(1, 7))) == Point(1, 7)
    match Point(1, 7):
        case Point(x, y):
            assert (x, y) == (1, 7)


def test_a_field_without_a_default_must_come_first() -> None:
    with pytest.raises(TypeError, match="follows one with a default"):

        @record
        class Wrong:
            x: int = 1
            y: int  # type: ignore[misc]


def test_the_empty_mapping_stays_empty() -> None:
    with pytest.raises(TypeError):
        EMPTY["a"] = 1  # type: ignore[index]


def test_a_record_can_validate_its_fields() -> None:
    @record
    class Share:
        """A number in [0, 1]."""

        value: float = 0.5

        def __post_init__(self) -> None:
            if not 0.0 <= self.value <= 1.0:
                raise ValueError(f"{self.value} is no share")

    assert Share().value == 0.5 and Share(1.0) == replace(Share(), value=1.0)
    with pytest.raises(ValueError, match="2 is no share"):
        Share(2)
    with pytest.raises(ValueError, match="-1 is no share"):
        replace(Share(), value=-1)


def test_a_record_can_cache_its_hash() -> None:
    hashes = []

    class Counted:
        def __hash__(self) -> int:
            hashes.append(self)
            return 3

    @record
    class Tree:
        """Hashes its parts once."""

        hashed_once = True
        part: object

    tree, counted = Tree(1), Tree(Counted())
    assert hash(tree) == hash(Tree(1)) == hash(tree)
    assert (tree == Tree(1), tree == Tree(2), repr(tree)) == (True, False, repr(tree).replace("2", "1"))
    assert hash(counted) == hash(counted)
    assert len(hashes) == 1
    with pytest.raises(AttributeError):
        tree._hash = 4  # type: ignore[attr-defined]
