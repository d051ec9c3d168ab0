"""The commands that the runtime adds to `tltlc`, one module each.  Only they print."""
