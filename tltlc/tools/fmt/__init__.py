"""The formatter: one layout for every source text, with operators in one of four styles.

Begin with :mod:`tltlc.tools.fmt.format`.
"""

from tltlc.logic.text.style import STYLES as STYLES
from tltlc.tools.fmt.format import format_source as format_source
from tltlc.tools.fmt.format import format_text as format_text
