"""The playground: a web page that shows the meaning of a spec while you type it.

The compiler runs on the server of ``tltlc serve``, or in the browser. Begin with `page_data.view`.
"""

from tltlc.interfaces.playground.page_data import view as view
