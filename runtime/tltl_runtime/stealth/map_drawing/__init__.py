"""Maps of levels as SVG, and recorded episodes as data, for HTML reports."""
