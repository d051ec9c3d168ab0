"""The documentation as a site: the pages of ``docs/``, and pages made from the code. ``make docs`` builds it."""
