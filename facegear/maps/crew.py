"""Tasks of which some bring others along, shared out over processes, the most urgent first."""

from __future__ import annotations

from collections.abc import Callable, Hashable, Iterator
from concurrent.futures import FIRST_COMPLETED, Future, wait
from functools import cached_property
from heapq import heappop, heappush
from itertools import count
from types import TracebackType
from typing import Any

from facegear.maps.parallel import begin_as_worker, on_one_thread
from facegear.support.parameters import number_of_workers

# Seconds after which an idle process ends.
_IDLE = 60


class Crew:
    """Processes of one thread each that take tasks while others are still found.

    A pool that is given all its work at once waits for the longest task before it can be given what depends on it. Here
    tasks are added while results come in, and no process is idle while one is waiting.

    Parameters
    ----------
    jobs : int
        Number of processes, as joblib's ``n_jobs``. With one, tasks run in this process, when results are asked for.

    Examples
    --------
    >>> with Crew(jobs=1) as crew:
    ...     crew.add("two", 1.0, pow, 2, 2)
    ...     for name, result in crew.results():
    ...         print(name, result)
    ...         if name == "two":
    ...             crew.add("three", 0.0, pow, 3, 2)
    ...             crew.add("four", 5.0, pow, 4, 2)
    two 4
    four 16
    three 9
    """

    def __init__(self, jobs: int) -> None:
        from joblib import effective_n_jobs

        self._jobs = int(effective_n_jobs(number_of_workers("jobs", jobs)))
        self._waiting: list[tuple[float, int, Hashable, Callable[..., Any], tuple[Any, ...]]] = []
        self._running: dict[Future[Any], Hashable] = {}
        self._number = count()

    def __enter__(self) -> Crew:
        return self

    def __exit__(self, kind: type[BaseException] | None, *_: BaseException | TracebackType | None) -> None:
        """End all processes, after an error or an interruption at once."""
        if "_executor" in vars(self):
            self._executor.shutdown(wait=True, kill_workers=kind is not None)

    @cached_property
    def _executor(self) -> Any:
        # Processes of its own: those that joblib keeps for its next call are no others' to submit to.
        from joblib.externals.loky import ProcessPoolExecutor

        executor = ProcessPoolExecutor(max_workers=self._jobs, timeout=_IDLE)
        # Each is to watch from its first moment whether this process is still there, also while it has no task.
        for _ in range(self._jobs):
            executor.submit(begin_as_worker)
        return executor

    def add(self, name: Hashable, urgency: float, function: Callable[..., Any], *arguments: Any) -> None:
        """Add a task: a function defined at the top of a module, and its arguments.

        Of tasks that wait those of the highest urgency are begun first, then those that were added first.
        """
        heappush(self._waiting, (-urgency, next(self._number), name, function, arguments))
        self._begin()

    def _begin(self) -> None:
        while self._jobs > 1 and self._waiting and len(self._running) < self._jobs:
            _, _, name, function, arguments = heappop(self._waiting)
            self._running[self._executor.submit(on_one_thread, function, *arguments)] = name

    def results(
        self, at_work: Callable[[list[Any]], object] = lambda names: None, every: float = 30.0
    ) -> Iterator[tuple[Hashable, Any]]:
        """Give names and results of tasks as they are done, those included that are added meanwhile.

        What a task raises is raised here. Whenever so many seconds pass without a result `at_work` is called with the
        names of the tasks that run.
        """
        while self._waiting or self._running:
            if self._jobs == 1:
                _, _, name, function, arguments = heappop(self._waiting)
                yield name, on_one_thread(function, *arguments)
                continue
            done, _ = wait(self._running, every, FIRST_COMPLETED)
            if not done:
                at_work(list(self._running.values()))
            for future in done:
                yield self._running.pop(future), future.result()
            self._begin()
