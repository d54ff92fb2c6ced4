"""The engine in the page: launches followed in JavaScript, in a browser, a worker or Node.

`mechanics.js` and `tables.js` are no part of the repository: ``python -m tippetop.page_engine``
makes them of the modules of this package that say what happens to a top. What is written by hand is
what these are run by: what Python means where JavaScript means something else, the integrator, and
what is read off a run.
"""

from pathlib import Path

HERE = Path(__file__).resolve().parent
"""Where the modules of JavaScript are; a page begins with `index.js`."""

COMMAND = "python -m tippetop.page_engine"
"""What makes those that are generated."""
