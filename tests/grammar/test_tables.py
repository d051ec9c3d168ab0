import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest

from tltlc.grammar import tables


@pytest.fixture
def fresh_tables() -> Iterator[None]:
    tables.load.cache_clear()
    yield
    tables.load.cache_clear()


def test_the_shipped_tables_match_the_grammar() -> None:
    """Lark builds the tables in strict mode, so this test also fails if the grammar has a conflict."""
    shipped = Path(tables.TABLES).read_text(encoding="utf-8")
    assert tables.as_text(tables.build(Path(tables.GRAMMAR).read_bytes())) == shipped


@pytest.mark.parametrize("content", [b"", b"{}", b"[]", b'{"checksum": 0}', b"\xff\x00"])
def test_damaged_tables_are_rebuilt(
    fresh_tables: None, content: bytes, tmp_path_factory: pytest.TempPathFactory, monkeypatch: pytest.MonkeyPatch
) -> None:
    good = tables.load()
    tables.load.cache_clear()
    path = tmp_path_factory.mktemp("tables") / "tables.json"
    path.write_bytes(content)
    monkeypatch.setattr(tables, "TABLES", str(path))
    assert tables.load() == good


def test_a_conflict_of_the_grammar_is_an_error() -> None:
    with pytest.raises(Exception, match="conflict"):
        tables.build(b'module: e\n?declaration: e\nclause: e\ntest_item: e\nexpression: e\ne: e "+" e | "a"\n')


def test_parsing_needs_no_lark() -> None:
    code = (
        "import sys; from tltlc.grammar.parser import parse; from tltlc.core.source import SourceFile;"
        "parse(SourceFile('a', 'spec a = F b')); parse(SourceFile('a', 'spec a = F'));"
        "print([name for name in ('lark', 'sympy', 'pathlib') if name in sys.modules])"
    )
    result = subprocess.run([sys.executable, "-S", "-c", code], capture_output=True, text=True, check=True)
    assert result.stdout == "[]\n"
