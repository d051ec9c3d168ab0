"""Pair the specs of two files and compare each pair."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

from tltlc.automaton.work import DEFAULT_WORK, OutOfWork
from tltlc.core.record import record
from tltlc.diagnostics.diagnostic import Diagnostic, TltlError
from tltlc.tools.diff.assumed_exclusive import DeclaredGroups, assumed_groups
from tltlc.tools.diff.differences import Difference, differences
from tltlc.tools.diff.relation import Comparison, ExclusiveGroup, compare

if TYPE_CHECKING:
    from tltlc.automaton.fspa import Fspa


@record
class SpecPair:
    """A spec ``a`` of file A, a spec ``b`` of file B, and the differences between the two."""

    a: Fspa
    b: Fspa
    comparison: Comparison
    differences: tuple[Difference, ...]

    @property
    def is_same(self) -> bool:
        """Whether both specs accept the same traces and nothing else differs.

        False as well if the comparison left out traces for which no samples were found
        (:attr:`Comparison.impossible`).
        """
        comparison = self.comparison
        return comparison.relation == "equivalent" and not comparison.impossible and not self.differences


@record
class FileDiff:
    """The differences between the files A and B.

    ``a`` and ``b`` are the names of the files. ``pairs`` are the specs that were compared.
    ``only_a`` and ``only_b`` are the names of the specs that only one of the files has.
    """

    a: str
    b: str
    pairs: tuple[SpecPair, ...]
    only_a: tuple[str, ...] = ()
    only_b: tuple[str, ...] = ()

    @property
    def is_same(self) -> bool:
        """Whether no spec differs, and no spec is in one file only."""
        return not (self.only_a or self.only_b) and all(pair.is_same for pair in self.pairs)


def diff_files(
    a: tuple[str, Sequence[Fspa]],
    b: tuple[str, Sequence[Fspa]],
    *,
    one_each: bool = False,
    by_name: bool = False,
    work: int = DEFAULT_WORK,
    declared: DeclaredGroups = (None, None),
) -> FileDiff:
    """Return the differences between the specs of two files A and B.

    ``a`` and ``b`` are pairs: the name of the file, and its automata. Specs are paired by name, in the
    order of A. With ``one_each``, only the first spec of A is compared with the first spec of B,
    whatever their names. With ``by_name``, atoms with the same name always count as the same atom.
    ``declared`` has the ``exclusive`` groups that each file declares, even if no spec uses them; its
    entry is None for an artefact, that is, a compiled spec.

    Errors: TLT0750 if a comparison takes more than ``work`` steps.
    """
    specs_a, specs_b = a[1], b[1]

    def pair(spec_a: Fspa, spec_b: Fspa) -> SpecPair:
        return diff(
            spec_a, spec_b, by_name, work, assumed_groups(spec_a, spec_b, declared, by_name=by_name), feasible_only=True
        )

    if one_each:
        return FileDiff(a[0], b[0], (pair(specs_a[0], specs_b[0]),))
    by_name_b = {fspa.name: fspa for fspa in specs_b}
    names_a = {fspa.name for fspa in specs_a}
    return FileDiff(
        a[0],
        b[0],
        tuple(pair(fspa, by_name_b[fspa.name]) for fspa in specs_a if fspa.name in by_name_b),
        tuple(fspa.name for fspa in specs_a if fspa.name not in by_name_b),
        tuple(fspa.name for fspa in specs_b if fspa.name not in names_a),
    )


def diff(
    a: Fspa,
    b: Fspa,
    by_name: bool = False,
    work: int = DEFAULT_WORK,
    exclusive: Sequence[ExclusiveGroup] = (),
    *,
    feasible_only: bool = False,
) -> SpecPair:
    """Compare two specs: the traces that they accept, and everything else.

    The arguments mean the same as in :func:`~tltlc.tools.diff.relation.compare`.

    Errors: TLT0750 if the comparison takes more than ``work`` steps.
    """
    try:
        comparison = compare(a, b, by_name=by_name, feasible_only=feasible_only, work=work, exclusive=exclusive)
        return SpecPair(a, b, comparison, differences(a, b))
    except OutOfWork:
        title = f"comparing the two versions of `{a.name}` takes too long"
        if a.name != b.name:
            title = f"comparing `{a.name}` with `{b.name}` takes too long"
        help_ = "allow more with a greater `--state-budget N` (the default is 50000)"
        raise TltlError([Diagnostic("TLT0750", title, help=help_)]) from None
