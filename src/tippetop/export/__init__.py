"""Files of a run: films, models, pages that play it, tables; and solids of turned bodies.

`poses` interpolates a run between its samples; `geometry` and `raycast` turn the toy of `figures`
into triangles and pictures. `movie`, `glb`, `html`, `tables` and `solid` write the files; `track`
packs a run for the player in the browser, which `bundle` reads as it was built from `web/`.
"""
