"""A page that shows what a spec means while you type it.

It runs from ``tltlc serve`` or fully in the browser.
"""

from tltlc.interfaces.playground.page_data import view as view
