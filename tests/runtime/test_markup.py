"""Elements of the page: all text is escaped."""

from __future__ import annotations

import json
from typing import Any

from hypothesis import given
from hypothesis import strategies as st
from markupsafe import Markup

from tltl_runtime.support.markup import coordinate, element, prose, script_json

JSON = st.recursive(
    st.none() | st.booleans() | st.integers() | st.text(),
    lambda inner: st.lists(inner, max_size=3) | st.dictionaries(st.text(), inner, max_size=3),
    max_leaves=8,
)


def test_texts_and_attributes_are_escaped() -> None:
    markup = element("p", "a < b & c", element("b", "bold"), title='"<&', class_="one", data_row=3)
    assert markup == '<p title="&quot;&lt;&amp;" class="one" data-row="3">a &lt; b &amp; c<b>bold</b></p>'


def test_the_parts_of_an_element_are_escaped_one_by_one() -> None:
    assert element("g", "<", Markup("<path></path>"), 7) == "<g>&lt;<path></path>7</g>"


def test_names_between_backquotes_are_code() -> None:
    assert prose("near `s<1>` & `b`") == "near <code>s&lt;1&gt;</code> &amp; <code>b</code>"
    assert prose("a ` alone") == "a ` alone"


def test_numbers_are_short() -> None:
    assert [coordinate(value) for value in (1.0, 1.256, -0.001, 10.5, 100.0)] == ["1", "1.26", "0", "10.5", "100"]


@given(JSON)
def test_json_in_a_script_is_unchanged_and_does_not_end_the_script(data: Any) -> None:
    text = script_json(data)
    assert json.loads(text) == data
    assert not set("<>&\u2028\u2029") & set(text)


def test_a_closing_script_tag_in_data_is_escaped() -> None:
    assert script_json("</script><b><!--") == '"\\u003c/script\\u003e\\u003cb\\u003e\\u003c!--"'
