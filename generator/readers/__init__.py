"""Readers of the file formats that the targets write; they share no code with the targets."""
