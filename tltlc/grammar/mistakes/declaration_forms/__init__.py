"""Read declarations in the forms of other languages, such as ``rate 30 fps`` and ``signal alert: {calm, alarmed}``."""
