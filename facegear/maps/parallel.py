"""Independent tasks shared out over processes or threads, with results kept on disk.

joblib runs them: by default on this machine, or wherever ``joblib.parallel_config`` says, a Dask cluster for
example.
"""

from __future__ import annotations

import hashlib
import io
import os
import signal
import sys
import tempfile
import threading
import time
from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Any, Literal, Protocol, TypeVar

import numpy as np

from facegear.floquet.periodic import PeriodicSystem
from facegear.support.parameters import number_of_workers
from facegear.support.provenance import code_digest
from facegear.support.threads import one_thread
from facegear.support.types import FloatArray

# Seconds of work from which on processes are started, which by itself takes a few.
_WORTH_PROCESSES = 8.0

Workers = Literal["processes", "threads"]
T = TypeVar("T")


class Task(Protocol):
    """A piece of work with an array as its result."""

    def content(self) -> Iterator[Any]:
        """Everything the result depends on: arrays, numbers and text."""
        ...

    def compute(self) -> FloatArray:
        """Return the result."""
        ...


def computed(
    tasks: Sequence[Task],
    description: str,
    jobs: int,
    progress: bool | None,
    cache_directory: str | os.PathLike[str] | None,
    prefer: Workers = "processes",
) -> Iterator[tuple[int, FloatArray]]:
    """Results of all tasks with their numbers, in the order in which they are there.

    Parameters
    ----------
    tasks : sequence of Task
    description : str
        For the progress bar.
    jobs : int
        Number of workers, as joblib's ``n_jobs``; -1 for all processors or workers.
    progress : bool, optional
        Show a progress bar; if None, only on a terminal.
    cache_directory : path, optional
        Where results are kept, each written as soon as it is there, under a name that is a digest of all it depends
        on, the code of the package included. The file is bound to that name: one that is damaged, or lies where
        another belongs, is not used.
    prefer : {"processes", "threads"}
        What the workers are on this machine. Threads start at once, and keep up where nearly all time goes into
        large batches of NumPy's linear algebra.

    Yields
    ------
    int, array
        Number of the task and its result.
    """
    from tqdm.auto import tqdm

    if cache_directory is not None and not isinstance(cache_directory, str | os.PathLike):
        raise TypeError(f"cache_directory must be a path or None, got {cache_directory!r}")
    store = None if cache_directory is None else _Store(Path(cache_directory))
    waiting = []
    # tqdm itself takes a notebook for a terminal.
    shown = sys.stderr.isatty() if progress is None else progress
    with tqdm(total=len(tasks), desc=description, disable=not shown) as bar:
        for number, task in enumerate(tasks):
            kept = None if store is None else store.load(task)
            if kept is None:
                waiting.append(number)
            else:
                bar.update()
                yield number, kept
        for number, result in _in_parallel([(number, tasks[number]) for number in waiting], jobs, prefer):
            if store is not None:
                store.save(tasks[number], result)
            bar.update()
            yield number, result


def parts_of(system: PeriodicSystem) -> Iterator[Any]:
    """Everything a system is made of, for the content of a task."""
    yield from (system.mass, system.damping, system.stiffness, system.period)
    for jump in system.jumps:
        yield from (jump.fraction, jump.matrix)
    functions = [system.force]
    for load in system.loads:
        yield from (load.mass, load.damping, load.stiffness, load.rate)
        functions += [load.shape, load.weight, load.transmission_error]
    for function in functions:
        if function is None:
            yield None
        else:
            yield from (function.breakpoints, function.coefficients)


def in_processes(function: Callable[..., T], work: Iterable[tuple[Any, ...]], jobs: int) -> list[T]:
    """As :func:`each_in_processes`, all results as a list."""
    return list(each_in_processes(function, work, jobs))


def each_in_processes(function: Callable[..., T], work: Iterable[tuple[Any, ...]], jobs: int) -> Iterator[T]:
    """Call a function with each of several tuples of arguments, in processes of one thread each.

    Parameters
    ----------
    function : callable
        Defined at the top of a module, so that another process can find it.
    work : iterable of tuple
        Arguments, one tuple a call.
    jobs : int
        Number of processes, as joblib's ``n_jobs``.

    Yields
    ------
    object
        Results in the order of `work`, each as soon as it and those before it are there.
    """
    from joblib import Parallel, delayed

    jobs = number_of_workers("jobs", jobs)
    tasks = (delayed(on_one_thread)(function, *arguments) for arguments in work)
    yield from Parallel(n_jobs=jobs, return_as="generator")(tasks)


def on_one_thread(function: Callable[..., T], *arguments: Any) -> T:
    """Call a function on one thread: the matrices are too small to share."""
    begin_as_worker()
    with one_thread():
        return function(*arguments)


