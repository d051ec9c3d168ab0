"""Combine the edges of a state into one function from letters to moves.

A letter says which atoms hold, and a move is where the letter leads. The edges must be deterministic
and complete: each letter takes exactly one edge.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, Final

from tltlc.automaton.diagrams import Diagrams
from tltlc.diagnostics.diagnostic import Diagnostic, Label, TltlError
from tltlc.tools.hoa.problems import DETERMINISTIC, format_error
from tltlc.tools.hoa.tree import Hoa, HoaEdge, HoaExpression, HoaState

_MOST_UNLABELLED: Final = 64
YES, NO = "yes", "no"
"""The truth values in the diagrams: strings, because True and False equal the numbers 1 and 0."""

Move = tuple[int, frozenset[int]]
"""Where a letter leads: the target state, and the acceptance sets of the edge and its source."""

NOT_ALLOWED: Final = None
"""Stands in place of a ``Move`` for letters in which two ``exclusive`` atoms hold."""


class HoaTransitions:
    """Computes where each letter leads from each state of a HOA file.

    A letter says which of ``atoms`` hold. A :data:`Move` is a target state with the acceptance sets
    of the edge and of its source. The result for a state is a function from letters to moves. Each
    function is the number of a node in the decision diagrams ``letters``. ``allowed`` is a function
    from letters to :data:`YES` or :data:`NO`. The move for a letter that is not allowed is
    :data:`NOT_ALLOWED`.

    Raises TltlError, TLT0651, if an alias is wrong.
    """

    def __init__(self, hoa: Hoa, atoms: Sequence[str], letters: Diagrams[Any], allowed: int) -> None:
        self._hoa, self._atoms = hoa, atoms
        self._letters, self._allowed = letters, allowed
        self._aliases: dict[str, int] = {}
        self._label_functions: dict[int, int] = {}
        """The functions from letters to the truth of a label, by the ``id`` of the label."""
        for alias in hoa.aliases:
            if alias.name in self._aliases:
                raise format_error(hoa.source, alias.span, f"`{alias.name}` is declared again", "rename one")
            self._aliases[alias.name] = self._function(alias.term)

    def moves(self, state: HoaState) -> int:
        """Return the moves of a state, as a function from letters to :data:`Move` or :data:`NOT_ALLOWED`.

        Raises TltlError: TLT0651 if a label is wrong; TLT0653 if some letter takes two edges; TLT0654
        if some letter takes none.
        """
        letters = self._letters
        edges = self._unlabelled_edges(state) if self._is_unlabelled(state) else self._labelled_edges(state)
        step = letters.apply(lambda taken, yes: taken if yes == YES else NOT_ALLOWED, edges, self._allowed, {})
        for taken in letters.values(step):
            if taken is not NOT_ALLOWED and len(taken) != 1:
                raise TltlError([self._edge_count_error(state, taken, self._letter(step, taken))])

        def move(taken: tuple[int] | None) -> Move | None:
            if taken is NOT_ALLOWED:
                return None
            edge = state.edges[taken[0]]
            return edge.targets.states[0], frozenset((*state.sets.numbers, *edge.sets.numbers))

        return letters.map_leaves(move, step, {})

    def _labelled_edges(self, state: HoaState) -> int:
        """Return a function from letters to the edges of the state that can be taken on them.

        The edges are given as a tuple of positions in ``state.edges``. An edge that duplicates an
        earlier edge is left out. There are at most two edges for a letter, because two already show
        that the state is not deterministic.
        """
        letters = self._letters
        edges = letters.leaf(())
        for place, edge in enumerate(state.edges):

            def add(taken: tuple[int, ...], yes: str, place: int = place, edge: HoaEdge = edge) -> tuple[int, ...]:
                if yes == NO or len(taken) > 1 or any(_are_duplicates(edge, state.edges[earlier]) for earlier in taken):
                    return taken
                return (*taken, place)

            label = edge.label or state.label
            assert label is not None
            edges = letters.apply(add, edges, self._label_function(label), {})
        return edges

    def _unlabelled_edges(self, state: HoaState) -> int:
        """Return a function from letters to the position of their edge, for a state without labels.

        The first edge is for the letter without atoms, the next edge for the letter with atom 0 only,
        and so on: bit i of the position says whether atom i holds. The position is a tuple of one
        number, in the form of :meth:`_labelled_edges`.

        Raises TltlError, TLT0651, if the state does not have one edge for each letter.
        """
        count, letters = len(self._hoa.atoms), self._letters
        # The message says 2^count: Python refuses to print numbers of thousands of digits.
        if count > _MOST_UNLABELLED or len(state.edges) != 2**count:
            edges = f"{len(state.edges)} edge{'' if len(state.edges) == 1 else 's'}"
            title = f"state {state.number} has {edges} without labels, but there are 2^{count} letters"
            raise format_error(
                self._hoa.source, state.span, title, "write one edge for each letter, or label the edges"
            )

        def function(atom: int, holding: int) -> int:
            if atom == count:
                return letters.leaf((holding,))
            return letters.node(atom, function(atom + 1, holding), function(atom + 1, holding | 1 << atom))

        return function(0, 0)

    # --- labels -----------------------------------------------------------------------------------

    def _label_function(self, label: HoaExpression) -> int:
        if id(label) not in self._label_functions:
            self._label_functions[id(label)] = self._function(label)
        return self._label_functions[id(label)]

    def _function(self, term: HoaExpression) -> int:
        """Return a Boolean expression as a function from letters to :data:`YES` or :data:`NO`.

        Raises TltlError, TLT0651, if the expression has an unknown alias or atom.
        """
        letters = self._letters
        yes, no = letters.leaf(YES), letters.leaf(NO)
        match term.op:
            case "true" | "false":
                return yes if term.op == "true" else no
            case "not":
                return letters.map_leaves(lambda value: NO if value == YES else YES, self._function(term.args[0]), {})
            case "and" | "or":
                # If one operand has this value, the result has it, too.
                absorbing = NO if term.op == "and" else YES
                result = no if absorbing == YES else yes
                for operand in term.args:
                    function = self._function(operand)
                    result = letters.apply(lambda x, y: absorbing if absorbing in (x, y) else x, result, function, {})
                return result
            case "alias":
                if term.value not in self._aliases:
                    title = f"the alias `{term.value}` is not declared before this"
                    raise format_error(self._hoa.source, term.span, title, "declare it: `Alias: @name 0 & !1`")
                return self._aliases[str(term.value)]
        assert isinstance(term.value, int)
        if term.value >= len(self._hoa.atoms):
            title = f"atom {term.value} does not exist: `AP:` has {len(self._hoa.atoms)}, counted from 0"
            raise format_error(self._hoa.source, term.span, title, "use one of those, or add it to `AP:`")
        return letters.node(term.value, no, yes)

    def _is_unlabelled(self, state: HoaState) -> bool:
        """Whether neither a state nor its edges have labels, so that the positions of the edges give their letters.

        False if there are no edges.

        Raises TltlError, TLT0651, if only some of the edges have labels, or if both an edge and its
        state have one.
        """
        if state.label is not None:
            for edge in state.edges:
                if edge.label is not None:
                    raise self._label_problem(edge, "this edge and its state both have a label")
            return False
        unlabelled = [edge for edge in state.edges if edge.label is None]
        if unlabelled and len(unlabelled) < len(state.edges):
            raise self._label_problem(unlabelled[0], "this edge has no label, but other edges of its state have one")
        return bool(unlabelled)

    def _label_problem(self, edge: HoaEdge, title: str) -> TltlError:
        help_ = "label only the state, all of its edges, or none of them"
        return format_error(self._hoa.source, edge.targets.span, title, help_)

    # --- letters with no edge or two --------------------------------------------------------------

    def _letter(self, step: int, taken: tuple[int, ...]) -> str:
        """Return a letter that ``step`` maps to ``taken``, as a conjunction of literals."""
        present = self._letters.assignment_with(step, taken)
        names = [name if place in present else f"!{name}" for place, name in enumerate(self._atoms)]
        return " & ".join(names) or "true"

    def _edge_count_error(self, state: HoaState, taken: tuple[int, ...], letter: str) -> Diagnostic:
        source = self._hoa.source
        if not taken:
            title = f"this automaton is not complete: state {state.number} has no edge for `{letter}`"
            return Diagnostic("TLT0654", title, (Label(source, state.span, "this state"),), DETERMINISTIC)
        title = f"this automaton is not deterministic: state {state.number} has two edges for `{letter}`"
        first, second = (state.edges[place].targets.span for place in taken)
        labels = (Label(source, first, "one"), Label(source, second, "the other"))
        return Diagnostic("TLT0653", title, labels, DETERMINISTIC)


def _are_duplicates(first: HoaEdge, second: HoaEdge) -> bool:
    """Whether two edges have the same target and acceptance sets. A file may contain an edge twice."""
    return first.targets.states == second.targets.states and set(first.sets.numbers) == set(second.sets.numbers)
