"""A page on which one types a spec and sees what it means, from ``tltlc serve`` or in the browser alone."""

from tltlc.interfaces.playground.page_data import view as view
