"""Command line, with one file per command.

`main` is the entry point, `commands` collects the commands and reports errors, `options` has the
options that several commands share, and `terminal` prints tables, sentences, JSON and progress.
"""
