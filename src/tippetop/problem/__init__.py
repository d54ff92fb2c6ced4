"""Statement of the physics of a run, validated: `Problem` and its parts.

Read `problem` first. Its parts are one file each: `bodies` (and the `shapes` of their surfaces),
`frictions`, `launch`, and `contact_rules`, which say what may happen where contact begins or ends.
`presets` holds named bodies and problems, `turned` makes bodies of workpieces, `hertz_patch`
computes the size of a contact patch, and `function_law` makes friction laws of functions.
`plausibility` lists what is implausible about a problem, and `implausible` warns of it.
"""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach(__name__, submodules=["presets"])
