"""Where imports are found, which names they offer, and how they fail."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.calls import calls
from tests.resolve.helpers import only_spec, resolve_text, valid_program, write
from tltlc.core.source import SourceFile
from tltlc.grammar.parser import parse
from tltlc.io.limits import IMPORTED
from tltlc.resolve.imports import imported_files, library_with, standard_library
from tltlc.resolve.options import ResolveOptions
from tltlc.resolve.resolution import resolve
from tltlc.resolve.spec import Spec


def _codes(folder: Path, text: str, **options: object) -> list[str]:
    return [d.code for d in resolve_text(text, str(folder / "main.tltl"), **options)[1]]


def _spec(folder: Path, text: str, **options: object) -> Spec:
    return only_spec(text, str(folder / "main.tltl"), **options)


def test_imports_search_the_own_folder_then_libraries_then_the_standard_library(tmp_path: Path) -> None:
    own, extra = tmp_path / "own", tmp_path / "extra"
    own.mkdir()
    extra.mkdir()
    write(extra, lib="signal b: bool let goal = F b", stealth="signal mine: bool")
    text = "import lib spec s = goal"
    assert str(_spec(own, text, library_dirs=(extra,)).formula) == "F b"
    write(own, lib="signal a: bool let goal = F a")
    assert str(_spec(own, text, library_dirs=(extra,)).formula) == "F a"
    assert str(_spec(own, "import stealth spec s = F mine", library_dirs=(extra,)).formula) == "F mine"
    assert str(_spec(own, "import stealth spec s = G alive").formula) == "G alive"


def test_a_file_is_found_relative_to_the_one_that_imports_it(tmp_path: Path) -> None:
    (tmp_path / "levels").mkdir()
    (tmp_path / "parts").mkdir()
    write(tmp_path, common='import "parts/doors.tltl"')
    write(tmp_path / "parts", doors="entity door import shut", shut="signal shut(d: entity): bool")
    assert str(_spec(tmp_path / "levels", 'import "../common.tltl" spec s = F shut(door)').formula) == "F shut(door)"


def test_imports_are_transitive_and_each_file_is_read_once(tmp_path: Path) -> None:
    write(tmp_path, a="import c", b="import c", c="signal x: bool let goal = F x")
    assert str(_spec(tmp_path, "import a import b import c spec s = goal").formula) == "F x"


def test_importing_selected_names_imports_nothing_else(tmp_path: Path) -> None:
    text = "import stealth (near) entity e signal alive: bool spec s = F near(e) & G alive"
    spec = _spec(tmp_path, text)
    assert [signal.name for signal in spec.signals] == ["distance(e)", "alive"]


def test_an_alias_is_not_part_of_the_names_of_atoms(tmp_path: Path) -> None:
    spec = _spec(tmp_path, "import stealth as st entity e spec s = F st.near(e, close = 3 m) & F st.seen")
    assert [atom.name for atom in spec.atoms] == ["near(e, close=3)", "seen"]
    assert [signal.name for signal in spec.signals] == ["distance(e)", "seen"]
    assert _codes(tmp_path, "import stealth as st entity e spec s = F near(e)") == ["TLT0201"]


def test_the_origin_in_a_suggestion_is_the_import_of_this_file() -> None:
    _, (diagnostic,) = resolve_text("import stealth entity e spec s = F neer(e)")
    assert diagnostic.labels[0].message == "did you mean `near` (from stealth)?"


def test_identical_declarations_merge_whichever_comes_first(tmp_path: Path) -> None:
    write(tmp_path, lib="signal distance(x: entity): length in [0 m, 50 m] param p: ratio in [0, 0.5] = 20 %")
    for text in (
        "signal distance(target: entity): length param p: ratio = 0.2",
        "signal distance(target: entity): length in [0 m, 50 m] param p: ratio in [0, 50 %] = 0.2",
    ):
        spec = _spec(tmp_path, f"import lib {text} entity e spec s = F distance(e) > 10 m")
        assert (spec.signals[0].low, spec.signals[0].high) == (0.0, 50.0)


@pytest.mark.parametrize(
    "text",
    [
        "signal health in [0, 1]",
        "signal health: ratio in [0, 0.5]",
        "signal health(x: entity): ratio",
        "param level_size: length in [2 m, 10 km] = 21 m",
        "param level_size: length in [2 m, 9 km] = 20 m",
    ],
)
def test_different_declarations_are_an_error_that_shows_both(text: str) -> None:
    _, (diagnostic,) = resolve_text(f"import stealth {text} spec s = true")
    assert diagnostic.code == "TLT0204"
    assert [label.source.name.split("/")[0] for label in diagnostic.labels] == ["<test>", "<standard library>"]


def test_every_source_has_its_kind(tmp_path: Path) -> None:
    write(tmp_path, own="import stealth")
    module, _ = parse(SourceFile(str(tmp_path / "main.tltl"), "import own"))
    *libraries, own, main = (loaded.module.source for loaded in resolve(module).modules)
    assert (own.kind, own.location) == ("file", own.name)
    assert main.kind == "file"
    assert {library.kind for library in libraries} == {"standard library"}
    assert Path(libraries[-1].location) == standard_library().absolute() / "stealth.tltl"


def test_the_path_of_a_file_may_begin_with_an_angle_bracket(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    folder = tmp_path / "<levels>"
    folder.mkdir()
    write(folder, own="signal x: bool")
    monkeypatch.chdir(tmp_path)
    _, diagnostics = resolve_text("import own spec s = F x", "<levels>/main.tltl")
    assert diagnostics == ()


def test_imported_files_are_where_the_resolution_finds_them(tmp_path: Path) -> None:
    own, extra = tmp_path / "own", tmp_path / "extra"
    own.mkdir()
    extra.mkdir()
    write(extra, lib="signal b: bool")
    source = SourceFile(str(own / "main.tltl"), 'import lib import stealth import "../part.tltl" spec s = F (')
    paths = list(imported_files(source, (extra,)))
    library = standard_library() / "stealth.tltl"
    searched = [own / "lib.tltl", extra / "lib.tltl", own / "stealth.tltl", extra / "stealth.tltl", library]
    assert paths == [*searched, own / "../part.tltl"]
    write(own, lib="signal a: bool")
    assert next(imported_files(source, (extra,))) == own / "lib.tltl"
    module, _ = parse(SourceFile(str(own / "main.tltl"), "import lib"))
    loaded = resolve(module, ResolveOptions(library_dirs=(extra,))).modules[0].module.source
    assert Path(loaded.location) == own / "lib.tltl"


def test_a_cycle_of_imports_is_named(tmp_path: Path) -> None:
    write(tmp_path, a="import b", b="import c", c="import a")
    _, (diagnostic,) = resolve_text("import a spec s = true", str(tmp_path / "main.tltl"))
    assert (diagnostic.code, diagnostic.title) == ("TLT0011", "imports form a cycle: a -> b -> c -> a")
    assert len(diagnostic.labels) == 3


def test_a_long_chain_of_imports_is_followed(tmp_path: Path) -> None:
    write(tmp_path, **{f"m{i}": f"import m{i + 1}" for i in range(1500)}, m1500="signal x: bool")
    assert str(_spec(tmp_path, "import m0 spec s = F x").formula) == "F x"


def test_a_failed_import_is_the_only_error(tmp_path: Path) -> None:
    (tmp_path / "latin.tltl").write_bytes("signal caf\xe9: bool".encode("latin-1"))
    write(tmp_path, broken="signal : bool", outer="import broken")
    assert _codes(tmp_path, "import nowhere spec s = F nothing(x) > 3 m") == ["TLT0010"]
    assert _codes(tmp_path, 'import "nowhere.tltl" spec s = F nothing') == ["TLT0010"]
    assert _codes(tmp_path, "import latin spec s = F nothing") == ["TLT0002"]
    assert len(_codes(tmp_path, "import outer spec s = F nothing")) == 1
    _, (diagnostic,) = resolve_text("import latin spec s = true", str(tmp_path / "main.tltl"))
    assert [label.source.name.endswith("main.tltl") for label in diagnostic.labels] == [False, True]


def test_odd_targets_are_not_found(tmp_path: Path) -> None:
    for target in ("..", "/", "a" * 5000, "", "nul\0"):
        assert _codes(tmp_path, f'import "{target}" spec s = true')[0] in ("TLT0010", "TLT0001")


@pytest.mark.parametrize("target", ["man", '"man.tltl"'])
def test_a_file_is_not_suggested_as_its_own_import(tmp_path: Path, target: str) -> None:
    write(tmp_path, main="")
    (diagnostic,) = resolve_text(f"import {target}", str(tmp_path / "main.tltl"))[1]
    assert (diagnostic.code, "did you mean" in (diagnostic.help or "")) == ("TLT0010", False)


def test_specs_and_tests_of_an_import_are_not_imported(tmp_path: Path) -> None:
    write(tmp_path, lib='signal a: bool spec there = F a test "t" for there { step a expect satisfied }')
    program = valid_program("import lib spec here = F a", str(tmp_path / "main.tltl"))
    assert [spec.name for spec in program.specs] == ["here"]
    assert program.tests == ()


def test_the_suggested_prefix_resolves_a_clash_of_names(tmp_path: Path) -> None:
    write(tmp_path, orbit="signal a: bool let goal = F a")
    clash = "signal b: bool let goal = G b"
    for target, proposed in ((' "./orbit.tltl"', 'import "./orbit.tltl" as lib'), (" orbit", "import orbit as lib")):
        (error,) = resolve_text(f"import{target} {clash}", str(tmp_path / "main.tltl"))[1]
        assert proposed in (error.help or "")
        assert _codes(tmp_path, f"{proposed} {clash} spec s = goal & lib.goal") == []


def test_a_library_is_suggested_for_a_name_that_it_declares() -> None:
    assert library_with("near") == "spatial"
    assert library_with("nea") is None
    assert library_with("no_such_name") is None


def test_the_standard_library_is_read_once_for_all_unknown_names() -> None:
    library_with("near")
    work = calls(lambda: [library_with(f"no_such_name_{number}") for number in range(1_000)])
    assert work < 20_000


def _write_doubling_chain(folder: Path, files: int) -> None:
    """Write a chain of files, each of which imports the next one under two aliases; the last declares names."""
    both = {f"m{i}": f"import m{i + 1} as x import m{i + 1} as y" for i in range(files)}
    write(folder, **both, **{f"m{files}": "signal a: bool let goal = F a"})


def test_exponentially_many_imported_names_are_one_error(tmp_path: Path) -> None:
    _write_doubling_chain(tmp_path, 40)
    _, (diagnostic,) = resolve_text("import m0 spec s = F nothing", str(tmp_path / "main.tltl"))
    assert (diagnostic.code, diagnostic.title) == (
        "TLT0012",
        f"the imports of all files offer more than {IMPORTED.values:,} names",
    )
    (label,) = diagnostic.labels
    assert label.source.slice(label.span).startswith("import m")


def test_imported_names_are_counted_before_they_are_created(tmp_path: Path) -> None:
    _write_doubling_chain(tmp_path, 40)
    assert calls(lambda: resolve_text("import m0", str(tmp_path / "main.tltl"))) < 40 * (IMPORTED.values or 0)


def test_files_within_the_limit_keep_all_their_names(tmp_path: Path) -> None:
    _write_doubling_chain(tmp_path, 10)
    name = "x.y.x.y.x.y.x.y.x.y.goal"
    assert str(_spec(tmp_path, f"import m0 spec s = {name}").formula) == "F a"


def test_every_import_of_a_file_counts_its_names(tmp_path: Path) -> None:
    # Each import has a hundredth of the names that are allowed in total.
    many = (IMPORTED.values or 0) // 100
    write(tmp_path, many=f"entity {', '.join(f'e{i}' for i in range(many))}")
    hundred = "\n".join(f"import many as m{i}" for i in range(100))
    assert _codes(tmp_path, hundred) == []
    assert _codes(tmp_path, f"{hundred}\nimport many (e0)") == ["TLT0012"]


def test_long_aliases_are_rejected(tmp_path: Path) -> None:
    many = 1_000
    write(tmp_path, many=f"entity {', '.join(f'e{i}' for i in range(many))}")
    assert _codes(tmp_path, f"import many as {'x' * (IMPORTED.size // many - 10)}") == []
    assert _codes(tmp_path, f"import many as {'x' * (IMPORTED.size // many)}") == ["TLT0012"]
