"""Count how often each method of ``tltlc/resolve/range_proof`` decides, and which answers change without it.

``python -m benchmarks.range_tiers`` prints two tables over the predicates of the standard library, of the examples,
of the tests' specs, and of a seeded generator.
"""

from __future__ import annotations

import argparse
import os
import random
from collections import Counter
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from contextlib import ExitStack
from typing import Any, Final
from unittest.mock import patch

from benchmarks.markdown import table
from benchmarks.store import ROOT
from tests.resolve import test_range_proof as inline_tests
from tltlc.core.record import record
from tltlc.expression.evaluate import evaluate
from tltlc.expression.tree import ArithmeticOp, Condition, Const, Expression, Op, SignalValue, When
from tltlc.grammar.parser import parse
from tltlc.io.files import read_source
from tltlc.resolve import range_proof, spec
from tltlc.resolve.options import ResolveOptions
from tltlc.resolve.range_proof import check, continuity, elimination, exact, jumps, proof, witness
from tltlc.resolve.range_proof.proof import holds_at_once
from tltlc.resolve.range_proof.region import ConstrainedBox
from tltlc.resolve.resolution import resolve

FOLDERS: Final = {"standard library": "stdlib_predicates", "examples": "examples", "tests": "tests"}
SEED: Final = 1
SAMPLES: Final = 200
RANGES: Final = (("x", 0.0, 1.0), ("y", -1.0, 2.0), ("z", 1.0, 10.0))
"""The signals of generated predicates, with the ends of their ranges."""
METHODS: Final = (
    "intervals",
    "intervals with bounded ratios",
    "signs of exact forms",
    "subdivision",
    "agreement of cases by substitution",
    "search for a wrong point",
    "search for a jump",
    "sympy",
    "unproved",
)


@record
class Question:
    """The arguments of one check of a predicate."""

    expression: Expression
    signals: Mapping[str, spec.Signal]
    params: Mapping[str, spec.Param]
    low: float
    high: float

    def kinds(self) -> tuple[str, ...]:
        """Return the kinds of findings; without any, range and continuity are proved."""
        findings = check.check_predicate(self.expression, self.signals, self.params, self.low, self.high)
        return tuple(finding.kind for finding in findings)


def corpus(generated: int) -> dict[str, list[Question]]:
    """Return the distinct predicates by their origin; ``generated`` is the number of random ones."""
    questions = {name: _distinct(_questions_of_folder(folder)) for name, folder in FOLDERS.items()}
    questions["tests"] = _distinct([*questions["tests"], *_inline_questions()])
    questions["generated"] = list(_random_questions(generated))
    return questions


def _distinct(questions: Iterable[Question]) -> list[Question]:
    return list({(question.expression, question.low, question.high): question for question in questions}.values())


def _questions_of_folder(folder: str) -> Iterator[Question]:
    for path in sorted((ROOT / folder).rglob("*.tltl")):
        questions: list[Question] = []

        def ask(*arguments: Any, questions: list[Question] = questions) -> tuple[()]:
            questions.append(Question(*arguments))
            return ()

        module, _ = parse(read_source(str(path), path.name))
        with patch.object(range_proof, "check_predicate", ask):
            resolve(module, ResolveOptions())
        yield from questions


def _inline_questions() -> Iterator[Question]:
    """Yield the predicates that the tests of the checker write as expressions."""
    for test in (
        inline_tests.test_correct_predicates_are_proved,
        inline_tests.test_a_wrong_range_has_a_counterexample,
        inline_tests.test_jumps_between_cases_are_found,
    ):
        for row in vars(test)["pytestmark"][0].args[1]:
            low, high = row[1:] if len(row) == 3 else (-1.0, 1.0)
            yield Question(row[0], inline_tests.SIGNALS, inline_tests.PARAMS, low, high)


def _random_questions(count: int) -> Iterator[Question]:
    """Yield random predicates over three signals; half of the ranges contain the sampled values with a margin."""
    choose = random.Random(SEED)
    signals = {name: spec.Signal(name, "number", low, high) for name, low, high in RANGES}
    while count:
        expression = _expression(choose, 3)
        values = _sample_values(expression, choose)
        if len(set(values)) > 1:
            least, most = min(values), max(values)
            margin = (most - least) * choose.choice((0.5, -0.1))
            yield Question(expression, signals, {}, least - margin, most + margin)
            count -= 1


def _sample_values(expression: Expression, choose: random.Random) -> list[float]:
    values = []
    for _ in range(SAMPLES):
        point = {name: choose.uniform(low, high) for name, low, high in RANGES}
        try:
            values.append(evaluate(expression, point, {}))
        except (ArithmeticError, ValueError):
            return []
    return values


def _expression(choose: random.Random, depth: int) -> Expression:
    if depth == 0 or choose.random() < 0.15:
        return SignalValue(choose.choice("xyz")) if choose.random() < 0.7 else Const(float(choose.randint(-3, 3)))
    operands = [_expression(choose, depth - 1) for _ in range(3)]
    if choose.random() < 0.15:
        return When(((Condition("<", (operands[0], Const(1.0))), operands[1]),), operands[2])
    unary: tuple[ArithmeticOp, ...] = ("neg", "abs", "tanh", "exp")
    binary: tuple[ArithmeticOp, ...] = ("+", "-", "*", "*", "/", "min", "max")
    name = choose.choice((*unary, *binary, *binary))
    return Op(name, tuple(operands[: 1 if name in unary else 2]))


