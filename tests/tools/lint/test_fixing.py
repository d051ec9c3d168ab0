"""Fixes produce the expected text and never change the meaning of a spec."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

import tltlc
from tests.calls import calls
from tests.fuzzing import times
from tests.tools.lint.helpers import apply_fixes, codes, findings_in
from tltlc.automaton.fspa import Guard
from tltlc.core.source import SourceFile
from tltlc.grammar.parser import parse
from tltlc.tools.lint.rule import Edit
from tltlc.tools.lint.scopes import preserve_scopes

SPEC = "spec s = F a\n"
MORE = "signal x in [0, 9]\nspec s = F more(x, 1, 1)\n"


@pytest.mark.parametrize(
    ("before", "after"),
    [
        ("signal a: bool\nsignal b: bool\nspec s = F a\n", "signal a: bool\nspec s = F a\n"),
        ("signal a: bool\n\n/// Of no use,\n/// this.\nsignal b: bool // no\n\n" + SPEC, "signal a: bool\n\n" + SPEC),
        ("// A game.\nimport core\n\nsignal a: bool\n" + SPEC, "// A game.\n\nsignal a: bool\n" + SPEC),
        ("import core\n\nsignal a: bool\n" + SPEC, "signal a: bool\n" + SPEC),
        ("signal b: bool signal a: bool\n" + SPEC, "signal a: bool\n" + SPEC),
        ("signal a: bool signal b: bool\n" + SPEC, "signal a: bool\n" + SPEC),
        ("signal a: bool signal b: bool // both\n" + SPEC, "signal a: bool // both\n" + SPEC),
        ("signal a: bool signal b: bool " + SPEC, "signal a: bool " + SPEC),
        ("signal a: bool\n" + SPEC + "signal b: bool", "signal a: bool\n" + SPEC),
        ("entity x, y, z\nsignal a(e): bool\nspec s = F a(y)\n", "entity y\nsignal a(e): bool\nspec s = F a(y)\n"),
        ("entity x, y\nsignal a: bool\n" + SPEC, "signal a: bool\n" + SPEC),
        ("signal a: bool\nsignal x: ratio\npredicate p = x\nlet q = F p\n" + SPEC, "signal a: bool\n" + SPEC),
        ("import core (less, more)\n" + MORE, "import core (more)\n" + MORE),
        (
            "signal a: bool\nspec s {\n    limit 3 steps\n    reach a\n    reach a\n}\n",
            "signal a: bool\nspec s {\n    limit 3 steps\n    reach a\n}\n",
        ),
        ("signal a: bool\r\n\r\nsignal b: bool\r\n\r\nspec s = F a\r\n", "signal a: bool\r\n\r\nspec s = F a\r\n"),
        ("signal a: bool\r\nsignal b: bool\r\nspec s = F a\r\n", "signal a: bool\r\nspec s = F a\r\n"),
    ],
)  # fmt: skip
def test_fixes_produce_the_expected_text(before: str, after: str) -> None:
    assert apply_fixes(before).source.text == after


NO_LIMIT = "// tltlc: allow TLT0419\n"
BLOCK = "spec s {\n    judge at goal\n    reach a\n}\n"


@pytest.mark.parametrize(
    ("before", "after"),
    [
        # Without the first declaration, the comment would apply to the whole file.
        ("import core\nsignal a: bool\n" + BLOCK, "signal a: bool\n" + BLOCK),
        ("import core\n" + NO_LIMIT + BLOCK + "signal a: bool\n", None),
        (
            "signal b: bool\nsignal c: bool\n" + NO_LIMIT + BLOCK + "signal a: bool\n",
            "signal c: bool\n" + NO_LIMIT + BLOCK + "signal a: bool\n",
        ),
        # A comment on a single declaration is removed with it, and does not apply to the next one.
        (
            "signal a: bool\n" + NO_LIMIT + "signal b: bool\n" + BLOCK,
            "signal a: bool\n" + BLOCK,
        ),
        (
            "signal a: bool\nsignal b: bool\n" + NO_LIMIT + BLOCK,
            "signal a: bool\n" + NO_LIMIT + BLOCK,
        ),
        # A comment is also kept if it is inside the documentation of a removed declaration.
        ("/// Old.\n" + NO_LIMIT + "import core\nsignal a: bool\n" + BLOCK, NO_LIMIT + "signal a: bool\n" + BLOCK),
        (
            "/// Old.\n" + NO_LIMIT + "/// Older.\nsignal b: bool\nsignal a: bool\n" + BLOCK,
            NO_LIMIT + "signal a: bool\n" + BLOCK,
        ),
        # One of the two statements on the line stays.
        (
            "signal a: bool\n/// Old.\n" + NO_LIMIT + "signal b: bool " + BLOCK,
            "signal a: bool\n" + NO_LIMIT + BLOCK,
        ),
        # A comment on the whole file still applies to the whole file.
        (NO_LIMIT + "signal b: bool\nsignal a: bool\n" + BLOCK, NO_LIMIT + "signal a: bool\n" + BLOCK),
    ],
)
def test_no_fix_changes_which_statements_a_comment_applies_to(before: str, after: str | None) -> None:
    assert apply_fixes(before).source.text == (before if after is None else after)


def test_a_duplicate_within_a_formula_is_not_fixed() -> None:
    text = "signal a: bool\nspec s = F a & F a\n"
    assert codes(text) == ["TLT0425"]
    assert apply_fixes(text).source.text == text


def test_fixed_and_remaining_findings_are_listed() -> None:
    fixed = apply_fixes("signal a: bool\nsignal b: bool\nlet c = F b\nspec s { judge at goal reach a }\n")
    assert [finding.title for finding in fixed.fixed] == ["nothing uses the let `c`", "nothing uses the signal `b`"]
    assert [finding.diagnostic.code for finding in fixed.remaining] == ["TLT0419"]


DECLARATIONS = {
    "import core": "core",
    "import stealth (alive, hidden)": "stealth",
    "/// Documented.\nentity x, y": "x y",
    "signal a: bool": "a",
    "signal b: bool  // behind it": "b",
    "signal n in [0, 10]": "n",
    "param most: number in [1, 9] = 5": "most",
    "// A comment of its own.\npredicate few in [-1, 1] = (most - n) / 10": "few",
    "let soon = F few": "soon",
    "let at(e) = F (a & e)": "at",
    "signal near_to(e: entity): bool": "near_to",
    "// tltlc: allow TLT0418": "",
}
FORMULAS = ("F a", "G b", "soon", "at(b)", "F near_to(x)", "F n > 3", "G few", "a", "F a & F a", "G alive")


@st.composite
def modules(draw: st.DrawFn) -> str:
    """Draw a file with all declarations in a random order, and specs that use some of them."""
    order = draw(st.permutations(list(DECLARATIONS)))
    gaps = draw(st.lists(st.sampled_from(["\n", "\n\n", "\n\n\n", " \n"]), min_size=len(order), max_size=len(order)))
    formulas = draw(st.lists(st.sampled_from(FORMULAS), min_size=1, max_size=4))
    clauses = draw(st.lists(st.sampled_from([f"require {formula}" for formula in FORMULAS]), min_size=1, max_size=4))
    specs = [f"spec s{number} = {formula}\n" for number, formula in enumerate(formulas)]
    block = "spec block {\n    " + "\n    ".join(clauses) + "\n}\n"
    return "".join(map("".join, zip(order, gaps, strict=True))) + "\n".join([*specs, block])


ALLOWS = tuple(f"// tltlc: allow {code}" for code in ("TLT0419", "TLT0418", "TLT0421", "TLT0422", "TLT0425"))
PIECES = (
    *("import core", "import core (less)", "import stealth", "signal a: bool", "signal b: bool", "signal c: bool"),
    *("entity x, y", "param most: number in [1, 9] = 5", "let soon = F a", "let late = F c"),
    *("spec s = F a", "spec r = F a & F a", "spec block {\n    reach a\n    reach a\n}"),
    "spec other {\n    // tltlc: allow TLT0425\n    reach a\n    reach a  // tltlc: allow TLT0423\n}",
)


@st.composite
def commented_files(draw: st.DrawFn) -> str:
    """Draw a file with documentation, ordinary comments and ``allow`` comments in all places."""
    order = draw(st.permutations(PIECES))
    lines = st.lists(st.sampled_from(("/// Documented.", "// tltlc: a comment", "", *ALLOWS)), max_size=3)
    text = ""
    for piece in order:
        text += "".join(f"{line}\n" for line in draw(lines))
        text += piece + draw(st.sampled_from(("\n", " ", f"  {ALLOWS[0]}\n", f"  {ALLOWS[2]}\n")))
    return text


def reported_findings(text: str) -> set[tuple[str, str, str]]:
    """Return the code and title of each finding, and the text at its first label."""
    diagnostics = [finding.diagnostic for finding in findings_in(text)]
    return {
        (diagnostic.code, diagnostic.title, diagnostic.labels[0].source.slice(diagnostic.labels[0].span))
        for diagnostic in diagnostics
    }


@times(20)
@given(commented_files())
def test_fixes_reveal_no_silenced_finding(text: str) -> None:
    """A finding that was silenced before the fixes is silenced after them."""
    silenced = reported_findings(text.replace("// tltlc: allow", "// tltlc, allow")) - reported_findings(text)
    after = reported_findings(apply_fixes(text).source.text)
    assert not silenced & after


def guards(fspa: tltlc.Fspa) -> list[tuple[int, int, Guard]]:
    return [(edge.source, edge.target, edge.guard) for edge in fspa.edges]


@times(40)
@given(modules())
def test_fixes_keep_all_automata_and_leave_nothing_to_fix(text: str) -> None:
    fixed = apply_fixes(text)
    assert not any(finding.fix for finding in fixed.remaining)
    assert apply_fixes(fixed.source.text).source == fixed.source
    assert reported_findings(fixed.source.text) <= reported_findings(text)
    _, problems = parse(fixed.source)
    assert not problems
    before, after = tltlc.compile_text(text), tltlc.compile_text(fixed.source.text)
    # A fix may remove a clause, so that the clauses that edges break have other numbers.
    assert [(f.states, guards(f), f.atoms, f.signals, f.judge) for f in before] == [
        (f.states, guards(f), f.atoms, f.signals, f.judge) for f in after
    ]
    # An ordinary comment stays, unless it is on the line of a removed declaration.
    assert fixed.source.text.count("// A comment of its own.") == 1


def test_the_work_for_comments_above_one_line_is_linear() -> None:
    def work(number: int) -> int:
        comments = "// tltlc: allow TLT0418\n" * number
        lets = " ".join(f"let l{index} = F a" for index in range(number))
        source = SourceFile("example.tltl", f"signal a: bool\nspec s = F a\n{comments}{lets}\n")
        module, _ = parse(source)
        edits = [Edit(declaration.span, "") for declaration in module.declarations[2:]]
        return calls(lambda: preserve_scopes(module, edits))

    assert work(400) < 2.5 * work(200)
