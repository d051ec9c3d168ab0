"""``tltlc lsp`` on the command line."""

from __future__ import annotations

import sys

import pytest

from tltlc.interfaces.cli.main import main


def test_a_missing_package_is_reported_with_the_command_that_installs_it(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    for module in ("pygls", "pygls.lsp", "pygls.lsp.server"):
        monkeypatch.setitem(sys.modules, module, None)
    with pytest.raises(SystemExit) as ended:
        main(["lsp"])
    assert ended.value.code == 4
    message = capsys.readouterr().err
    assert "error[TLT0730]: `tltlc lsp` needs `pygls" in message
    assert "'.[lsp]'" in message
