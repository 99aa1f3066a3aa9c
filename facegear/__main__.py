"""`python -m facegear` is the command `facegear`."""

import sys
from typing import Any


def main() -> int:
    """Run the command; an interruption while it is still being loaded ends it without a traceback as well."""
    try:
        for stream in (sys.stdout, sys.stderr):
            _take_all_letters(stream)
        from facegear.drives.command import main as run
    except KeyboardInterrupt:
        # INTERRUPTED of the command, which is not there yet
        return 130
    return run()


def _take_all_letters(stream: Any) -> None:
    """Let a stream take every letter: files and pipes in UTF-8, as drive files are, a terminal as far as it can."""
    if (reconfigure := getattr(stream, "reconfigure", None)) is None:
        return
    if stream.isatty():
        reconfigure(errors="replace")
    else:
        # What names of files have that is no letter in any encoding stays readable.
        reconfigure(encoding="utf-8", errors="backslashreplace")


if __name__ == "__main__":
    sys.exit(main())
