"""The language reference is complete, and its tables are correct."""

from __future__ import annotations

import re
from math import isclose, pi

import pytest

import tltlc
from tests.docs.blocks import DOCS, blocks
from tltlc.automaton.finite.build import DEFAULT_STATE_BUDGET
from tltlc.automaton.guards import PRIME_LIMIT, TOTAL_PRIME_LIMIT
from tltlc.core.record import replace
from tltlc.core.source import SourceFile
from tltlc.diagnostics.code_pages import codes
from tltlc.grammar import keywords, lalr, lexer, nesting
from tltlc.grammar.builder import Builder
from tltlc.grammar.lexer import tokenize
from tltlc.grammar.parser import parse_formula
from tltlc.grammar.tables import STARTS, load
from tltlc.io import files
from tltlc.io.limits import ARITHMETIC, IMPORTED, WORK
from tltlc.resolve import context, scope, units
from tltlc.resolve.range_proof import cases, check

PAGE = (DOCS / "language.md").read_text(encoding="utf-8")
IN_CODE = {inline_code.replace(r"\|", "|") for inline_code in re.findall(r"`([^`\n]+)`", PAGE)}
SIGNALS = "signal a: bool signal b: bool signal c: bool signal p: bool "


def rows(heading: str) -> list[list[str]]:
    """Return the rows of the first table after a heading, as cells, without the head."""
    table = re.search(rf"^#+ {heading}\n.*?((?:^\|[^\n]*\|\n)+)", PAGE, re.MULTILINE | re.DOTALL)
    assert table
    lines = [re.split(r"(?<!\\)\|", line.strip("|")) for line in table[1].splitlines()]
    return [[cell.strip().replace(r"\|", "|") for cell in line] for line in lines[2:]]


def code(cell: str) -> list[str]:
    return re.findall(r"`([^`]+)`", cell)


def formula(text: str) -> str:
    (fspa,) = tltlc.compile_text(f"{SIGNALS} spec s = {text}")
    return str(fspa.formula)


def test_every_word_and_sign_is_documented() -> None:
    tables = load()
    brackets = set("()[]{}:,=")
    assert set(tables.words) | set(tables.soft) - {"x"} <= IN_CODE
    separate_signs = {sign for name in IN_CODE for sign in [*name.split(), *re.split(r"[\w\s(),…]+", name)]}
    assert set(tables.signs) - brackets <= separate_signs


def test_the_reserved_words_are_those_of_the_grammar() -> None:
    match = re.search(r"- \*\*Reserved\*\*(.*?)The small words(.*?) are free", PAGE, re.DOTALL)
    assert match
    tables = load()
    capitals = set("FGXNUWRM")
    assert set(code(match[1])) == set(tables.words) - set(tables.soft) - capitals | {"F G X N U W R M"}
    assert set(code(match[2])) == set(tables.soft) | {"step 3x"}


def test_every_production_of_the_grammar_is_documented() -> None:
    """Each reduction of the grammar is used in an example or in inline code of the page."""
    taken: set[int] = set()

    class Recording(dict[str, int]):
        def get(self, key: str, default: int | None = None) -> int | None:  # type: ignore[override]
            action = super().get(key, default)
            seen.add(action)
            return action

    tables = load()
    recording_tables = replace(tables, actions=tuple(map(Recording, tables.actions)))
    examples = [block.text for block in blocks(DOCS / "language.md") if block.kind == "tltl"]
    for text, starts in [*((text, ("module",)) for text in examples), *((text, STARTS) for text in sorted(IN_CODE))]:
        source = SourceFile("example.tltl", text)
        lexed = tokenize(text)
        for start in starts:
            seen: set[int | None] = set()
            try:
                lalr.run(recording_tables, start, lexed.tokens, Builder(source, lexed.docs))
            except lalr.UnexpectedTokenError:
                continue
            taken |= {~action for action in seen if action is not None and action < 0}
            break

    def form(number: int) -> tuple[str, str]:
        # Open and closed variants of a rule count as the same form.
        rule = tables.rules[number]
        return re.sub("_(open|closed)$", "", rule.origin), rule.action

    assert {form(number) for number in range(len(tables.rules))} == {form(number) for number in taken}


def test_every_type_unit_and_function_is_documented() -> None:
    assert [code(row[0]) for row in rows("Declarations")[:1]] == [["import stealth"]]
    assert set(units.TYPES) <= IN_CODE
    assert set(load().units) <= IN_CODE
    for name in (*scope.FUNCTIONS, *scope.MEMORY_FUNCTIONS):
        assert any(text.startswith(f"{name}(") for text in IN_CODE), name


def test_every_declaration_clause_and_expectation_is_documented() -> None:
    for name in (*keywords.DECLARATIONS, *keywords.CLAUSES, *keywords.TEST_ITEMS):
        assert any(text.split()[0] == name for text in IN_CODE), name
    assert set(keywords.VERDICTS) <= IN_CODE
    for form in ("judge at", "semantics"):
        for word in keywords.JUDGE if form == "judge at" else keywords.SEMANTICS:
            assert f"{form} {word}" in IN_CODE


@pytest.mark.parametrize("row", rows("Formulas"), ids=lambda row: row[0])
def test_all_spellings_of_an_operator_mean_the_same(row: list[str]) -> None:
    spellings = [spelling for cell in row[1:] for spelling in code(cell)]
    assert spellings
    if row[0] == "true, false":
        words_, signs = code(row[1]), code(row[3])
        assert [formula(text) for text in signs] == [formula(text) for text in words_] == ["true", "false"]
        return
    prefix = spellings[0] in ("not", "eventually", "always", "next", "weak_next")
    assert len({formula(f"{spelling} a" if prefix else f"a {spelling} b") for spelling in spellings}) == 1
    known = {word: kind for table in (load().words, load().signs) for word, kind in table.items()}
    assert set(spellings) == {word for word, kind in known.items() if kind == known[spellings[0]]}


