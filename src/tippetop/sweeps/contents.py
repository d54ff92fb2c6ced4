"""Variables of a sweep's dataset: what each launch comes to, and samples of its trajectory."""

from collections.abc import Mapping
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from tippetop.contact.mode import EventKind
from tippetop.results.catalogue import LISTED, SAMPLED, SWEPT, Variable
from tippetop.results.dataset import COMPONENTS, TIME
from tippetop.sweeps.definition import Sweep
from tippetop.sweeps.grid import field_paths

CONTENTS: Mapping[str, Variable] = {
    "is_done": Variable("whether the launch is computed", dtype="bool"),
    **SWEPT,
}
"""Variables of every sweep's dataset, one number a launch."""

IS_SAMPLED = Variable(
    "whether the run lasts to the time of the sample; the others are not numbers", dtype="bool"
)


EVENT_COUNT = Variable(
    "number of events of the run, of which the first are listed", "1", dtype="int32"
)

OF_EVENTS: Mapping[str, Variable] = {
    name: variable for name, variable in LISTED.items() if name.startswith("event_")
} | {
    "event_kind": LISTED["event_kind"]._replace(
        dtype="int8", flags=tuple(kind.value.replace(" ", "_") for kind in EventKind)
    )
}
"""Variables over the events of every launch; words of several have _ between them, as in CF."""


class Content(NamedTuple):
    """A variable over the launches, and its dimensions after theirs."""

    variable: Variable
    dimensions: tuple[str, ...] = ()
    shape: tuple[int, ...] = ()

    def missing(self, shape: tuple[int, ...]) -> NDArray[Any]:
        """Return the array of launches, of this shape, of which nothing is known."""
        return np.full((*shape, *self.shape), self.variable.missing, dtype=self.variable.dtype)


def contents_of(sweep: Sweep) -> dict[str, Content]:
    """Return the variables of a sweep's dataset by name."""
    contents = {name: Content(variable) for name, variable in CONTENTS.items()}
    if sweep.event_places:
        contents["event_count"] = Content(EVENT_COUNT)
        places = ("event",), (sweep.event_places,)
        contents |= {name: Content(variable, *places) for name, variable in OF_EVENTS.items()}
    if not sweep.sampled:
        return contents
    count = len(sweep.sample_times)
    contents["is_sampled"] = Content(IS_SAMPLED, ("time",), (count,))
    for name in sweep.sampled:
        components = SAMPLED[name].dimensions
        widths = (len(COMPONENTS[dimension]) for dimension in components)
        contents[name] = Content(SAMPLED[name], ("time", *components), (count, *widths))
    return contents


def coordinates_of(sweep: Sweep) -> dict[str, tuple[str, NDArray[Any]]]:
    """Return the dimension and the values of the coordinates of a sweep's dataset, by name."""
    times = {"time": ("time", sweep.sample_times)} if sweep.sampled else {}
    return sweep.coordinates() | times


def components_of(sweep: Sweep) -> dict[str, list[str]]:
    """Return the names of components by the dimensions of the samples, which stores do not hold."""
    dimensions = {one for content in contents_of(sweep).values() for one in content.dimensions[1:]}
    return {name: list(COMPONENTS[name]) for name in COMPONENTS if name in dimensions}


def coordinate_attributes(sweep: Sweep, name: str) -> dict[str, Any]:
    """Return the attributes of a coordinate by the CF conventions, and the `path` of its field."""
    path = field_paths(sweep.grid.fields, sweep.keep).get(name)
    if path is None:
        return dict(TIME) if name == "time" else Variable("number of the draw", "1").attributes
    kind = sweep.problem.quantity(path)
    return Variable(kind.long_name, kind.units).attributes | {"path": path}
