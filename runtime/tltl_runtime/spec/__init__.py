"""A spec ready for episodes: its task, and wrappers that judge and reward episodes by it."""
