"""The commands that the runtime adds to `tltlc`, one module each.

No other package of the runtime prints.
"""
