from math import inf
from pathlib import Path

from tltlc.core.source import SourceFile
from tltlc.grammar import tree
from tltlc.grammar.parser import parse

TEXT = Path(__file__).with_name("everything.tltl").read_text(encoding="utf-8")


def read(text: str) -> tuple[tree.Declaration, ...]:
    module, diagnostics = parse(SourceFile("a.tltl", text))
    assert diagnostics == ()
    return module.declarations


def test_every_kind_of_declaration_is_parsed() -> None:
    kinds = [type(declaration).__name__ for declaration in read(TEXT)]
    assert kinds == (
        ["Import"] * 4
        + ["SignalDecl"] * 5
        + ["EntityDecl", "ParamDecl", "ClockDecl", "PredicateDecl", "PredicateDecl", "LetDecl", "ExclusiveDecl"]
        + ["SpecDecl", "SpecDecl", "TestDecl"]
    )


def test_newlines_do_not_matter() -> None:
    code = "\n".join(line for line in TEXT.splitlines() if not line.strip().startswith("//"))
    kinds = [type(declaration) for declaration in read(TEXT)]
    assert [type(declaration) for declaration in read(" ".join(code.split()))] == kinds
    title = '"the exit first does not count"'
    spread = "\r\n".join(code.replace(title, '"a_title"').replace('"G alive"', '"G"').split())
    assert [type(declaration) for declaration in read(spread)] == kinds


def test_an_import_has_its_target_names_and_alias() -> None:
    plain, chosen, alias, path = (item for item in read(TEXT) if isinstance(item, tree.Import))
    assert (plain.target, plain.is_path, plain.names, plain.alias) == ("stealth", False, None, None)
    assert chosen.target == "spatial.areas"
    assert chosen.names is not None
    assert [name.name for name in chosen.names] == ["near", "inside"]
    assert alias.alias == "st"
    assert (path.target, path.is_path) == ("../common.tltl", True)


def test_signals_and_params_have_types_ranges_and_values() -> None:
    _, distance, speed, phase, mode = (item for item in read(TEXT) if isinstance(item, tree.SignalDecl))
    assert [(item.name, item.type) for item in distance.parameters] == [("target", "entity")]
    assert distance.doc == "How far away."
    assert distance.interval is not None
    assert isinstance(distance.interval.high, tree.NumberExpr)
    assert distance.interval.high.value == inf
    assert speed.type is None
    assert (phase.type, phase.values) == ("int", ())
    assert (mode.type, [value.name for value in mode.values]) == ("int", ["idle", "alert", "chase"])
    (param,) = (item for item in read(TEXT) if isinstance(item, tree.ParamDecl))
    assert (param.name, param.type) == ("level_size", "length")
    assert isinstance(param.value, tree.NumberExpr)
    assert (param.value.value, param.value.unit) == (20, "m")


def test_infinity_has_a_sign() -> None:
    (signal,) = read("signal a in [-inf, inf]")
    assert isinstance(signal, tree.SignalDecl)
    assert signal.interval is not None
    assert isinstance(signal.interval.low, tree.Unary)
    assert isinstance(signal.interval.low.operand, tree.NumberExpr)
    assert signal.interval.low.operand.value == inf


def test_a_predicate_has_its_documentation_parameters_and_cases() -> None:
    near, _ = (item for item in read(TEXT) if isinstance(item, tree.PredicateDecl))
    assert near.doc == "Closeness to `target`:\n1 at it, -1 far away."
    assert [item.name for item in near.parameters] == ["target", "close", "far"]
    assert isinstance(near.body, tree.WhenExpr)
    assert len(near.body.cases) == 2


def test_a_spec_has_its_clauses_in_order() -> None:
    block, formula = (item for item in read(TEXT) if isinstance(item, tree.SpecDecl))
    assert block.block
    assert block.doc == "Button 1, then button 2, then the exit."
    kinds = [clause.kind for clause in block.clauses]
    assert kinds == [
        "level",
        "limit",
        "judge",
        "semantics",
        "tag",
        "reach",
        "keep",
        "avoid",
        "require",
        "require",
        "require",
    ]
    by_kind = {clause.kind: clause for clause in block.clauses}
    assert isinstance(by_kind["judge"].value, tree.NameExpr)
    assert by_kind["judge"].value.name == "limit"
    assert isinstance(by_kind["tag"].value, tuple)
    assert [name.name for name in by_kind["tag"].value] == ["paper", "stealth"]
    assert by_kind["reach"].doc == "The way."
    assert by_kind["keep"].doc == ""
    assert not formula.block
    assert [clause.kind for clause in formula.clauses] == ["require"]


def test_a_test_block_has_steps_and_expectations() -> None:
    (test,) = (item for item in read(TEXT) if isinstance(item, tree.TestDecl))
    assert (test.title, test.spec.name) == ("the exit first does not count", "cover_and_hide")
    steps = [item for item in test.items if isinstance(item, tree.TestStep)]
    expects = [item for item in test.items if isinstance(item, tree.TestExpect)]
    assert [(step.times, len(step.atoms)) for step in steps] == [(1, 2), (1, 2), (3, 2)]
    assert [(item.kind, item.value, item.comparison) for item in expects] == [
        ("verdict", "pending", None),
        ("progress", 0.5, ">="),
        ("state", "G alive", None),
    ]


def test_words_of_tests_are_names_elsewhere() -> None:
    test, _ = read('test "t" for x { step 3x x, step expect progress >= 50 % step step expect holding } entity step')
    assert isinstance(test, tree.TestDecl)
    assert [type(item).__name__ for item in test.items] == ["TestStep", "TestExpect", "TestStep", "TestExpect"]
    assert isinstance(test.items[1], tree.TestExpect)
    assert test.items[1].value == 0.5


def test_numbers_of_a_test_keep_their_place_and_spelling() -> None:
    source = SourceFile("a.tltl", 'test "t" for x { step x step 007x x expect progress >= 5.0% expect pending }')
    (test,) = parse(source)[0].declarations
    assert isinstance(test, tree.TestDecl)
    steps = [item for item in test.items if isinstance(item, tree.TestStep)]
    assert [step.times_span and source.slice(step.times_span) for step in steps] == [None, "007"]
    progress, verdict = (item for item in test.items if isinstance(item, tree.TestExpect))
    assert progress.number is not None
    assert (progress.number.value, source.slice(progress.number.span), progress.value) == (5, "5.0%", 0.05)
    assert verdict.number is None


def test_comments_are_kept_in_order() -> None:
    module, _ = parse(SourceFile("a.tltl", "// one \n/// two\nentity a // three"))
    assert [comment.text for comment in module.comments] == ["// one", "/// two", "// three"]
    for comment in module.comments:
        assert module.source.slice(comment.span) == comment.text


def test_byte_order_marks_and_unusual_spaces_are_ignored() -> None:
    assert len(read("\ufeffentity\u00a0a,\tb\r\n\fentity c")) == 2
    assert read("") == ()
    assert read("// nothing") == ()


def test_a_comment_ends_at_every_kind_of_line_break() -> None:
    for end in ("\n", "\r\n", "\r"):
        module, errors = parse(SourceFile("a.tltl", f"// one{end}signal a: bool{end}/// two{end}spec s = F a{end}"))
        assert errors == ()
        assert [type(declaration).__name__ for declaration in module.declarations] == ["SignalDecl", "SpecDecl"]
        assert [comment.text for comment in module.comments] == ["// one", "/// two"]
