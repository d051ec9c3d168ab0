"""The places in a spec's source that diagnostics about a level point to."""

from __future__ import annotations

from tltl_runtime.spec.spec_places import SpecPlaces
from tltl_runtime.spec.task import read_spec
from tltlc.api import Signal

_SPEC = """\
entity far, near
signal distance(x: entity): length in [0 m, 9 m]
signal health: number in [0, 1]
spec places {
    limit 100 steps
    reach distance(near) < 1 m
    avoid distance( // the blanks and this comment do not matter
        far ) < 1 m
    keep health > 0.5
}
"""


def _signals() -> tuple[SpecPlaces, dict[str, Signal]]:
    _, spec = read_spec(_SPEC)
    assert spec is not None
    return SpecPlaces(spec), {signal.name: signal for signal in spec.signals}


def test_a_signal_is_found_by_its_base_name_and_its_arguments() -> None:
    places, signals = _signals()
    for name, words in [
        ("distance(near)", "distance(near)"),
        ("distance(far)", "distance( // the blanks and this comment do not matter far )"),
        ("health", "health"),
    ]:
        (label,) = places.signal(signals[name])
        assert " ".join(label.source.slice(label.span).split()) == words


def test_the_declaration_of_a_signal_is_found_by_its_base_name() -> None:
    places, signals = _signals()
    (label,) = places.declaration(signals["distance(far)"])
    assert label.source.slice(label.span) == "distance"
    assert label.span.start == _SPEC.index("distance(x: entity)")
