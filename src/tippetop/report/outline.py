"""The order of the page: the report's own sections, then ours, and the pictures that it opens with."""

PICTURES = ("fig04", "fig06", "flights", "fig12", "why-bifurcation")
"""Names of the five figures that tell what was found."""

SECTIONS: dict[str, tuple[str, str]] = {
    "1": ("1 Introduction", ""),
    "2.1": ("2.1 Euler angles and Euler's equations", ""),
    "2.2": ("2.2 The tippe top", ""),
    "2.3": ("2.3 Before the solution", ""),
    "3": ("3 The method and the parameters", ""),
    "3.1": ("3.1 Two launches", ""),
    "3.2": ("3.2 How the end depends on the spin", ""),
    "3.3": ("3.3 How it depends on friction", ""),
    "4": ("4 Discussion: flight", ""),
    "5": ("5 Critique and summary", ""),
    "Appendix A": ("Appendix A: the listing", ""),
    "Appendix B": ("Appendix B: the Runge-Kutta method", ""),
    "Appendix C": ("Appendix C: more launches", ""),
    "Why": (
        "Why",
        "The report asks for a more fundamental rule behind what it finds. Friction at the point of contact "
        "takes energy and leaves Jellett's integral alone, so that a launch ends in a stable steady state "
        "with the integral it began with; weak friction acts on a nutation that it hardly disturbs, so that "
        "only mu t counts. These figures show what follows.",
    ),
    "Friction": (
        "Friction",
        "The report takes friction proportional to the slip velocity, with mu in s/m. Tables are dry. "
        "These figures ask what a top does on Coulomb's friction, at a point and on a patch that drills, "
        "what others published of it, and which dry friction that of the report stands for.",
    ),
    "Real tops": (
        "Real tops",
        "The report's top is a sphere without a stem. Real ones have a stem that strikes the table. Eggs, "
        "disks and balls that spin are bodies of revolution as well, which the same equations move.",
    ),
}
"""Titles and opening words of the page's sections, by what the report calls them; those without a claim or a
figure are left out."""

OWN = ("Why", "Friction", "Real tops")
"""The sections that are not the report's."""


def section_of(place: str) -> str:
    """The section of the page that a section of the report is in: the one named most closely.

    Raises `LookupError` if there is none.
    """
    found = [key for key in SECTIONS if place.startswith(key)]
    if not found:
        raise LookupError(f"the page has no section for {place!r}")
    return max(found, key=len)
