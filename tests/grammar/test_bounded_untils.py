"""What the help for a bounded until suggests means what the bounded operator would mean."""

from __future__ import annotations

import pytest

from tltlc.automaton.compare import are_equivalent
from tltlc.diagnostics.diagnostic import TltlError
from tltlc.pipeline import compile_text

SIGNALS = "signal a: bool\nsignal b: bool\n"


def _expansion(operator: str, samples: int) -> str:
    """Return the bounded operator as nested ``X`` and ``N``, by its fixed point equation."""
    goal, stay, last, step = {
        "U": ("b", "a", "false", "X"),
        "W": ("b", "a", "true", "N"),
        "R": ("(a & b)", "b", "true", "N"),
        "M": ("(a & b)", "b", "false", "X"),
    }[operator]
    # After the last sample that counts, a weak operator asks for nothing more, and a strong one has failed.
    text = f"({goal} | ({stay} & {last}))"
    for _ in range(samples):
        text = f"({goal} | ({stay} & {step} {text}))"
    return text


@pytest.mark.parametrize("operator", "UWRM")
@pytest.mark.parametrize("samples", [0, 1, 2, 5])
def test_the_suggested_formula_is_the_bounded_operator(operator: str, samples: int) -> None:
    with pytest.raises(TltlError) as error:
        compile_text(f"{SIGNALS}spec s = a {operator}[0,20] b")
    (diagnostic,) = error.value.diagnostics
    assert diagnostic.help is not None
    suggested = diagnostic.help.split("`")[-2].replace("[0,20]", f"[0,{samples}]")
    first, second = compile_text(f"{SIGNALS}spec s = {suggested}\nspec t = {_expansion(operator, samples)}")
    assert are_equivalent(first, second)


@pytest.mark.parametrize(
    ("operator", "word"), [("X", "next"), ("N", "weak_next"), ("next", "next"), ("weak_next", "weak_next")]
)
def test_the_suggested_next_is_as_strong_as_the_written_one(operator: str, word: str) -> None:
    with pytest.raises(TltlError) as error:
        compile_text(f"{SIGNALS}spec s = {operator}[20] a")
    assert error.value.diagnostics[0].help == f"write `{word} after 20 steps p`"
