"""Build the book, or any step of `dodo.py`: `python tools/build.py [task …]`.

Adds to doit what a build that people interrupt needs: one build at a time in a checkout, each finished step on
record at once, a clear last line.
"""

import signal
import sys
import time
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
sys.path.insert(0, str(ROOT))

from doit.cmd_base import ModuleTaskLoader  # noqa: E402
from doit.doit_cmd import DoitMain  # noqa: E402

from tools.lock import one_at_a_time  # noqa: E402


def interrupt(*_: object) -> None:
    """Turn a request to end into the exception that doit cleans up after."""
    raise KeyboardInterrupt


def main(arguments: list[str]) -> int:
    """Run the tasks named, the whole book when none is; return the exit code."""
    started = time.monotonic()
    signal.signal(signal.SIGTERM, interrupt)
    with one_at_a_time():
        import dodo

        doit = DoitMain(
            ModuleTaskLoader(dodo), extra_config={"BACKEND": {"durable": "tools.state:DurableDB"}}
        )
        code = doit.run(["run", "--backend", "durable", *arguments])
    seconds = time.monotonic() - started
    if code != 0:
        sys.stderr.write(
            f"The build stopped after {seconds:.1f} s; the lines marked FAILED say where to look.\n"
        )
    elif not arguments:
        page = ROOT / "build" / "_build" / "html" / "index.html"
        sys.stdout.write(f"The book is built ({seconds:.1f} s). Open {page.as_uri()}\n")
    return int(code or 0)


if __name__ == "__main__":
    try:
        sys.exit(main(sys.argv[1:]))
    except KeyboardInterrupt:
        sys.exit("Interrupted. What is finished is kept; run it again to go on.")
