"""Run Jupyter Book: `python tools/build_pages.py build SOURCE …`, as its own command `jupyter-book` does.

The nodes of all pages stay to the end, some millions of them. Python's rounds for garbage find nothing among them and
take half of the time, so that there are none.
"""

import gc
import sys

from jupyter_book.cli.main import main

if __name__ == "__main__":
    gc.disable()
    sys.exit(main())
