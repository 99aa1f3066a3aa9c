"""Tasks that bring others along, over processes: order, errors, interruptions."""

import os
import signal
import time

import psutil
import pytest

from facegear.maps.crew import Crew
from facegear.maps.parallel import in_processes


def waited(seconds):
    time.sleep(seconds)
    return os.getpid()


def waited_for(path):
    """Until there is a file; at the latest after half a minute, when all others are done."""
    end = time.monotonic() + 30.0
    while not path.exists() and time.monotonic() < end:
        time.sleep(0.01)


def broken():
    raise ArithmeticError("nothing is known")


def test_in_this_process_the_most_urgent_first_then_the_first_added():
    crew, found = Crew(jobs=1), []
    for name, urgency in (("last", 0.0), ("first", 9.0), ("second", 5.0), ("third", 5.0)):
        crew.add(name, urgency, waited, 0.0)
    for name, process in crew.results():
        found.append(name)
        assert process == os.getpid()
        if name == "second":
            crew.add("brought along", 7.0, waited, 0.0)
    assert found == ["first", "second", "brought along", "third", "last"]


def test_what_comes_of_a_short_task_does_not_wait_for_a_long_one(tmp_path):
    done = tmp_path / "done"
    with Crew(jobs=2) as crew:
        crew.add("start", 9.0, waited, 0.0)
        # Both processes are there.
        assert next(crew.results())[0] == "start"
        crew.add("long", 9.0, waited_for, done)
        crew.add("short", 8.0, waited, 0.0)
        found = []
        for name, process in crew.results():
            found.append(name)
            assert process != os.getpid()
            if name == "short":
                crew.add("of the short one", 0.0, waited, 0.0)
            if name == "of the short one":
                done.touch()
    assert found == ["short", "of the short one", "long"]


def test_an_error_of_a_task_is_raised_and_no_process_is_left_at_work():
    def run():
        with Crew(jobs=2) as crew:
            crew.add("long", 1.0, waited, 60.0)
            crew.add("broken", 0.5, broken)
            list(crew.results())

    before = set(psutil.Process().children(recursive=True))
    started = time.perf_counter()
    with pytest.raises(ArithmeticError, match="nothing is known"):
        run()
    assert time.perf_counter() - started < 50.0
    below = set(psutil.Process().children(recursive=True)) - before
    _, alive = psutil.wait_procs([p for p in below if "LokyProcess" in " ".join(p.cmdline())], timeout=10.0)
    assert not alive


def interruptible():
    return signal.getsignal(signal.SIGINT) is not signal.SIG_IGN


def test_a_terminal_that_interrupts_all_processes_is_heard_by_this_one_alone():
    with Crew(jobs=2) as crew:
        for number in range(4):
            crew.add(number, 0.0, interruptible)
        assert not any(heard for _, heard in crew.results())
    assert interruptible()


def test_processes_of_joblib_are_left_alone():
    """A crew between two calls of joblib in one process."""
    assert in_processes(abs, [(-1,), (-2,)], 2) == [1, 2]
    with Crew(jobs=2) as crew:
        crew.add("one", 1.0, waited, 0.0)
        assert [name for name, _ in crew.results()] == ["one"]
    assert in_processes(abs, [(-1,), (-2,)], 2) == [1, 2]


def test_an_error_in_this_process():
    crew = Crew(jobs=1)
    crew.add("broken", 0.5, broken)
    with pytest.raises(ArithmeticError, match="nothing is known"):
        list(crew.results())


def test_a_number_of_processes_that_is_none():
    with pytest.raises(ValueError, match="jobs"):
        Crew(0)


def test_while_nothing_is_done_it_tells_what_is_at_work():
    told = []
    with Crew(jobs=2) as crew:
        crew.add("long", 0.0, time.sleep, 1.0)
        assert [name for name, _ in crew.results(told.append, every=0.05)] == ["long"]
    assert told
    assert all(names == ["long"] for names in told)
