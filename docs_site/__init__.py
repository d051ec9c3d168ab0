"""The documentation as a site: pages made of what the code says, beside those of ``docs/``; ``make docs`` builds it."""
