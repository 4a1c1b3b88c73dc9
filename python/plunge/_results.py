"""What commands leave: logs as arrays, runs, and JSON objects with their folder."""

from __future__ import annotations

import functools
import json
import os
import shutil
import tempfile
import weakref
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any, Optional, Union

import numpy as np

from . import _plunge
from ._call import InputError

if TYPE_CHECKING:
    import pandas
    from numpy.typing import NDArray

    Array = NDArray[np.float64]


def array(numbers: bytearray, columns: Optional[int] = None) -> Array:
    flat = np.frombuffer(numbers, dtype=np.float64)
    return flat if columns is None else flat.reshape(-1, columns)


@dataclass(frozen=True)
class Body:
    """A body over the time of its run, in SI units; rows of vectors are x, y, z, with z upward."""

    time: Array
    """Since the start of the run (s)."""
    depth: Array
    """Of its lowest point below the undisturbed surface (m)."""
    position: Array
    """Of the centre of mass, the undisturbed surface at z = 0 (m)."""
    velocity: Array
    """Of the centre of mass (m/s)."""
    force_time: Array
    """Times of the forces (s)."""
    force: Array
    """Everything that acts on the body but its weight (N)."""


@dataclass(frozen=True)
class Log:
    """A ``run.mcap``."""

    bodies: dict[str, Body]
    """The bodies by their names; links of a chain are several."""
    energy: dict[str, Array]
    """``time`` (s), the terms of the energy budget (J), what they leave unaccounted for (J) and the closure (–)."""
    metadata: dict[str, str]
    """Name, hash of the model, versions."""
    complete: bool
    """Whether the log is finished; one that is not ends with its last whole chunk."""

    @property
    def body(self) -> Body:
        """The first body."""
        return next(iter(self.bodies.values()))

    def to_frame(self) -> pandas.DataFrame:
        """The first body as a DataFrame over its time; needs pandas."""
        import pandas

        body = self.body
        columns = {"depth_m": body.depth}
        for name, values in [("position_{}_m", body.position), ("velocity_{}_m_per_s", body.velocity)]:
            columns.update((name.format(axis), values[:, at]) for at, axis in enumerate("xyz"))
        if np.array_equal(body.force_time, body.time):
            columns.update((f"force_{axis}_N", body.force[:, at]) for at, axis in enumerate("xyz"))
        return pandas.DataFrame(columns, index=pandas.Index(body.time, name="time_s"))


def read_log(path: Union[str, os.PathLike[str]]) -> Log:
    """Reads a log, finished or not: a ``run.mcap``, or a folder with one."""
    path = os.fspath(path)
    if os.path.isdir(path):
        path = os.path.join(path, "run.mcap")
    try:
        log = _plunge.read_log(path)
    except ValueError as error:
        raise InputError(f"error: {error}") from None
    bodies = {
        name: Body(
            time=array(body["time"]),
            depth=array(body["depth"]),
            position=array(body["position"], 3),
            velocity=array(body["velocity"], 3),
            force_time=array(body["force_time"]),
            force=array(body["force"], 3),
        )
        for name, body in log["bodies"].items()
    }
    energy = {name: array(values) for name, values in log["energy"].items()}
    return Log(bodies, energy, log["metadata"], log["complete"])


def remove(folder: str, owner: int) -> None:
    """Removes a folder, unless this is a fork of the process that made it."""
    if os.getpid() == owner:
        shutil.rmtree(folder, ignore_errors=True)


class Out:
    """A folder for results: one that was asked for, or one that goes away with the last result in it."""

    def __init__(self, asked: Union[str, os.PathLike[str], None]) -> None:
        if asked is None:
            held = tempfile.mkdtemp(prefix="plunge-")
            weakref.finalize(self, remove, held, os.getpid())
            asked = os.path.join(held, "out")
        self.path = Path(asked)


class Result(dict[str, Any]):
    """The JSON object of a command, and the folder with its files."""

    def __init__(self, content: dict[str, Any], out: Out) -> None:
        super().__init__(content)
        self._out = out

    @property
    def folder(self) -> Path:
        """Where the files are. Without ``out=``, they go away with this object."""
        return self._out.path


class Bed(dict[str, Any]):
    """What ``plunge bed --json`` prints, and the grains."""

    def __init__(self, content: dict[str, Any], grains: Array) -> None:
        super().__init__(content)
        self.position: Array = grains[:, :3]
        """Centres, one row per grain (m)."""
        self.radius: Array = grains[:, 3]
        """Radii (m)."""


class Run:
    """An impact, or the impacts of a model with ``[conditions]``: a summary, and the log as arrays in SI units."""

    def __init__(self, summary: dict[str, Any], folder: Path, out: Out) -> None:
        self.summary = summary
        """What ``summary.json`` holds."""
        self.folder = folder
        """Where the files are. Without ``out=``, they go away with this object."""
        self._out = out

    def __fspath__(self) -> str:
        return os.fspath(self.folder)

    def __repr__(self) -> str:
        return f"<plunge.Run {self.summary['name']} in {self.folder}>"

    @functools.cached_property
    def runs(self) -> list[Run]:
        """The impacts one by one; of a single one, itself."""
        if "runs" not in self.summary:
            return [self]
        members = enumerate(self.summary["runs"], start=1)
        return [Run(one, self.folder / f"{at:03}", self._out) for at, one in members]

    @functools.cached_property
    def log(self) -> Log:
        """The log, read when it is first asked for."""
        if "runs" in self.summary:
            raise InputError(f"error: this run has {len(self.runs)} impacts; take one of its `runs`")
        return read_log(self)

    @property
    def time(self) -> Array:
        """Since the start of the run (s)."""
        return self.log.body.time

    @property
    def depth(self) -> Array:
        """Of the lowest point of the first body below the undisturbed surface (m)."""
        return self.log.body.depth

    @property
    def position(self) -> Array:
        """Of the centre of mass of the first body: x, y, z (m)."""
        return self.log.body.position

    @property
    def velocity(self) -> Array:
        """Of the centre of mass of the first body: x, y, z (m/s)."""
        return self.log.body.velocity

    @property
    def force(self) -> Array:
        """On the first body, without its weight: x, y, z (N), at the times ``log.body.force_time``."""
        return self.log.body.force

    @property
    def energy(self) -> dict[str, Array]:
        """The energy budget by its terms (J), with its ``time`` (s)."""
        return self.log.energy

    def to_frame(self) -> pandas.DataFrame:
        """The first body as a DataFrame over its time; needs pandas."""
        return self.log.to_frame()


def read_run(folder: Union[str, os.PathLike[str]]) -> Run:
    """A run that is there: the folder that ``run`` or ``plunge run`` wrote."""
    out = Out(folder)
    try:
        with open(out.path / "summary.json", encoding="utf-8") as file:
            return Run(json.load(file), out.path, out)
    except OSError as error:
        raise InputError(f"error: {out.path} holds no finished run: {error}") from None
