"""Examples of drive files, which come with the package."""

from __future__ import annotations

from pathlib import Path

_PACKAGE = Path(__file__).resolve().parent


def _folder() -> Path:
    """Where they are: in an installed package beside this module, in a checkout in its data."""
    installed = _PACKAGE / "example_files"
    return installed if installed.is_dir() else _PACKAGE.parents[1] / "data" / "drives"


def example_names() -> tuple[str, ...]:
    """Names of the examples.

    Examples
    --------
    >>> example_names()[:2]
    ('both_faces', 'case_1')
    """
    return tuple(sorted(path.stem for path in _folder().glob("*.yaml")))


def example_text(name: str) -> str:
    """Text of an example.

    Parameters
    ----------
    name : str
        One of :func:`example_names`.

    Returns
    -------
    str
        A drive file, comments included.

    Raises
    ------
    ValueError
        If there is no example of that name.
    """
    if name not in example_names():
        raise ValueError(f"name must be one of {', '.join(example_names())}, got {name!r}")
    return (_folder() / f"{name}.yaml").read_text(encoding="utf-8")


def about(name: str) -> str:
    """Say in a sentence what an example is: the comment that it opens with.

    Examples
    --------
    >>> about("case_2")[:29]
    'Case II of the dissertation ('
    """
    lines = []
    for line in example_text(name).splitlines():
        if not line.startswith("#"):
            break
        lines.append(line.lstrip("# "))
    return " ".join(lines)
