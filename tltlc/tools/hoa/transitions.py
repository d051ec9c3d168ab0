"""Combine the edges of a state to one function of the letter; they must be deterministic and complete."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, Final

from tltlc.automaton.diagrams import Diagrams
from tltlc.diagnostics.diagnostic import Diagnostic, Label, TltlError
from tltlc.tools.hoa.problems import DETERMINISTIC, broken
from tltlc.tools.hoa.tree import Hoa, HoaEdge, HoaExpression, HoaState

_MOST_UNLABELLED: Final = 64
YES, NO = "yes", "no"
"""Strings, since the table of letters could not tell True and False from 1 and 0."""

Move = tuple[int, frozenset[int]]
"""The target of an edge, and the acceptance sets of the edge and of its source."""

NOT_ALLOWED: Final = None
"""The value on letters that ``exclusive`` rules out."""


class HoaTransitions:
    """The moves of states, as functions of letters over ``atoms``, which are names.

    ``allowed`` is a function of the letter to :data:`YES` or :data:`NO`; letters that are not
    allowed are ignored.  Raises TltlError, TLT0651, if an alias is wrong.
    """

    def __init__(self, hoa: Hoa, atoms: Sequence[str], letters: Diagrams[Any], allowed: int) -> None:
        self._hoa, self._atoms = hoa, atoms
        self._letters, self._allowed = letters, allowed
        self._aliases: dict[str, int] = {}
        self._known: dict[int, int] = {}
        """The functions of labels, by the label's ``id``."""
        for alias in hoa.aliases:
            if alias.name in self._aliases:
                raise broken(hoa.source, alias.span, f"`{alias.name}` is declared again", "rename one")
            self._aliases[alias.name] = self._function(alias.term)

    def moves(self, state: HoaState) -> int:
        """Return the moves of a state, as a function of the letter to :data:`Move` or :data:`NOT_ALLOWED`.

        Raises TltlError: TLT0651 if a label is wrong; TLT0653 if two edges are taken on some
        letter; TLT0654 if none is.
        """
        letters = self._letters
        edges = self._unlabelled(state) if self._is_unlabelled(state) else self._labelled(state)
        step = letters.combined(lambda taken, yes: taken if yes == YES else NOT_ALLOWED, edges, self._allowed, {})
        for taken in letters.values(step):
            if taken is not NOT_ALLOWED and len(taken) != 1:
                raise TltlError([self._not_one(state, taken, self._letter(step, taken))])

        def move(taken: tuple[int] | None) -> Move | None:
            if taken is NOT_ALLOWED:
                return None
            edge = state.edges[taken[0]]
            return edge.targets.states[0], frozenset((*state.sets.numbers, *edge.sets.numbers))

        return letters.mapped(move, step, {})

    def _labelled(self, state: HoaState) -> int:
        """Return the places of the edges that a letter takes, at most two: two are enough for a counterexample."""
        letters = self._letters
        edges = letters.leaf(())
        for place, edge in enumerate(state.edges):

            def also(taken: tuple[int, ...], yes: str, place: int = place, edge: HoaEdge = edge) -> tuple[int, ...]:
                if yes == NO or len(taken) > 1 or any(_same(edge, state.edges[other]) for other in taken):
                    return taken
                return (*taken, place)

            label = edge.label or state.label
            assert label is not None
            edges = letters.combined(also, edges, self._of_label(label), {})
        return edges

    def _unlabelled(self, state: HoaState) -> int:
        """Return the place of the edge that a letter takes, if edges have no labels.

        The first edge is for the letter without atoms, the next one for the letter with atom 0
        alone, and so on: the atoms of the letter are the bits of the place.
        """
        count, letters = len(self._hoa.atoms), self._letters
        # The message says 2^count: Python refuses to print numbers of thousands of digits.
        if count > _MOST_UNLABELLED or len(state.edges) != 2**count:
            edges = f"{len(state.edges)} edge{'' if len(state.edges) == 1 else 's'}"
            title = f"state {state.number} has {edges} without labels, for 2^{count} letters"
            raise broken(self._hoa.source, state.span, title, "give one edge for each letter, or labels")

        def function(atom: int, holding: int) -> int:
            if atom == count:
                return letters.leaf((holding,))
            return letters.node(atom, function(atom + 1, holding), function(atom + 1, holding | 1 << atom))

        return function(0, 0)

    # --- labels -----------------------------------------------------------------------------------

    def _of_label(self, label: HoaExpression) -> int:
        if id(label) not in self._known:
            self._known[id(label)] = self._function(label)
        return self._known[id(label)]

    def _function(self, term: HoaExpression) -> int:
        """Return a label as a function to :data:`YES` or :data:`NO`."""
        letters = self._letters
        yes, no = letters.leaf(YES), letters.leaf(NO)
        match term.op:
            case "true" | "false":
                return yes if term.op == "true" else no
            case "not":
                return letters.mapped(lambda value: NO if value == YES else YES, self._function(term.args[0]), {})
            case "and" | "or":
                # The value that decides the result if one operand has it.
                absorbing = NO if term.op == "and" else YES
                result = no if absorbing == YES else yes
                for operand in term.args:
                    function = self._function(operand)
                    result = letters.combined(
                        lambda x, y: absorbing if absorbing in (x, y) else x, result, function, {}
                    )
                return result
            case "alias":
                if term.value not in self._aliases:
                    title = f"there is no alias `{term.value}` before this"
                    raise broken(self._hoa.source, term.span, title, "declare it: `Alias: @name 0 & !1`")
                return self._aliases[str(term.value)]
        assert isinstance(term.value, int)
        if term.value >= len(self._hoa.atoms):
            title = f"there is no atom {term.value}: `AP:` has {len(self._hoa.atoms)}, counted from 0"
            raise broken(self._hoa.source, term.span, title, "name one of those, or add it to `AP:`")
        return letters.node(term.value, no, yes)

    def _is_unlabelled(self, state: HoaState) -> bool:
        """Whether the edges of a state have no labels and stand for the letters in order; False without edges.

        Raises TltlError, TLT0651, if only some edges have labels, or an edge has a label and its
        state too.
        """
        if state.label is not None:
            for edge in state.edges:
                if edge.label is not None:
                    raise self._label_problem(edge, "this edge has a label, and its state has one, too")
            return False
        unlabelled = [edge for edge in state.edges if edge.label is None]
        if unlabelled and len(unlabelled) < len(state.edges):
            raise self._label_problem(unlabelled[0], "this edge has no label, and others of its state have one")
        return bool(unlabelled)

    def _label_problem(self, edge: HoaEdge, title: str) -> TltlError:
        suggestion = "label the state alone, all of its edges, or none of them"
        return broken(self._hoa.source, edge.targets.span, title, suggestion)

    # --- letters with no edge or two --------------------------------------------------------------

    def _letter(self, step: int, taken: tuple[int, ...]) -> str:
        """Return some letter on which ``step`` has the value ``taken``, as a conjunction of literals."""
        present = self._letters.assignment_with(step, taken)
        names = [name if place in present else f"!{name}" for place, name in enumerate(self._atoms)]
        return " & ".join(names) or "true"

    def _not_one(self, state: HoaState, taken: tuple[int, ...], letter: str) -> Diagnostic:
        source = self._hoa.source
        if not taken:
            title = f"this automaton is not complete: state {state.number} has no edge for `{letter}`"
            return Diagnostic("TLT0654", title, (Label(source, state.span, "of this state"),), DETERMINISTIC)
        title = f"this automaton is not deterministic: state {state.number} has two edges for `{letter}`"
        one, other = (state.edges[place].targets.span for place in taken)
        labels = (Label(source, one, "one"), Label(source, other, "the other"))
        return Diagnostic("TLT0653", title, labels, DETERMINISTIC)


def _same(one: HoaEdge, other: HoaEdge) -> bool:
    """Whether two edges have the same target and the same sets: a file may contain an edge twice."""
    return one.targets.states == other.targets.states and set(one.sets.numbers) == set(other.sets.numbers)
