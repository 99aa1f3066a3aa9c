"""What the build shows while it works: one bar on a terminal, plain lines elsewhere, one line a failure."""

import sys
import threading
import time

from doit.exceptions import BaseFail, UnmetDependency
from doit.reporter import ZeroReporter
from doit.task import Task
from tqdm import tqdm

QUIET_SECONDS = 15.0


class Cells:
    """Counts the cells of the notebooks that are running, and shows them.

    Two notebooks may run at once, each followed by a thread of its own.
    """

    def __init__(self) -> None:
        self._guard = threading.Lock()
        self._totals: dict[str, int] = {}
        self._done: dict[str, int] = {}
        self._running: dict[str, float] = {}
        self._last_line = 0.0
        self._bar: tqdm | None = None

    def expect(self, totals: dict[str, int]) -> None:
        """Say how many cells each notebook has; called once, before the first one runs."""
        self._totals = totals
        self._done = dict.fromkeys(totals, 0)
        if sys.stderr.isatty() and totals:
            self._bar = tqdm(total=sum(totals.values()), unit="cell", file=sys.stderr, leave=False)

    def start(self, notebook: str) -> None:
        """Take note that a notebook starts."""
        with self._guard:
            self._running[notebook] = time.monotonic()
            self._line(f"{notebook}: started, {self._totals.get(notebook, 0)} cells")
            self._refresh()

    def advance(self, notebook: str, done: int) -> None:
        """Take note that `done` cells of a notebook have run."""
        with self._guard:
            self._done[notebook] = done
            self._refresh()
            if time.monotonic() - self._last_line > QUIET_SECONDS:
                self._line(" · ".join(self._state(name) for name in self._running))

    def finish(self, notebook: str, how: str) -> None:
        """Take note that a notebook has ended, and how."""
        with self._guard:
            started = self._running.pop(notebook, None)
            self._done[notebook] = self._totals.get(notebook, 0)
            seconds = "" if started is None else f" ({time.monotonic() - started:.1f} s)"
            self._line(f"{notebook}: {how}{seconds}")
            self._refresh()

    def close(self) -> None:
        """Remove the bar."""
        if self._bar is not None:
            self._bar.close()
            self._bar = None

    def say(self, message: str) -> None:
        """Print a line that stays, above the bar."""
        with self._guard:
            tqdm.write(message, file=sys.stderr)

    def _state(self, notebook: str) -> str:
        return f"{notebook} {self._done[notebook]}/{self._totals[notebook]}"

    def _line(self, message: str) -> None:
        if self._bar is None:
            sys.stderr.write(message + "\n")
            sys.stderr.flush()
            self._last_line = time.monotonic()

    def _refresh(self) -> None:
        if self._bar is not None:
            self._bar.n = sum(self._done.values())
            self._bar.set_postfix_str(" · ".join(self._state(name) for name in self._running))


CELLS = Cells()


class BuildReporter(ZeroReporter):
    """Tells of a build: notebooks by their cells, the rest by name, a failure in one line."""

    desc = "progress over notebooks and cells"

    def initialize(self, tasks: dict[str, Task], selected_tasks: list[str]) -> None:
        """Count what lies ahead."""
        CELLS.expect({task.meta["notebook"]: task.meta["cells"] for task in tasks.values() if task.meta})

    def execute_task(self, task: Task) -> None:
        """Announce a step that is not a notebook."""
        if task.actions and not task.meta:
            CELLS.say(f"{task.name}: {task.doc}")

    def skip_uptodate(self, task: Task) -> None:
        """Count a notebook that need not run as done."""
        if task.meta:
            CELLS.finish(task.meta["notebook"], "unchanged")

    def add_failure(self, task: Task, fail_info: BaseFail) -> None:
        """Print the one line that says what went wrong and where to look."""
        if fail_info.report and not isinstance(fail_info, UnmetDependency):
            lines = fail_info.message.strip().splitlines() or [task.name]
            CELLS.say(f"FAILED {lines[-1]}")

    def complete_run(self) -> None:
        """Remove the bar."""
        CELLS.close()
