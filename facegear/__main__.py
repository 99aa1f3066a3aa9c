"""`python -m facegear` is the command `facegear`."""

import sys

from facegear.drives.command import main

if __name__ == "__main__":
    sys.exit(main())
