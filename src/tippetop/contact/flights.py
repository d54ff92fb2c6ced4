"""The flights of a launch, put together of their pieces."""

from tippetop.contact.mode import Segment


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

    def take(self, segment: Segment) -> None:
        """Take in a flight, or one more piece of it."""
        begin = float(segment.solution.knots[0]) if self._landed else self.rows.pop()[0]
        self.rows.append((begin, segment.end_time, segment.highest_gap))
        self._landed = segment.transition is not None
