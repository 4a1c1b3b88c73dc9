"""Calls of commands: their words, models that are dicts, progress, warnings, errors and Ctrl-C."""

from __future__ import annotations

import json
import os
import sys
import warnings
from collections.abc import Iterator, Mapping, Sequence
from typing import Any, Callable, Optional, Union

from . import _plunge

Model = Union[str, "os.PathLike[str]", Mapping[str, Any]]
"""The name of a shipped model, a file, or a nested dict."""

Progress = Union[bool, None, Callable[[str, Optional[float]], None]]
"""Whether to show progress on stderr, or who takes it: what is done, and the share of it that is done (0 to 1)."""

# Time between two looks at a command (s), and how long one that is to stop may take (s).
LOOK = 0.05
PATIENCE = 1.5


class PlungeError(Exception):
    """What the command line says in the same place."""


class InputError(PlungeError, ValueError):
    """The input is wrong: exit status 2 of the command line."""


class RunError(PlungeError, RuntimeError):
    """Something failed on the way: exit status 1 of the command line."""


class PlungeWarning(UserWarning):
    """A warning or a note, as the command line says it."""


def plain(value: Any) -> Any:
    """What JSON has in place of arrays and numbers of numpy, and of paths."""
    if hasattr(value, "tolist"):
        return value.tolist()
    if isinstance(value, os.PathLike):
        return os.fspath(value)
    raise TypeError(f"a model has no place for a {type(value).__name__}")


def as_json(value: Any) -> str:
    return json.dumps(value, default=plain, allow_nan=False, ensure_ascii=False)


def assignments(sets: Mapping[str, Any], above: str = "") -> Iterator[str]:
    """``key.path=value`` of a dict, nested or with points in its keys."""
    for key, value in sets.items():
        if isinstance(value, Mapping):
            yield from assignments(value, f"{above}{key}.")
        else:
            yield f"{above}{key}={_plunge.toml_of_value(as_json(value))}"


class Words:
    """The words of a command line, with the models that are in no file."""

    def __init__(self, *words: str) -> None:
        self.words = list(words)
        self.models: list[tuple[str, str]] = []

    def option(self, name: str, value: Any) -> None:
        """``--name=value``; ``--name`` if it is true, nothing if it is None or false."""
        if value is True:
            self.words.append(f"--{name}")
        elif value is not None and value is not False:
            self.words.append(f"--{name}={os.fspath(value) if isinstance(value, os.PathLike) else value}")

    def model(self, model: Model) -> str:
        """The word for a model."""
        if not isinstance(model, Mapping):
            return os.fspath(model)
        run = model.get("run")
        name = run.get("name") if isinstance(run, Mapping) else None
        word = f"<{name or 'model'}>"
        taken = [name for name, _ in self.models]
        if word in taken:
            word = f"<{name or 'model'} {len(taken) + 1}>"
        self.models.append((word, _plunge.toml_of_model(as_json(model))))
        return word

    def last(self, *words: Union[str, os.PathLike[str]]) -> None:
        """Arguments that are no options, whatever they begin with."""
        self.words += ["--", *(os.fspath(word) for word in words)]

    def call(self, progress: Progress) -> tuple[list[Any], bytearray]:
        return wait(_plunge.Call.command(self.words, self.models), progress)

    def many(self, variants: Sequence[Mapping[str, Any]], progress: Progress) -> tuple[list[Any], bytearray]:
        sets = [list(assignments(one)) for one in variants]
        return wait(_plunge.Call.many(self.words, self.models, sets), progress)

    def bed(self, progress: Progress) -> tuple[list[Any], bytearray]:
        return wait(_plunge.Call.bed(self.words, self.models), progress)


def wait(call: _plunge.Call, progress: Progress) -> tuple[list[Any], bytearray]:
    """What a command gives: its JSON objects, and grains."""
    meter = Meter(progress)
    try:
        while (ended := call.wait(LOOK)) is None:
            meter.show(call.progress())
    except BaseException:
        # KeyboardInterrupt above all. A command that is deep in arithmetic ends later, and writes nothing.
        call.stop()
        call.wait(PATIENCE)
        raise
    finally:
        meter.clear()
    tell(call.take_told())
    status, message, printed, grains = ended
    if status == 2:
        raise InputError(message.rstrip("\n"))
    if status != 0:
        raise RunError(message.rstrip("\n"))
    return [json.loads(text) for text in printed], grains


def tell(told: str) -> None:
    """Warnings and notes, each with the lines below it."""
    block: list[str] = []
    for line in [*told.splitlines(), "note:"]:
        if block and line.startswith(("warning:", "note:")):
            warnings.warn("\n".join(block).rstrip(), PlungeWarning, stacklevel=outside())
            block = []
        block.append(line)


def outside() -> int:
    """How many frames above ``tell`` the first is that is none of this package."""
    here, frame, level = os.path.dirname(__file__), sys._getframe(1), 1
    while frame.f_back is not None and os.path.dirname(frame.f_code.co_filename) == here:
        frame, level = frame.f_back, level + 1
    return level


class Meter:
    """One line on stderr, written again and again, or a function of the user."""

    def __init__(self, progress: Progress) -> None:
        self.told = progress if callable(progress) else None
        if progress is None:
            progress = sys.stderr.isatty() or "ipykernel" in sys.modules
        self.shown = self.told is None and bool(progress)
        self.width = 0

    def show(self, progress: Optional[tuple[str, Optional[float]]]) -> None:
        if progress is None:
            return
        words, share = progress
        if self.told is not None:
            self.told(words, share)
        elif self.shown:
            line = words if share is None else f"{100 * share:3.0f} %  {words}"
            print("\r" + line.ljust(self.width), end="", file=sys.stderr, flush=True)
            self.width = len(line)

    def clear(self) -> None:
        if self.width:
            print("\r" + " " * self.width + "\r", end="", file=sys.stderr, flush=True)
