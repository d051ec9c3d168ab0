"""The layout of source texts: one way to write each of them, in four styles of operators."""

from tltlc.tools.fmt.format import format_source as format_source
from tltlc.tools.fmt.format import format_text as format_text
from tltlc.tools.fmt.style import STYLES as STYLES
