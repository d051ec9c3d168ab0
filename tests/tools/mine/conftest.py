from __future__ import annotations

from hypothesis import strategies as st

from tests.interfaces.cli.conftest import inside, process, tltlc
from tltlc.tools.mine.columns import ColumnKind
from tltlc.tools.mine.evidence import Evidence, LabelledTrace
from tltlc.tools.mine.vocabulary import MiningVocabulary, vocabulary_of_columns

__all__ = ["inside", "process", "tltlc"]

ATOMS = ("a", "b", "c")


def vocabulary(atoms: tuple[str, ...] = ATOMS) -> MiningVocabulary:
    return vocabulary_of_columns(dict.fromkeys(atoms, ColumnKind.TRUTHS))


@st.composite
def evidences(draw: st.DrawFn, atoms: tuple[str, ...] = ATOMS, longest: int = 20) -> Evidence:
    """Draw a few short traces and counterexamples over a few atoms."""
    letters = st.frozensets(st.sampled_from(atoms))
    traces = st.lists(letters, min_size=1, max_size=longest).map(tuple)
    good = draw(st.lists(traces, min_size=1, max_size=4))
    bad = draw(st.lists(traces, min_size=0, max_size=4))
    return Evidence(
        *(
            tuple(LabelledTrace(f"t{i}", letters_of_trace) for i, letters_of_trace in enumerate(part))
            for part in (good, bad)
        )
    )
