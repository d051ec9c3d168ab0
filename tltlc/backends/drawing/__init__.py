"""Code that the targets for pictures share: texts, folded states and the layout.

Begin with `layout.draw`.
"""
