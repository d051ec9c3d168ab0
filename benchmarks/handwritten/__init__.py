"""Handwritten monitors of the paper's three specs, as a careful programmer would write them without a compiler."""
