"""tippetop: a laboratory for the tippe top."""

__version__ = "0.1.0"
