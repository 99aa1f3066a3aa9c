"""What kind of object something is: refused where another is wanted, and said in a message."""


def named(value: object) -> str:
    """Say what a value is, for a message: "a Body", or "the class Body"."""
    return f"the class {value.__name__}" if isinstance(value, type) else _one(type(value))


def _one(kind: type) -> str:
    return f"{'an' if kind.__name__[0] in 'AEIOU' else 'a'} {kind.__name__}"


def require_kind(name: str, value: object, *kinds: type, why: str = "") -> None:
    """Refuse a value of another kind than wanted.

    Parameters
    ----------
    name : str
        Name of the parameter, for the message.
    value : object
        What the caller gave.
    *kinds : type
        One of which it must be an instance of.
    why : str, optional
        Words after the kinds, such as "for this study".

    Raises
    ------
    TypeError
        Naming the kinds, and what was given: a plain value itself, of anything else what it is.
    """
    if not isinstance(value, kinds):
        wanted = f"{' or '.join(map(_one, kinds))} {why}".rstrip()
        plain = type(value).__module__ == "builtins" and not isinstance(value, type)
        raise TypeError(f"{name} must be {wanted}, got {repr(value) if plain else named(value)}")


def require_kinds(instance: object, **kinds: type) -> None:
    """Refuse fields of a dataclass that are not of their kinds, naming the first."""
    for name, kind in kinds.items():
        require_kind(name, getattr(instance, name), kind)
