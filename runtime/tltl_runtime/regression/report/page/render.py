"""Render the HTML templates of the page, in the folder ``templates``.

Templates contain layout only. The other modules of the page compute the values.
"""

from __future__ import annotations

from functools import cache
from pathlib import Path
from typing import Final

from jinja2 import Environment, FileSystemLoader, StrictUndefined
from markupsafe import Markup

from tltl_runtime.support.markup import prose

_FOLDER: Final = Path(__file__).parent / "templates"


def render(template: str, **context: object) -> Markup:
    """Fill in the template in the file ``template`` with the values ``context``, and return the HTML.

    Values are escaped unless they are :class:`Markup`. The filter ``prose`` formats sentences.

    Raises:
        jinja2.UndefinedError: the template uses a name that is not in the context.
    """
    return Markup(_environment().get_template(template).render(context))


@cache
def _environment() -> Environment:
    environment = Environment(
        loader=FileSystemLoader(_FOLDER),
        autoescape=True,
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
    )
    environment.filters["prose"] = prose
    return environment
