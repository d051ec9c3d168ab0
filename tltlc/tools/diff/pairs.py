"""Pair the specs of two files and compare each pair."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

from tltlc.automaton.work import DEFAULT_WORK, OutOfWork
from tltlc.core.record import record
from tltlc.diagnostics.diagnostic import Diagnostic, TltlError
from tltlc.tools.diff.assumed_exclusive import Declared, assumed
from tltlc.tools.diff.differences import Difference, differences
from tltlc.tools.diff.relation import Comparison, ExclusiveGroup, compare

if TYPE_CHECKING:
    from tltlc.automaton.fspa import Fspa


@record
class SpecPair:
    """A spec of A and a spec of B, and what is different in B."""

    a: Fspa
    b: Fspa
    comparison: Comparison
    differences: tuple[Difference, ...]

    @property
    def is_same(self) -> bool:
        """Whether both accept the same traces and nothing else differs.

        Traces count even if they need samples that were not found.
        """
        comparison = self.comparison
        return comparison.relation == "equivalent" and not comparison.impossible and not self.differences


@record
class FileDiff:
    """The differences of file B from file A: the pairs of specs, and the specs in A or B alone."""

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
    declared: Declared = (None, None),
) -> FileDiff:
    """Return the differences from the specs of A to those of B. Each file comes with its name.

    Specs are paired by name, in the order of A. ``one_each`` pairs the first spec of A with the
    first of B regardless of their names. ``by_name`` is as in
    :func:`tltlc.tools.diff.relation.compare`, ``declared`` as in
    :func:`tltlc.tools.diff.assumed_exclusive.assumed`.

    Errors: TLT0750 if a comparison takes more than ``work``.
    """
    ours, theirs = a[1], b[1]

    def pair(one: Fspa, other: Fspa) -> SpecPair:
        return diff(one, other, by_name, work, assumed(one, other, declared, by_name=by_name), real=True)

    if one_each:
        return FileDiff(a[0], b[0], (pair(ours[0], theirs[0]),))
    named = {fspa.name: fspa for fspa in theirs}
    names = {fspa.name for fspa in ours}
    return FileDiff(
        a[0],
        b[0],
        tuple(pair(fspa, named[fspa.name]) for fspa in ours if fspa.name in named),
        tuple(fspa.name for fspa in ours if fspa.name not in named),
        tuple(fspa.name for fspa in theirs if fspa.name not in names),
    )


def diff(
    a: Fspa,
    b: Fspa,
    by_name: bool = False,
    work: int = DEFAULT_WORK,
    exclusive: Sequence[ExclusiveGroup] = (),
    *,
    real: bool = False,
) -> SpecPair:
    """Return the differences from one spec to another, with the arguments of :func:`compare`.

    Errors are as in :func:`diff_files`.
    """
    try:
        comparison = compare(a, b, by_name=by_name, real=real, work=work, exclusive=exclusive)
        return SpecPair(a, b, comparison, differences(a, b))
    except OutOfWork:
        title = f"comparing the two versions of `{a.name}` takes too long"
        if a.name != b.name:
            title = f"comparing `{a.name}` with `{b.name}` takes too long"
        suggestion = "allow more by a greater `--state-budget N` (by default 50000)"
        raise TltlError([Diagnostic("TLT0750", title, help=suggestion)]) from None
