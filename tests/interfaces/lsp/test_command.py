"""``tltlc lsp`` on a command line."""

from __future__ import annotations

import sys

import pytest

from tltlc.interfaces.cli.main import main


def test_what_is_missing_is_said_with_the_way_to_install_it(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    for module in ("pygls", "pygls.lsp", "pygls.lsp.server"):
        monkeypatch.setitem(sys.modules, module, None)
    with pytest.raises(SystemExit) as ended:
        main(["lsp"])
    assert ended.value.code == 4
    said = capsys.readouterr().err
    assert "error[TLT0730]: `tltlc lsp` needs `pygls" in said
    assert "'.[lsp]'" in said
