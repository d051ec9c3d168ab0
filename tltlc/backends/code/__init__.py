"""Code shared by monitors that are written as source code: the functions of the states."""
