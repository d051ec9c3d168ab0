"""Commands that the runtime adds to `tltlc`, one module each; they alone print."""
