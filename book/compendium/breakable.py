"""Names in tables that may be broken where their words end, so that a table fits a page."""

import re

_CODE = re.compile(r"`[^`]+`")
_ENDS = re.compile(r"(?<=[_./(,])(?=\w)")


def breakable(text: str) -> str:
    r"""Return Markdown whose names in code may be broken after an underline, a full stop and the like.

    Examples
    --------
    >>> breakable("`ch08_maps` of a_b").replace("\N{ZERO WIDTH SPACE}", "·")
    '`ch08_·maps` of a_b'
    """
    return _CODE.sub(lambda code: _ENDS.sub("\N{ZERO WIDTH SPACE}", code[0]), text)
