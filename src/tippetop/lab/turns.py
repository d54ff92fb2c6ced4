"""Visitors take turns: one who asks for much delays the others by a run, not by all of theirs."""

import asyncio
from collections import Counter, deque
from collections.abc import Awaitable, Callable
from concurrent.futures import ThreadPoolExecutor
from contextlib import suppress
from typing import TypeVar

from tippetop.errors import Unavailable

MOST = 48
"""How many runs may be under way or wait."""
OF_ONE = 6
"""How many of them may be one visitor's."""
GLANCE = 0.2
"""How often one who waits is looked after, s."""

_Result = TypeVar("_Result")


class Turns:
    """A few places to work at, and those who wait for one.

    It belongs to one event loop, and has threads of its own: those that the loop lends are also what serves
    the page's parts, and so must not wait for runs.
    """

    def __init__(self, places: int, most: int = MOST, of_one: int = OF_ONE) -> None:
        self._free = places
        # One place stays for others, where there is more than one.
        self._at_once = max(1, places - 1)
        self._most, self._of_one = most, of_one
        self._threads = ThreadPoolExecutor(places, thread_name_prefix="turns")
        self._working: Counter[str] = Counter()
        self._waiting: dict[str, deque[asyncio.Future[None]]] = {}

    async def take(
        self, visitor: str, work: Callable[[], _Result], wanted: Callable[[], Awaitable[None]]
    ) -> _Result:
        """Do something in a thread when it is the visitor's turn.

        Parameters
        ----------
        visitor
            Who asks: a visitor's turns come in order, and visitors alternate.
        work
            What is done.
        wanted
            Raises what is to be raised once the result is no longer wanted: work that has not begun by then
            never does.

        Raises
        ------
        Unavailable
            If too much is under way or waits, of this visitor or of all.
        """
        self._admit(visitor)
        loop = asyncio.get_running_loop()
        turn: asyncio.Future[None] = loop.create_future()
        self._waiting.setdefault(visitor, deque()).append(turn)
        self._call_next()
        try:
            while not turn.done():
                await asyncio.wait([turn], timeout=GLANCE)
                await wanted()
        except BaseException:
            if turn.done():
                self._leave(visitor)
            else:
                self._give_up(visitor, turn)
            raise
        ended = asyncio.Event()

        def end() -> None:
            ended.set()
            self._leave(visitor)

        job = self._threads.submit(work)

        def tell(_: object) -> None:
            with suppress(RuntimeError):  # the loop is closed: nobody waits any more
                loop.call_soon_threadsafe(end)

        job.add_done_callback(tell)
        while not ended.is_set():
            with suppress(TimeoutError):
                await asyncio.wait_for(ended.wait(), GLANCE)
                break
            await wanted()
        return job.result()

    def _admit(self, visitor: str) -> None:
        own = self._working[visitor] + len(self._waiting.get(visitor, ()))
        if own >= self._of_one:
            raise Unavailable(f"{own} runs of yours are under way or wait already: try again in a moment")
        if sum(self._working.values()) + sum(map(len, self._waiting.values())) >= self._most:
            raise Unavailable("the laboratory computes for many others just now: try again in a moment")

    def _call_next(self) -> None:
        """Give the free places to those whose turn it is."""
        while self._free:
            ready = (name for name in self._waiting if self._working[name] < self._at_once)
            visitor = next(ready, None)
            if visitor is None:
                return
            turns = self._waiting.pop(visitor)
            turns.popleft().set_result(None)
            if turns:
                self._waiting[visitor] = turns  # behind the others
            self._working[visitor] += 1
            self._free -= 1

    def _give_up(self, visitor: str, turn: asyncio.Future[None]) -> None:
        turns = self._waiting[visitor]
        turns.remove(turn)
        if not turns:
            del self._waiting[visitor]

    def _leave(self, visitor: str) -> None:
        self._free += 1
        self._working[visitor] -= 1
        if not self._working[visitor]:
            del self._working[visitor]
        if visitor in self._waiting:
            self._waiting[visitor] = self._waiting.pop(visitor)  # behind those who have come meanwhile
        self._call_next()
