"""Comments that silence findings."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.calls import calls
from tests.tools.lint.helpers import codes, mended
from tltlc.core.source import SourceFile
from tltlc.diagnostics.diagnostic import Diagnostic, Label
from tltlc.pipeline import CompileOptions
from tltlc.tools.lint.allow import silenced
from tltlc.tools.lint.rule import Finding
from tltlc.tools.lint.run import lint, view_of

BEFORE = "signal seen: bool\n"


@pytest.mark.parametrize(
    "text",
    [
        "spec hide { avoid seen }  // tltlc: allow TLT0419",
        "// tltlc: allow TLT0419\nspec hide { avoid seen }",
        "//tltlc:allow TLT0419 nobody plays this\n/// Unseen.\n// Twice.\nspec hide { avoid seen }",
        "// tltlc: allow TLT0421\n// tltlc: allow TLT0419\nsignal heard: bool spec hide { avoid seen }",
        "// tltlc: allow TLT0419, TLT0421\nsignal heard: bool spec hide { avoid seen }",
        "// tltlc: allow TLT0419 TLT0421: both\nsignal heard: bool spec hide { avoid seen }",
        "signal heard: bool\nspec go {\n    limit 9 steps\n    reach seen\n        then (not seen)\n"
        "        then (seen implies heard)  // tltlc: allow TLT0412\n}",
        "signal heard: bool\nspec go {\n    limit 9 steps\n    reach seen\n        then (seen implies heard)\n"
        "}  // tltlc: allow TLT0412",
        # A rule whose findings are errors can be silenced; the compiler cannot.
        "signal x in [0, 50]\npredicate never in [-1, 0] = -x / 50\n"
        "spec go {\n    limit 9 steps\n    reach never or seen  // tltlc: allow TLT0416\n}",
        # Empty lines do not matter.
        "signal heard: bool\n// tltlc: allow TLT0419\n\nspec hide { avoid seen or heard }",
    ],
)
def test_what_is_allowed_is_not_said(text: str) -> None:
    assert codes(BEFORE + text) == []


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("spec hide { avoid seen }\n// tltlc: allow TLT0419", ["TLT0419", "TLT0427"]),
        ("// tltlc: allow TLT0419\n\n\nsignal b: bool\nspec hide { avoid seen or b }", ["TLT0427", "TLT0419"]),
        ("/// tltlc: allow TLT0419\nspec hide { avoid seen }", ["TLT0427", "TLT0419"]),
        ("// tltlc: alow TLT0419\nspec hide { avoid seen }", ["TLT0427", "TLT0419"]),
        ("// tltlc: a compiler\nspec hide { avoid seen }", ["TLT0419"]),
        ("// tltlc: allow TLT0418\nspec hide { avoid seen }", ["TLT0427", "TLT0419"]),
        ("// tltlc: allow\nspec hide { avoid seen }", ["TLT0427", "TLT0419"]),
        ("// tltlc: allow because of TLT0419\nspec hide { avoid seen }", ["TLT0427", "TLT0419"]),
        ("// tltlc: allow TLT0427, TLT0418\nspec hide = G !seen", []),
    ],
)
def test_what_is_allowed_elsewhere_is_said(text: str, expected: list[str]) -> None:
    assert codes(BEFORE + text) == expected


@pytest.mark.parametrize(
    ("clauses", "expected"),
    [
        ("reach heard\n        then heard  // ALLOW\n        then (seen implies heard)\n    limit 9 steps\n", []),
        ("reach (seen\n        implies heard) limit 9 steps  // ALLOW\n", []),
        ("limit 9 steps reach (seen  // ALLOW\n        implies heard)\n", []),
        ("reach (seen implies heard)\n    limit 9 steps  // ALLOW\n", ["TLT0412", "TLT0427"]),
        ("// ALLOW\n    limit 9 steps\n    reach (seen implies heard)\n", ["TLT0427", "TLT0412"]),
        ("limit 9 steps\n    reach (seen implies heard)\n    // ALLOW\n", []),
    ],
)
def test_a_comment_speaks_of_the_clauses_on_its_line(clauses: str, expected: list[str]) -> None:
    text = f"{BEFORE}signal heard: bool\nspec go {{\n    {clauses}}}\n"
    assert codes(text.replace("ALLOW", "tltlc: allow TLT0412")) == expected


@pytest.mark.parametrize(
    "head", ["spec go {  // ALLOW", "spec go  // ALLOW\n{", "spec go\n// ALLOW\n{", "// ALLOW\nspec go {"]
)
def test_at_the_head_of_a_spec_for_all_of_it(head: str) -> None:
    text = f"{BEFORE}signal heard: bool\n{head}\n    limit 9 steps\n    reach (seen implies heard)\n}}\n"
    assert codes(text.replace("ALLOW", "tltlc: allow TLT0412")) == []


def test_at_the_head_of_a_file_for_all_of_it() -> None:
    specs = "signal seen: bool\nspec a { avoid seen }\n\nspec b { limit 3 steps avoid seen }\nspec c { reach seen }\n"
    assert codes(specs) == ["TLT0419", "TLT0420", "TLT0419"]
    assert codes(f"// A game.\n// tltlc: allow TLT0419\n\n{specs}") == ["TLT0420"]


def test_warnings_of_the_compiler_are_silenced_as_well() -> None:
    text = "signal seen: bool\n{}spec odd = F (seen or not seen)\n"
    assert codes(text.format("")) == ["TLT0411"]
    assert codes(text.format("// tltlc: allow TLT0411\n")) == []


def test_a_library_allows_what_is_in_it(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    jumpy = "signal x in [0, 9]\n{}predicate p = when x < 5: x / 9 - 1 otherwise: 1\n"
    library = Path("jumpy.tltl")
    library.write_text(jumpy.format(""))
    assert codes("import jumpy\nspec s = F p") == ["TLT0402"]
    assert codes("// tltlc: allow TLT0402\nimport jumpy\nspec s = F p") == ["TLT0402", "TLT0427"]
    library.write_text(jumpy.format("// tltlc: allow TLT0402, TLT0421\n"))
    assert codes("import jumpy\nspec s = F p") == []


def test_a_comment_in_vain_is_removed() -> None:
    text = "signal seen: bool\n// tltlc: allow TLT0421\nspec hide = G !seen // tltlc: allow TLT0419\n"
    assert mended(text).source.text == "signal seen: bool\nspec hide = G !seen\n"


def test_a_comment_of_which_nothing_is_needed_is_removed() -> None:
    text = "signal seen: bool\n// tltlc: allow TLT0418, TLT0421\nspec hide = G !seen\n"
    fixed = mended(text)
    assert fixed.source.text == "signal seen: bool\nspec hide = G !seen\n"
    assert len(fixed.fixed) == 2


def test_a_comment_that_is_needed_for_something_stays() -> None:
    text = "signal seen: bool\n// tltlc: allow TLT0419, TLT0421\nspec hide { avoid seen }\n"
    assert mended(text).source.text == text
    assert codes(text) == ["TLT0427"]


@pytest.mark.parametrize("clauses", ["keep seen\n    avoid seen\n    reach seen", "reach true or seen"])
def test_what_no_rule_could_judge_is_not_in_vain(clauses: str) -> None:
    head = f"{BEFORE}signal heard: bool\nlet used = heard\nspec s {{\n    limit 9 steps\n    "
    text = f"{head}{clauses} implies (heard or not heard)  // tltlc: allow TLT0412 as it is\n}}\n"
    assert set(codes(text)) & {"TLT0410", "TLT0411"} and "TLT0427" not in codes(text)
    assert mended(text).source.text == text.replace("let used = heard\n", "")
    # Beside that spec, comments are judged as ever.
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


@pytest.mark.parametrize(("text", "what"), LINES, ids=[what for _, what in LINES])
def test_the_work_of_comments_grows_with_the_text(text: str, what: str) -> None:
    def work(number: int) -> int:
        written = text.format(
            codes="TLT0421 TLT0420 " * number,
            comments="// tltlc: allow TLT0421\n" * number,
            lets=" ".join(f"let l{index} = F a" for index in range(number)),
            lines="".join(f"let l{index} = F a // tltlc: allow TLT0421, TLT0420\n" for index in range(number)),
        )
        view = view_of(SourceFile("example.tltl", written), CompileOptions())
        spans = [each.span for each in view.module.declarations]
        said = [Finding(Diagnostic("TLT0421", "unused", (Label(view.source, span),))) for span in spans]
        return calls(lambda: silenced(view, said))

    assert work(800) < 2.5 * work(400), what


def test_each_comment_that_silences_the_same_is_needed() -> None:
    comments = "// tltlc: allow TLT0419\n" * 2
    assert codes(f"{comments}{BEFORE}{comments}spec hide {{ avoid seen }}  // tltlc: allow TLT0419") == []


def test_a_comment_within_a_statement_speaks_of_all_around_it() -> None:
    text = f"{BEFORE}signal heard: bool\nspec go {{\n    limit 9 steps\n    reach (seen implies heard)  // ALLOW\n}}\n"
    found = text.replace("ALLOW", "tltlc: allow TLT0412, TLT0412 TLT0411")
    assert [each.diagnostic.title for each in lint(SourceFile("example.tltl", found))] == [
        "this allows TLT0411, which is not found here"
    ]
