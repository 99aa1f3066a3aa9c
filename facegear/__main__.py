"""`python -m facegear` is the command `facegear`."""

import sys


def main() -> int:
    """Run the command; an interruption while it is still being loaded ends it without a traceback as well."""
    try:
        from facegear.drives.command import main as run
    except KeyboardInterrupt:
        # INTERRUPTED of the command, which is not there yet
        return 130
    return run()


if __name__ == "__main__":
    sys.exit(main())
