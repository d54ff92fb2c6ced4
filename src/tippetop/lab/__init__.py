"""Laboratory: the page on which anyone launches the top, and the player in a notebook.

`serve` serves the page to other devices, and `notebook` shows a run as a widget. Browsers compute
the launches (see `tippetop.page_engine`).
"""
