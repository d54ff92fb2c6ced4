"""The physics of a run as users state it, checked: `Problem` and its parts.

Read `problem` first. Its parts are one file each: `bodies` (and the `shapes` of their surfaces),
`frictions`, `launch`, and `contact_rules`, which say what may happen where contact begins or ends.
`presets` holds bodies and problems known by name, `hertz_patch` the size of a contact patch.
`plausibility` says what is implausible about a problem, and `implausible` warns of it.
"""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach(__name__, submodules=["presets"])
