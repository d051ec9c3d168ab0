"""Records, source texts and the places in them."""
