"""The flights of a launch, put together of their segments."""

from tippetop.contact.lowest_surface import lowest_contact_vector
from tippetop.contact.mode import Mode, Segment
from tippetop.mechanics.vectors import Row, Scalar


class Flights:
    """Flights that were made so far."""

    def __init__(self) -> None:
        self.rows = list[tuple[float, float, float]]()
        """Begin, end and highest gap of each."""
        self._landed = True

    @property
    def duration(self) -> float:
        """How long they took together."""
        return sum([end - begin for begin, end, _ in self.rows])

    @property
    def highest_gap(self) -> float:
        """The largest gap in any of them."""
        return max([gap for _, _, gap in self.rows], default=0.0)

    def take(self, segment: Segment, highest_gap: float) -> None:
        """Take in a flight, or one more segment of it, with the highest gap there."""
        begin, highest = float(segment.solution.knots[0]), highest_gap
        if not self._landed:
            begin, before = self.rows[-1][0], self.rows[-1][2]
            highest = max(highest, before)
            self.rows.pop()
        self.rows.append((begin, segment.end_time, highest))
        self._landed = segment.transition is not None


def gap_at(mode: Mode, y: Row) -> Scalar:
    """Return the height of the body's lowest point, from the numbers of a mode."""
    state = mode.state(y)
    return state.height + lowest_contact_vector(state.axis, mode.top.surface)[2]
