"""Ctrl-C waits for what must not be cut short."""

import hashlib
import os
import signal
import threading

import pytest

from children import posix_only
from tippetop.support.interrupts import deferred, run_interruptibly

pytestmark = pytest.mark.usefixtures("heard_signals")


def test_ctrl_c_waits_for_the_end_of_the_block():
    done = []

    def work():
        with deferred():
            signal.raise_signal(signal.SIGINT)
            done.append("all of it")
        done.append("not this")

    with pytest.raises(KeyboardInterrupt):
        work()
    assert done == ["all of it"]


def test_without_ctrl_c_nothing_happens_and_the_handler_is_back():
    before = signal.getsignal(signal.SIGINT)
    with deferred():
        assert signal.getsignal(signal.SIGINT) is not before
    assert signal.getsignal(signal.SIGINT) is before


def test_other_threads_are_left_alone():
    seen = []

    def work():
        with deferred():
            seen.append(signal.getsignal(signal.SIGINT))

    thread = threading.Thread(target=work)
    thread.start()
    thread.join()
    assert seen == [signal.getsignal(signal.SIGINT)]


def deaf() -> bytes:
    """Most of a second that no signal ends, and during which other threads work."""
    return hashlib.pbkdf2_hmac("sha256", b"", b"", 1_000_000)


@posix_only
def test_ctrl_c_is_heard_while_deaf_work_is_done():
    begun, ended = threading.Event(), threading.Event()

    def work():
        begun.set()
        deaf()
        ended.set()

    def interrupt():
        begun.wait()
        os.kill(os.getpid(), signal.SIGINT)

    interrupter = threading.Thread(target=interrupt)
    interrupter.start()
    with pytest.raises(KeyboardInterrupt):
        run_interruptibly(work)
    assert not ended.is_set()
    interrupter.join()
    assert ended.wait(), "all of it"


def test_what_comes_of_heard_work_or_is_raised_by_it_is_handed_over():
    assert run_interruptibly(threading.current_thread) is not threading.current_thread()
    with pytest.raises(ZeroDivisionError):
        run_interruptibly(lambda: 1 / 0)
