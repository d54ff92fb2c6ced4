"""What tests of sweeps share."""

import pytest

from tippetop.sweeps import definition


@pytest.fixture
def small_tasks(monkeypatch):
    """Tasks of four cells, so that a small sweep has many."""
    monkeypatch.setattr(definition, "LEAST_CELLS_A_TASK", 4)
    monkeypatch.setattr(definition, "TASKS", 1000)
