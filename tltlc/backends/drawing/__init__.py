"""Code that the targets for pictures share: texts, folded states and the layout.

The targets call `layout.draw`, so begin to read there.
"""
