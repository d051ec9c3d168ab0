import pytest

from tltlc.diagnostics.code_pages import codes, page, title


def test_codes_are_in_order_and_have_titles() -> None:
    assert list(codes()) == sorted(set(codes()))
    assert "TLT0101" in codes()
    assert title("TLT0102") == "an operand of `then` can be read in two ways"
    assert page("TLT0102").startswith("# TLT0102: an operand")


@pytest.mark.parametrize("code", ["TLT9999", "", "../codes", "tlt0101"])
def test_an_unknown_code_is_an_error(code: str) -> None:
    with pytest.raises(KeyError):
        page(code)
