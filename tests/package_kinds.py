"""Kinds of parts as a new process has them, whatever other tests have defined."""

import pytest

import tippetop as tt


def forget_own_kinds(patch: pytest.MonkeyPatch) -> None:
    """Leave only the package's own kinds of friction and shape until `patch` is undone."""
    for part in (tt.Friction, tt.Shape):
        kinds = {
            word: kind
            for word, kind in part.kinds.items()
            if kind.__module__.startswith("tippetop.")
        }
        patch.setattr(part, "kinds", kinds)
