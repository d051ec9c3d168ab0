"""Two files of specs: which belong together, and how they compare."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

from tltlc.automaton.infinite.work import DEFAULT_WORK, OutOfWork
from tltlc.core.record import record
from tltlc.diagnostics.diagnostic import Diagnostic, TltlError
from tltlc.tools.diff.assumed_exclusive import Declared, assumed
from tltlc.tools.diff.differences import Difference, differences
from tltlc.tools.diff.relation import Comparison, Group, compare

if TYPE_CHECKING:
    from tltlc.automaton.fspa import Fspa


@record
class Pair:
    """A spec of A and one of B, and what is different in B."""

    a: Fspa
    b: Fspa
    comparison: Comparison
    differences: tuple[Difference, ...]

    @property
    def is_same(self) -> bool:
        """Whether both accept the same traces, even such as no sample was found for, and nothing else differs."""
        found = self.comparison
        return found.relation == "equivalent" and not found.impossible and not self.differences


@record
class FileDiff:
    """What is different in the file B: of each pair of specs, and the names of the specs of A or B alone."""

    a: str
    b: str
    pairs: tuple[Pair, ...]
    only_a: tuple[str, ...] = ()
    only_b: tuple[str, ...] = ()

    @property
    def is_same(self) -> bool:
        """Whether no spec differs, and none is in one of the files alone."""
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
    """What is different from the specs of A to those of B, each file with its name.

    Specs are paired by their names, in the order of A; ``one_each`` pairs the first of each whatever their names.
    ``by_name`` as of :func:`tltlc.tools.diff.relation.compare`, ``declared`` as of
    :func:`tltlc.tools.diff.assumed_exclusive.assumed`.
    Errors: TLT0750 where a comparison takes more than ``work``.
    """
    ours, theirs = a[1], b[1]

    def pair(one: Fspa, other: Fspa) -> Pair:
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
    exclusive: Sequence[Group] = (),
    *,
    real: bool = False,
) -> Pair:
    """What is different from one spec to another, as of :func:`compare`; errors as of :func:`diff_files`."""
    try:
        comparison = compare(a, b, by_name=by_name, real=real, work=work, exclusive=exclusive)
        return Pair(a, b, comparison, differences(a, b))
    except OutOfWork:
        title = f"comparing the two versions of `{a.name}` takes too long"
        if a.name != b.name:
            title = f"comparing `{a.name}` with `{b.name}` takes too long"
        way_out = "allow more by a greater `--state-budget N` (by default 50000)"
        raise TltlError([Diagnostic("TLT0750", title, help=way_out)]) from None
