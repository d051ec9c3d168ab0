"""Numbers on the command line are limited to sizes that every part can handle."""

from __future__ import annotations

from collections.abc import Callable

import click
import pytest

from tests.interfaces.cli.conftest import Outcome
from tests.interfaces.cli.test_paths import commands
from tltlc.interfaces.cli.numbers import LARGEST, FiniteRange, WholeRange

LARGE = ("9" * 20, "1" + "0" * 400, "9" * 5000, "-" + "9" * 5000, "+" + "9" * 30)


def _numbers() -> list[tuple[str, click.Parameter]]:
    kinds = (click.types.IntParamType, click.types.FloatParamType)
    return [
        (name, parameter)
        for name, command in commands()
        for parameter in command.params
        if isinstance(parameter.type, kinds)
    ]


@pytest.mark.parametrize(("command", "parameter"), _numbers(), ids=str)
def test_every_option_rejects_numbers_that_are_too_large(command: str, parameter: click.Parameter) -> None:
    # A callback may reject the value, too.
    assert isinstance(parameter.type, (WholeRange, FiniteRange)) or parameter.callback
    whole = isinstance(parameter.type, click.types.IntParamType)
    for value in LARGE if whole else ("nan", "inf", "-inf", "1e400"):
        with pytest.raises(click.BadParameter) as error:
            parameter.process_value(click.Context(click.Command(command)), value)
        assert len(error.value.message) < 200


def test_whole_numbers_are_limited() -> None:
    assert WholeRange().convert(str(LARGEST), None, None) == LARGEST
    assert WholeRange().convert("0" * 30 + "7", None, None) == 7
    with pytest.raises(click.BadParameter, match=r"`9{20}…` is out of range: whole numbers go from -4,611,"):
        WholeRange().convert("9" * 21, None, None)
    with pytest.raises(click.BadParameter, match="is not in the range x>=1"):
        WholeRange(min=1).convert("0", None, None)


@pytest.mark.parametrize(
    "variables", [{}, {"COMP_WORDS": "tltlc", "COMP_CWORD": "x"}, {"COMP_WORDS": "'", "COMP_CWORD": "9" * 5000}]
)
def test_completion_without_a_shell_is_wrong_usage(variables: dict[str, str], process) -> None:  # type: ignore[no-untyped-def]
    outcome = process(_TLTLC_COMPLETE="bash_complete", **variables)
    assert (outcome.status, outcome.out) == (2, "")
    assert "_TLTLC_COMPLETE is for the scripts that `tltlc completion` prints" in outcome.err


def test_a_usage_error_names_the_command(tltlc: Callable[..., Outcome]) -> None:
    assert "`tltlc compile --help` shows how to use it" in tltlc("compile", "a.tltl", "-t").err