@cache
def begin_as_worker() -> None:
    """Let this process, if joblib started it on this machine, leave nothing behind when it is ended.

    It ends within a second after the process that started it has gone; joblib's own workers go on when their parent is
    killed, with what they are at, and then waiting for more. And progress bars, of which a worker shows none, take a
    lock of its threads in place of a semaphore of the system, which stays when a worker is killed.
    """
    from multiprocessing import current_process, parent_process

    from tqdm import tqdm

    starter = parent_process()
    if starter is None or not current_process().name.startswith("LokyProcess"):
        return
    tqdm.set_lock(threading.RLock())
    # A terminal interrupts workers too. The process that started them is to tell of it, once, and ends them.
    if threading.current_thread() is threading.main_thread():
        signal.signal(signal.SIGINT, signal.SIG_IGN)
    # Not whoever is the parent now: the one that started this process may be gone already.
    parent = starter.pid

    def watch() -> None:
        while os.getppid() == parent:
            time.sleep(0.5)
        os._exit(1)

    threading.Thread(target=watch, daemon=True).start()


def _in_parallel(
    tasks: Sequence[tuple[int, Task]], jobs: int, prefer: Workers
) -> Iterator[tuple[int, FloatArray]]:
    """Run tasks where joblib says; few and small ones are not worth another process."""
    from joblib import Parallel, delayed, effective_n_jobs
    from joblib.parallel import get_active_backend

    backend = get_active_backend(prefer=prefer)[0]
    together = backend.supports_return_generator
    if tasks and (len(tasks) == 1 or (together and prefer == "processes")):
        # The first of them tells how long the others take.
        started = time.perf_counter()
        yield on_one_thread(_run, *tasks[0])
        tasks = tasks[1:]
        if not tasks:
            return
        if len(tasks) * (time.perf_counter() - started) < _WORTH_PROCESSES:
            with one_thread():
                yield from (_run(*task) for task in tasks)
            return
    if together:
        # Threads share one limit: set before the first, or each would restore what another has set.
        here = getattr(backend, "uses_threads", False) or effective_n_jobs(jobs) == 1
        work = (delayed(_run)(*task) if here else delayed(on_one_thread)(_run, *task) for task in tasks)
        with one_thread():
            yield from Parallel(n_jobs=jobs, prefer=prefer, return_as="generator_unordered", batch_size=1)(
                work
            )
    else:
        # Such a backend answers when all is done: give it rounds, so that an interruption loses one only.
        size = 4 * effective_n_jobs(jobs)
        for start in range(0, len(tasks), size):
            yield from Parallel(n_jobs=jobs, batch_size=1)(
                delayed(on_one_thread)(_run, *task) for task in tasks[start : start + size]
            )


def _run(number: int, task: Task) -> tuple[int, FloatArray]:
    return number, task.compute()


@dataclass(frozen=True)
class _Store:
    """Finished tasks on disk, one file each, named by a digest of everything they depend on."""

    directory: Path

    def __post_init__(self) -> None:
        self.directory.mkdir(parents=True, exist_ok=True)

    def _key(self, task: Task) -> str:
        digest = hashlib.sha256(f"facegear {code_digest()} {type(task).__name__}".encode())
        # An array inside a model is written out, with all its elements and digits.
        with np.printoptions(threshold=sys.maxsize, floatmode="unique"):
            for part in task.content():
                if isinstance(part, np.ndarray):
                    digest.update(
                        f"|{part.shape}{part.dtype}".encode() + np.ascontiguousarray(part).tobytes()
                    )
                else:
                    digest.update(f"|{part!r}".encode())
        return digest.hexdigest()

    def load(self, task: Task) -> FloatArray | None:
        """Return a result that is there, undamaged and this task's, else None."""
        key = self._key(task)
        try:
            content = (self.directory / f"{key}.npz").read_bytes()
            with np.load(io.BytesIO(content), allow_pickle=False) as file:
                result, digest = file["result"], str(file["digest"])
        # A damaged archive fails in many ways (zipfile, zlib, numpy); all of them mean: compute again.
        except Exception:
            return None
        if result.dtype != np.float64 or digest != _digest(key, result):
            return None
        return np.asarray(result, dtype=float)

    def save(self, task: Task, result: FloatArray) -> None:
        """Write under another name first: a file with the right name is complete."""
        key = self._key(task)
        handle, temporary = tempfile.mkstemp(dir=self.directory, suffix=".part")
        try:
            with os.fdopen(handle, "wb") as file:
                np.savez(file, result=result, digest=_digest(key, result))
            os.replace(temporary, self.directory / f"{key}.npz")
        except BaseException:
            os.unlink(temporary)
            raise


def _digest(key: str, result: FloatArray) -> str:
    """Bind a result to the task that it belongs to."""
    whole = f"{key} {result.shape}".encode() + np.ascontiguousarray(result).tobytes()
    return hashlib.sha256(whole).hexdigest()