def count_decisions(questions: Sequence[Question]) -> Counter[str]:
    """Count the goals that each method decides.

    A goal is a bound of a case, the agreement of two cases, or a finding. The methods of a proof with sympy count
    as sympy.
    """
    decisions: Counter[str] = Counter()
    assert vars(exact)["proves_within"] is vars(elimination)["proves_within"], (
        "the modules of sympy's proofs keep the plain function"
    )

    def proves_within(value: Expression, region: ConstrainedBox, low: float, high: float, parts: int = 300) -> bool:
        method = _proving_method(value, region, low, high, parts)
        decisions.update([method] if method else [])
        return method is not None

    def count_true(name: str, decides: Callable[..., Any]) -> Callable[..., Any]:
        def wrapped(*arguments: Any) -> Any:
            answer = decides(*arguments)
            decisions.update([name] if answer else [])
            return answer

        return wrapped

    with ExitStack() as patches:
        for module in (proof, continuity):
            patches.enter_context(patch.object(module, "proves_within", proves_within))
        for module, function, name in (
            (continuity, "_same_after_substitution", "agreement of cases by substitution"),
            (witness, "find_wrong_point", "search for a wrong point"),
            (jumps, "find_jump", "search for a jump"),
            (check, "_proves_exactly", "sympy"),
        ):
            patches.enter_context(patch.object(module, function, count_true(name, getattr(module, function))))
        for question in questions:
            decisions["unproved"] += any(kind.endswith(("unproved", "unchecked")) for kind in question.kinds())
    return decisions


def _proving_method(value: Expression, region: ConstrainedBox, low: float, high: float, parts: int) -> str | None:
    """Return the first method that proves a bound, in the order of ``proof.proves_within``; None if none does."""
    if holds_at_once(value, region, low, high):
        return "intervals"
    if proof._is_defined(value, region):
        region = proof._with_ratios(value, region)
        if holds_at_once(value, region, low, high):
            return "intervals with bounded ratios"
        if proof._proves_by_sign(value, region, low, high):
            return "signs of exact forms"
    return "subdivision" if proof._holds_in_parts(value, region, low, high, parts) else None


def changed_answers(questions: Sequence[Question], methods: Iterable[str]) -> dict[str, int]:
    """Return for each method the number of predicates that get another answer without it."""
    before = [question.kinds() for question in questions]
    changes = {}
    for name in methods:
        module, function, answer = REPLACEMENTS[name]
        with patch.object(module, function, answer):
            changes[name] = sum(question.kinds() != kinds for question, kinds in zip(questions, before, strict=True))
    return changes


def _return_false(*_: object) -> bool:
    return False


def _return_none(*_: object) -> None:
    return None


def _same_region(_: Expression, region: ConstrainedBox) -> ConstrainedBox:
    return region


REPLACEMENTS: Final[Mapping[str, tuple[Any, str, Callable[..., Any]]]] = {
    "intervals with bounded ratios": (proof, "_with_ratios", _same_region),
    "signs of exact forms": (proof, "_proves_by_sign", _return_false),
    "subdivision": (proof, "_holds_in_parts", _return_false),
    "agreement of cases by substitution": (continuity, "_same_after_substitution", _return_false),
    "search for a wrong point": (witness, "find_wrong_point", _return_none),
    "search for a jump": (jumps, "find_jump", _return_none),
    "sympy": (check, "_proves_exactly", _return_false),
}
"""For each method: its module, the name of its function, and a function that replaces it and never decides."""
PROOFS: Final = tuple(REPLACEMENTS)[:4]
"""The methods of proof in a browser, which has no sympy."""


def main() -> None:
    """Print how often each method decides, and how many answers change without it."""
    parser = argparse.ArgumentParser(prog="python -m benchmarks.range_tiers", description=__doc__)
    parser.add_argument("--generated", type=int, default=200, metavar="N", help="number of random predicates")
    options = parser.parse_args()
    os.environ["TLTLC_CACHE_DIR"] = ""  # Every answer is computed.
    questions = corpus(options.generated)
    counts = {name: count_decisions(group) for name, group in questions.items()}
    total = sum((Counter(count) for count in counts.values()), Counter[str]())
    all_questions = [question for group in questions.values() for question in group]
    changes = changed_answers(all_questions, REPLACEMENTS)
    with patch.object(check, "_proves_exactly", _return_false):
        changes_in_browser = changed_answers(all_questions, PROOFS)
    rows = [
        (
            method,
            *(count[method] for count in counts.values()),
            f"{100 * total[method] / sum(total.values()):.1f} %",
            changes.get(method, "–"),
            changes_in_browser.get(method, "–"),
        )
        for method in METHODS
    ]
    print(
        table(("method", *counts, "share", "answers that change without it", "the same where sympy is missing"), rows)
    )
    print("\npredicates: " + ", ".join(f"{len(group)} {name}" for name, group in questions.items()))


if __name__ == "__main__":
    main()
