"""``allow`` comments, which silence findings."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.calls import calls
from tests.tools.lint.helpers import apply_fixes, codes
from tltlc.core.source import SourceFile
from tltlc.diagnostics.diagnostic import Diagnostic, Label
from tltlc.pipeline import CompileOptions
from tltlc.tools.lint.allow import apply_allow_comments
from tltlc.tools.lint.rule import LintFinding
from tltlc.tools.lint.run import lint, view_of

BEFORE = "signal seen: bool\n"


@pytest.mark.parametrize(
    "text",
    [
        "spec hide { judge at limit avoid seen }  // tltlc: allow TLT0419",
        "// tltlc: allow TLT0419\nspec hide { judge at limit avoid seen }",
        "//tltlc:allow TLT0419 nobody plays this\n/// Unseen.\n// Twice.\nspec hide { judge at limit avoid seen }",
        "// tltlc: allow TLT0421\n// tltlc: allow TLT0419\nsignal heard: bool spec hide { judge at limit avoid seen }",
        "// tltlc: allow TLT0419, TLT0421\nsignal heard: bool spec hide { judge at limit avoid seen }",
        "// tltlc: allow TLT0419 TLT0421: both\nsignal heard: bool spec hide { judge at limit avoid seen }",
        "signal heard: bool\nspec go {\n    limit 9 steps\n    reach seen\n        then (not seen)\n"
        "        then (seen implies heard)  // tltlc: allow TLT0412\n}",
        "signal heard: bool\nspec go {\n    limit 9 steps\n    reach seen\n        then (seen implies heard)\n"
        "}  // tltlc: allow TLT0412",
        # A rule that reports errors can be silenced. The compiler cannot.
        "signal x in [0, 50]\npredicate never in [-1, 0] = -x / 50\n"
        "spec go {\n    limit 9 steps\n    reach never or seen  // tltlc: allow TLT0416\n}",
        # Empty lines do not matter.
        "signal heard: bool\n// tltlc: allow TLT0419\n\nspec hide { judge at limit avoid seen or heard }",
    ],
)
def test_allowed_findings_are_not_reported(text: str) -> None:
    assert codes(BEFORE + text) == []


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("spec hide { judge at limit avoid seen }\n// tltlc: allow TLT0419", ["TLT0419", "TLT0427"]),
        (
            "// tltlc: allow TLT0419\n\n\nsignal b: bool\nspec hide { judge at limit avoid seen or b }",
            ["TLT0427", "TLT0419"],
        ),
        ("/// tltlc: allow TLT0419\nspec hide { judge at limit avoid seen }", ["TLT0427", "TLT0419"]),
        ("// tltlc: alow TLT0419\nspec hide { judge at limit avoid seen }", ["TLT0427", "TLT0419"]),
        ("// tltlc: a compiler\nspec hide { judge at limit avoid seen }", ["TLT0419"]),
        ("// tltlc: allow TLT0418\nspec hide { judge at limit avoid seen }", ["TLT0427", "TLT0419"]),
        ("// tltlc: allow\nspec hide { judge at limit avoid seen }", ["TLT0427", "TLT0419"]),
        ("// tltlc: allow because of TLT0419\nspec hide { judge at limit avoid seen }", ["TLT0427", "TLT0419"]),
        ("// tltlc: allow TLT0427, TLT0418\nspec hide = G !seen", []),
    ],
)
def test_a_comment_in_another_place_or_form_silences_nothing(text: str, expected: list[str]) -> None:
    assert codes(BEFORE + text) == expected


@pytest.mark.parametrize(
    ("clauses", "expected"),
    [
        ("reach seen\n        then heard  // ALLOW\n        then (seen implies heard)\n    limit 9 steps\n", []),
        ("reach (seen\n        implies heard) limit 9 steps  // ALLOW\n", []),
        ("limit 9 steps reach (seen  // ALLOW\n        implies heard)\n", []),
        ("reach (seen implies heard)\n    limit 9 steps  // ALLOW\n", ["TLT0412", "TLT0427"]),
        ("// ALLOW\n    limit 9 steps\n    reach (seen implies heard)\n", ["TLT0427", "TLT0412"]),
        ("limit 9 steps\n    reach (seen implies heard)\n    // ALLOW\n", []),
    ],
)
def test_a_comment_applies_to_the_clauses_on_its_line(clauses: str, expected: list[str]) -> None:
    text = f"{BEFORE}signal heard: bool\nspec go {{\n    {clauses}}}\n"
    assert codes(text.replace("ALLOW", "tltlc: allow TLT0412")) == expected


@pytest.mark.parametrize(
    "head", ["spec go {  // ALLOW", "spec go  // ALLOW\n{", "spec go\n// ALLOW\n{", "// ALLOW\nspec go {"]
)
def test_a_comment_at_the_head_of_a_spec_applies_to_the_whole_spec(head: str) -> None:
    text = f"{BEFORE}signal heard: bool\n{head}\n    limit 9 steps\n    reach (seen implies heard)\n}}\n"
    assert codes(text.replace("ALLOW", "tltlc: allow TLT0412")) == []


def test_a_comment_at_the_head_of_a_file_applies_to_the_whole_file() -> None:
    specs = "signal seen: bool\nspec a { avoid seen }\n\nspec b { limit 3 steps avoid seen }\nspec c { reach seen }\n"
    assert codes(specs) == ["TLT0419", "TLT0420", "TLT0419"]
    assert codes(f"// A game.\n// tltlc: allow TLT0419\n\n{specs}") == ["TLT0420"]


def test_warnings_of_the_compiler_can_be_silenced() -> None:
    text = "signal seen: bool\n{}spec odd = F (seen or not seen)\n"
    assert codes(text.format("")) == ["TLT0411"]
    assert codes(text.format("// tltlc: allow TLT0411\n")) == []


def test_a_library_allows_its_own_findings(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    jumpy = "signal x in [0, 9]\n{}predicate p = when x < 5: x / 9 - 1 otherwise: 1\n"
    library = Path("jumpy.tltl")
    library.write_text(jumpy.format(""))
    assert codes("import jumpy\nspec s = F p") == ["TLT0402"]
    assert codes("// tltlc: allow TLT0402\nimport jumpy\nspec s = F p") == ["TLT0402", "TLT0427"]
    library.write_text(jumpy.format("// tltlc: allow TLT0402, TLT0421\n"))
    assert codes("import jumpy\nspec s = F p") == []


def test_an_unused_comment_is_removed() -> None:
    text = "signal seen: bool\n// tltlc: allow TLT0421\nspec hide = G !seen // tltlc: allow TLT0419\n"
    assert apply_fixes(text).source.text == "signal seen: bool\nspec hide = G !seen\n"


def test_a_comment_whose_codes_are_all_unused_is_removed() -> None:
    text = "signal seen: bool\n// tltlc: allow TLT0418, TLT0421\nspec hide = G !seen\n"
    fixed = apply_fixes(text)
    assert fixed.source.text == "signal seen: bool\nspec hide = G !seen\n"
    assert len(fixed.fixed) == 2


def test_a_comment_with_a_used_code_is_kept() -> None:
    text = "signal seen: bool\n// tltlc: allow TLT0419, TLT0421\nspec hide { judge at limit avoid seen }\n"
    assert apply_fixes(text).source.text == text
    assert codes(text) == ["TLT0427"]


@pytest.mark.parametrize("clauses", ["keep seen\n    avoid seen\n    reach seen", "reach true or seen"])
def test_a_comment_is_not_unused_if_its_rule_could_not_run(clauses: str) -> None:
    head = f"{BEFORE}signal heard: bool\nlet used = heard\nspec s {{\n    limit 9 steps\n    "
    text = f"{head}{clauses} implies (heard or not heard)  // tltlc: allow TLT0412 as it is\n}}\n"
    assert set(codes(text)) & {"TLT0410", "TLT0411"} and "TLT0427" not in codes(text)
    assert apply_fixes(text).source.text == text.replace("let used = heard\n", "")
    # Comments on other specs are still checked.
    aside = f"{text}// tltlc: allow TLT0412\nspec t = F seen\n"
    assert "TLT0427" in codes(aside)


LINES = (
    ("// tltlc: allow {codes}\nsignal a: bool\nspec s = F a", "the codes of one comment"),
    ("signal a: bool\nspec s = F a  // tltlc: allow {codes}", "the codes of a comment on a line"),
    ("signal a: bool\n{comments}spec s = F a", "comments above one statement"),
    ("signal a: bool\n{comments}spec s = F a {lets}", "comments above a line of statements"),
    ("signal a: bool\nlet first = F a\n{lines}spec s = F a", "statements with a comment each"),
    ("// tltlc: allow TLT0421\nsignal a: bool\nlet first = F a\n{lets}\nspec s = F a", "findings in an allowed file"),
)


@pytest.mark.parametrize(("text", "case"), LINES, ids=[case for _, case in LINES])
def test_the_work_for_comments_is_linear(text: str, case: str) -> None:
    def work(number: int) -> int:
        source = text.format(
            codes="TLT0421 TLT0420 " * number,
            comments="// tltlc: allow TLT0421\n" * number,
            lets=" ".join(f"let l{index} = F a" for index in range(number)),
            lines="".join(f"let l{index} = F a // tltlc: allow TLT0421, TLT0420\n" for index in range(number)),
        )
        view = view_of(SourceFile("example.tltl", source), CompileOptions())
        spans = [declaration.span for declaration in view.module.declarations]
        findings = [LintFinding(Diagnostic("TLT0421", "unused", (Label(view.source, span),))) for span in spans]
        return calls(lambda: apply_allow_comments(view, findings))

    assert work(800) < 2.5 * work(400), case


def test_every_comment_for_the_same_finding_counts_as_used() -> None:
    comments = "// tltlc: allow TLT0419\n" * 2
    assert (
        codes(f"{comments}{BEFORE}{comments}spec hide {{ judge at limit avoid seen }}  // tltlc: allow TLT0419") == []
    )


def test_a_comment_within_a_statement_applies_to_the_enclosing_statements() -> None:
    text = f"{BEFORE}signal heard: bool\nspec go {{\n    limit 9 steps\n    reach (seen implies heard)  // ALLOW\n}}\n"
    source = text.replace("ALLOW", "tltlc: allow TLT0412, TLT0412 TLT0411")
    assert [finding.diagnostic.title for finding in lint(SourceFile("example.tltl", source))] == [
        "this allows TLT0411, which is not found here"
    ]
