"""Engine of the page: simulation of launches in JavaScript, in a browser, a worker or Node.

``python -m tippetop.page_engine`` generates `mechanics.js` and `tables.js`, which are not in the
repository, from the modules of this package that state the physics. The other files are written by
hand: Python's semantics in JavaScript (`python.js`), the integrator, and the readings of a run.
"""

from pathlib import Path

HERE = Path(__file__).resolve().parent
"""Folder of the JavaScript modules; a page imports `index.js`."""

COMMAND = "python -m tippetop.page_engine"
"""Command that generates the two modules."""
