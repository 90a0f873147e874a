"""Progress of a run: a bar of tqdm in terminals and notebooks, or plain lines where tqdm is not there."""

from __future__ import annotations

import sys
import time
import warnings
from typing import Callable, NamedTuple, Union

PAUSE = 5.0  # shortest time between two plain lines, in seconds


class Event(NamedTuple):
    """What a run says of itself; a function given as ``progress`` is called with it, between two steps of the run."""

    kind: str
    """What happened: ``"begin"``, ``"replaced"``, ``"knot"``, ``"working"`` or ``"case"``."""
    name: str
    """Case or knot."""
    done: int
    """Cases finished so far, those of earlier runs included."""
    total: int
    """Cases of the scene."""
    text: str
    """What there is to say: where a case is, its warnings, why earlier ones are computed again."""


Progress = Union[bool, Callable[[Event], object]]


class Listener:
    """Turns what a run says into events for a function."""

    def __init__(self, show: Callable[[Event], object]) -> None:
        self.show, self.done, self.total = show, 0, 0

    def __call__(self, kind: str, *said) -> None:
        name, text = "", ""
        if kind == "begin":
            self.total, self.done, seconds = said
            text = f"about {seconds:.0f} s" if seconds >= 1 else ""
        elif kind == "replaced":
            names, text = said
            name = ", ".join(names[:3]) + (", ..." if len(names) > 3 else "")
        elif kind == "knot":
            name, text = said[0], f"ropelength {said[1]:.3f}"
        elif kind == "working":
            name, text = said
        elif kind == "case":
            name, self.done, text, _ = said
        self.show(Event(kind, name, self.done, self.total, text))


class Bar:
    """A bar of tqdm."""

    def __init__(self) -> None:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # of widgets that are not there
            from tqdm.auto import tqdm
        self.make, self.bar = tqdm, None

    def __call__(self, event: Event) -> None:
        if event.kind == "begin" and event.total > event.done:
            self.close()
            with warnings.catch_warnings():
                warnings.simplefilter("ignore")
                self.bar = self.make(total=event.total, initial=event.done, unit="case", dynamic_ncols=True)
        if self.bar is None:
            return
        if event.kind == "case":
            self.bar.update(1)
            if event.text:
                self.make.write(f"{event.name}: {event.text}", file=sys.stderr)
        if event.kind in ("case", "knot", "working"):
            self.bar.set_postfix_str(event.name)

    def close(self) -> None:
        if self.bar is not None:
            self.bar.close()


class Lines:
    """Plain lines, one every few seconds."""

    def __init__(self) -> None:
        self.said = time.monotonic()

    def __call__(self, event: Event) -> None:
        last = event.kind == "case" and event.done == event.total
        if event.kind == "case" and event.text:
            print(f"{event.name}: {event.text}", file=sys.stderr)
        if last or time.monotonic() - self.said >= PAUSE:
            self.said = time.monotonic()
            print(f"{event.done}/{event.total} {event.name} {event.text}".rstrip(), file=sys.stderr)

    def close(self) -> None:
        pass


def listener(progress: Progress) -> tuple[Listener | None, Callable[[], None]]:
    """What hears a run, and what ends it."""
    if progress is False or progress is None:
        return None, lambda: None
    if callable(progress):
        return Listener(progress), lambda: None
    try:
        shown: Bar | Lines = Bar()
    except ImportError:
        shown = Lines()
    return Listener(shown), shown.close
