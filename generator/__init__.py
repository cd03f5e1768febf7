"""Compiler from transcribed drive manuals to EDS, C, Python, Rust, JSON and HTML."""

VERSION = "0.1.0"
