"""What can be refused: each error names the culprit and the remedy."""

from __future__ import annotations

import difflib
from typing import Iterable


class TopoError(ValueError):
    """Something that cannot be made as asked.

    Attributes:
        file: the file, where there is one.
        line: the line of the key in it.
        key: the key or argument that is at fault.
        value: what it was, as text.
        remedy: what would be right.
    """

    def __init__(
        self,
        message: str,
        *,
        file: str | None = None,
        line: int | None = None,
        key: str | None = None,
        value: str | None = None,
        remedy: str | None = None,
    ) -> None:
        super().__init__(message)
        self.file, self.line, self.key, self.value, self.remedy = file, line, key, value, remedy

    def __reduce__(self):
        return _again, (type(self), str(self), dict(self.__dict__))


class SceneError(TopoError):
    """A scene that cannot be run: unknown keys, impossible values, settings that would change nothing."""


class KnotError(TopoError):
    """A knot that is unknown, or a curve that has no knot type."""


def _again(kind: type[TopoError], message: str, fields: dict) -> TopoError:
    return kind(message, **fields)


def refuse(key: str, value: object, remedy: str) -> TopoError:
    """The error for an argument."""
    return TopoError(f"{key} = {value}: {remedy}", key=key, value=str(value), remedy=remedy)


def near(name: object, known: Iterable[str]) -> str:
    """The names that resemble one, as the beginning of a remedy."""
    known = list(known)
    close = difflib.get_close_matches(str(name), known, 3, 0.5) or known[:5]
    return "did you mean " + " or ".join(close) + "?" if close else "there is none"
