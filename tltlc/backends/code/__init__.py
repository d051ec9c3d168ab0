"""What monitors written as source code share: safe names, safe comments, and the text of each state."""
