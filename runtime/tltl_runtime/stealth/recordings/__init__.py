"""Episodes: recorded, kept in files, checked and summed up."""
