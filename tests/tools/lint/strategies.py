"""Random small formulas and specs as source text, and all short traces over their atoms."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

from hypothesis import strategies as st

from tests.tools.lint.helpers import RANGES, SIGNALS, block
from tests.tools.lint.traces import Traces, subsets

_UNARY = ("!({})", "F ({})", "G ({})", "X ({})", "N ({})")
_BINARY = ("({}) & ({})", "({}) | ({})", "({}) U ({})", "({}) -> ({})")


def formula_texts(atoms: Sequence[str], max_leaves: int = 4) -> st.SearchStrategy[str]:
    """Return a strategy for the texts of formulas over these atoms."""
    return st.recursive(
        st.sampled_from(atoms),
        lambda inner: (
            st.builds(str.format, st.sampled_from(_UNARY), inner)
            | st.builds(str.format, st.sampled_from(_BINARY), inner, inner)
        ),
        max_leaves=max_leaves,
    )


SMALL = formula_texts(["a", "b", "c"])


class World(NamedTuple):
    """Declarations (``before``), atoms over them, and all short traces of these atoms."""

    before: str
    atoms: tuple[str, ...]
    traces: Traces


_FREE = subsets(["a", "b", "c"])
_BELOW = ({"x < 5", "x < 7"}, {"x > 3", "x < 5", "x < 7"}, {"x > 3", "x < 7"})
_RANGED = (*_BELOW, {"x > 3", "x > 5", "x < 7"}, {"x > 3", "x > 5"})
"""The atoms that hold for x = 3, 4, 5, 6 and 7: one value from each region."""

FREE = World(SIGNALS, ("a", "b", "c"), Traces(_FREE))
EXCLUSIVE = World(
    SIGNALS + "exclusive a, b\n", FREE.atoms, Traces([letter for letter in _FREE if not {"a", "b"} <= letter])
)
RANGED = World(
    RANGES,
    ("a", "x > 3", "x > 5", "x < 5", "x < 7"),
    Traces([letter | truth for letter in _RANGED for truth in (set(), {"a"})]),
)


@st.composite
def specs(
    draw: st.DrawFn, *clauses: str, worlds: Sequence[World] = (FREE, EXCLUSIVE, RANGED), most: int = 3
) -> tuple[World, str]:
    """Draw a world, and the text of a spec of one to ``most`` clauses.

    The clauses are drawn from ``clauses``, with formulas in place of ``{}``.
    """
    world = draw(st.sampled_from(worlds))
    chosen = draw(st.lists(st.sampled_from(clauses), min_size=1, max_size=most))
    formulas = formula_texts(world.atoms)
    filled = [template.format(*(f"({draw(formulas)})" for _ in range(template.count("{}")))) for template in chosen]
    return world, block(*filled, before=world.before)
