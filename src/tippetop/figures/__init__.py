"""Figures: results in, matplotlib figures out. Nothing is computed here.

`style` has the palette and the context that every figure is made in; `drawing` and `annotation`
have what several figures share. `overview`, `maps` and `fits` are what `tt.plot` draws, `section`
is that of `tippetop body`. `appearance` and `toy` describe and render the toy. The other modules
draw the figures of the report, each from a dataset of `report.experiments`.
"""
