"""A page that shows what a spec means while you type it.

The compiler runs on the server of ``tltlc serve``, or in the browser. Begin with `page_data.view`.
"""

from tltlc.interfaces.playground.page_data import view as view