@pytest.mark.parametrize(
    "short, long",
    [
        ("a U b U c", "a U (b U c)"),
        ("a -> b -> c", "a -> (b -> c)"),
        ("a then b then c", "a then (b then c)"),
        ("F a & b", "(F a) & b"),
        ("!a U b", "(!a) U b"),
        ("a U b & c", "(a U b) & c"),
        ("a & b | c", "(a & b) | c"),
        ("a | b -> c", "(a | b) -> c"),
        ("a -> b <-> c", "(a -> b) <-> c"),
        ("a then b", "F(a & X F b)"),
    ],
)
def test_operators_bind_in_the_documented_order(short: str, long: str) -> None:
    assert formula(short) == formula(long)


@pytest.mark.parametrize("clause, meaning", rows("Specifications"), ids=lambda text: text)
def test_clauses_have_the_documented_meaning(clause: str, meaning: str) -> None:
    (fspa,) = tltlc.compile_text(f"{SIGNALS} spec s {{ {clause.strip('`')} }}")
    assert str(fspa.formula) == formula(meaning.strip("`"))


@pytest.mark.parametrize("row", rows("Bounds"), ids=lambda row: "".join(row[:2]))
def test_bounds_have_the_documented_meaning(row: list[str]) -> None:
    spellings = [text for cell in row for text in code(cell)]
    same = {formula(text) for text in spellings}
    expanded = {
        "F[2,3] p": "X X(p | X p)",
        "G[1,2] p": "N(p & N p)",
        "F[0,3] p": "p | X(p | X(p | X p))",
        "G[0,2] p": "p & N(p & N p)",
    }
    same |= {formula(expanded[text]) for text in spellings if text in expanded}
    assert len(same) == 1
    assert len(spellings) + sum(text in expanded for text in spellings) >= 2


def test_units_have_the_documented_values() -> None:
    text = PAGE[PAGE.index("| unit | is | unit | is |") :].split("\n\n")[0]
    cells = [cell.strip() for line in text.splitlines()[2:] for cell in line.strip("|").split("|")]
    documented = {unit: cell for names, cell in zip(cells[::2], cells[1::2], strict=True) for unit in code(names)}
    assert set(documented) == set(load().units)
    values = {"metre": 1, "second": 1, "radian": 1, "1 per second": 1, "π/180 rad": pi / 180}
    for unit, meaning in documented.items():
        value_in_si = units.in_si(1.0, unit)
        if value_in_si is None:
            assert unit in ("step", "steps")
        else:
            assert isclose(value_in_si[0], values.get(meaning) or float(meaning.split()[0])), unit


def test_limits_have_the_documented_values() -> None:
    documented = {
        row[0]: [float(number.replace(",", "")) for number in re.findall(r"[\d,]*\d", row[1])] for row in rows("Limits")
    }
    assert list(documented.values()) == [
        [files.MAX_SOURCE_BYTES / 2**20, lexer.MAX_TOKENS],
        [IMPORTED.values, IMPORTED.size],
        [nesting.MAX_BRACKETS],
        [nesting.MAX_DEPTH],
        [ARITHMETIC.depth],
        [ARITHMETIC.parts],
        [WORK["arithmetic of all atoms"]],
        [context.LARGEST_EXPANSION],
        [context.MOST_EXPANSIONS],
        [WORK["check of a predicate"], WORK["checks of all predicates"]],
        [check.LARGEST_SIZE, cases.LARGEST_NUMBER_OF_CASES],
        [cases.MOST_MEETING_CASES],
        [DEFAULT_STATE_BUDGET],
        [PRIME_LIMIT],
        [TOTAL_PRIME_LIMIT],
        [WORK["edges"]],
        [WORK["states of parts"]],
        [WORK["label nodes"]],
    ]
    assert {row[2] for row in rows("Limits")} <= set(codes())


def test_names_of_atoms_are_as_documented() -> None:
    text = """import stealth  entity s1  signal coins in [0, 50]
    spec s = F near(s1) & F near(s1, 1 m) & F near(s1, close = 100 cm) & F near(s1, close = 3 m)
             & F coins >= 30 & F 10 < coins"""
    (fspa,) = tltlc.compile_text(text)
    names = [atom.name for atom in fspa.atoms]
    assert names == ["near(s1)", "near(s1, close=3)", "coins < 30", "coins > 10"]
    assert set(names) <= IN_CODE


def test_exclusive_works_as_documented() -> None:
    text = next(block for block in re.findall(r"```tltl\n(.*?)```", PAGE, re.DOTALL) if "two_levers" in block)
    two, one = tltlc.compile_text(text)
    assert (len(two.states), len(two.atoms), two.exclusive, two.spec_size) == (4, 3, ((0, 1, 2),), 2)
    assert (len(one.states), [atom.name for atom in one.atoms], one.exclusive) == (2, ["pulled(red)"], ())
    (without,) = tltlc.compile_text("signal a: bool signal b: bool spec s = F a & F b")
    assert without.spec_size == 1


def test_a_minus_applies_to_the_whole_power() -> None:
    bare, _ = parse_formula(SourceFile("t", "-x^2 > 0"))
    assert bare is not None
    (fspa,) = tltlc.compile_text("signal x in [0, 3] spec s = F -x^2 < -1")
    assert fspa.atoms[0].name == "-x^2 < -1"
    assert tltlc.compile_text("signal x in [0, 3] spec s = F -(x^2) < -1")[0].atoms == fspa.atoms
