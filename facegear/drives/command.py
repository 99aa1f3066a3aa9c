"""The command `facegear`: a thin face on functions that others can call.

Exit codes: 0 done; 1 a file cannot be used, or a place not written to; 2 the command cannot be understood; 130
interrupted. Results go to standard output, progress and complaints to standard error.
"""

from __future__ import annotations

import os
import signal
import sys
import warnings
from collections.abc import Sequence

from facegear.drives.command_line import parser
from facegear.drives.commands import INTERRUPTED, MISUSED, REFUSED, UsageError, say
from facegear.drives.drive_file import DriveFileError
from facegear.drives.refusals import told


def main(arguments: Sequence[str] | None = None) -> int:
    """Run a command line.

    Parameters
    ----------
    arguments : sequence of str, optional
        What follows `facegear`; that of this process if left out.

    Returns
    -------
    int
        The exit code.
    """
    # A request to end is an interruption: what is half-written goes, and so do workers.
    before = signal.signal(signal.SIGTERM, _interrupt)
    try:
        options = parser().parse_args(arguments)
        with warnings.catch_warnings():
            # joblib replaces a worker that has come to hold much memory, and goes on.
            warnings.filterwarnings("ignore", "A worker stopped while some jobs", UserWarning)
            return int(options.run(options))
    except UsageError as problem:
        say(f"facegear: error: {problem}")
        return MISUSED
    except BrokenPipeError:
        # Whoever read the output, `head` for one, has enough; nothing more can be said there.
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        return REFUSED
    except (DriveFileError, OSError) as problem:
        say(str(problem))
        return REFUSED
    except ArithmeticError as problem:
        say(told(problem))
        return REFUSED
    except KeyboardInterrupt:
        say("Interrupted: nothing was left half-written.")
        return INTERRUPTED
    finally:
        signal.signal(signal.SIGTERM, before)


def _interrupt(*_: object) -> None:
    raise KeyboardInterrupt
