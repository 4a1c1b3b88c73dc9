"""Impacts on granular beds: simulate them, compare them with measurements, find what is missing.

Each function is the command of the same name, in this process: the same files, the same words in errors. Values of
models and options are those of the command line.
"""

from __future__ import annotations

import os
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any, Optional, Union

from ._call import InputError, Model, PlungeError, PlungeWarning, Progress, RunError, Words, assignments
from ._results import Bed, Body, Log, Out, Result, Run, array, read_log, read_run

__all__ = [
    "Bed",
    "Body",
    "InputError",
    "Log",
    "PlungeError",
    "PlungeWarning",
    "Result",
    "Run",
    "RunError",
    "bed",
    "compare",
    "diagnose",
    "import_tracks",
    "new",
    "read_log",
    "read_run",
    "run",
    "run_many",
]

_Path = Union[str, "os.PathLike[str]"]


def _of_model(
    words: Words,
    sets: Mapping[str, Any],
    options: Mapping[str, Any],
) -> None:
    words.words += [f"--set={one}" for one in assignments(sets)]
    for name, value in options.items():
        words.option(name, value)


def run(
    model: Model,
    *,
    out: Optional[_Path] = None,
    seed: Optional[int] = None,
    threads: Optional[int] = None,
    cache: Optional[_Path] = None,
    force: bool = False,
    resume: bool = False,
    progress: Progress = None,
    **sets: Any,
) -> Run:
    """Runs the impacts of a model, as ``plunge run`` does.

    ``sets`` change keys of the model: ``impact={"speed": "2 m/s"}``, or ``**{"impact.speed": "2 m/s"}``. Without
    ``out``, files go to a folder that is removed with the result.
    """
    words, place = Words("run", "--json"), Out(out)
    options = dict(out=place.path, seed=seed, threads=threads, cache=cache, force=force, resume=resume)
    _of_model(words, sets, options)
    words.last(words.model(model))
    (summary,), _ = words.call(progress)
    return Run(summary, place.path, place)


def run_many(
    model: Model,
    variants: Sequence[Mapping[str, Any]],
    *,
    out: Optional[_Path] = None,
    seed: Optional[int] = None,
    threads: Optional[int] = None,
    cache: Optional[_Path] = None,
    force: bool = False,
    resume: bool = False,
    progress: Progress = None,
    **sets: Any,
) -> list[Run]:
    """Runs a model once with each of ``variants``, dicts like ``sets`` of ``run``, and gives the runs in their order.

    ``threads`` run at a time (one per core unless said), each on one thread, into the folders ``001``, ``002`` … of
    ``out``. All models are read before the first is run. No reports are made: ``plunge report`` makes them.
    """
    words, place = Words("--json"), Out(out)
    options = dict(out=place.path, seed=seed, threads=threads, cache=cache, force=force, resume=resume)
    _of_model(words, sets, options)
    words.last(words.model(model))
    summaries, _ = words.many(variants, progress)
    return [Run(one, place.path / f"{at:03}", place) for at, one in enumerate(summaries, start=1)]


def bed(
    model: Model,
    *,
    seed: Optional[int] = None,
    threads: Optional[int] = None,
    cache: Optional[_Path] = None,
    force: bool = False,
    progress: Progress = None,
    **sets: Any,
) -> Bed:
    """Prepares the bed of a model, as ``plunge bed`` does, and gives its numbers and grains."""
    words = Words("--json")
    _of_model(words, sets, dict(seed=seed, threads=threads, cache=cache, force=force))
    words.last(words.model(model))
    (found,), grains = words.bed(progress)
    return Bed(found, array(grains, 4))


def _of_set(
    words: Words,
    models: Sequence[Model],
    free: Sequence[str],
    candidates: Sequence[str],
) -> None:
    for model in models:
        words.option("model", words.model(model))
    for name, values in [("free", free), ("candidate", candidates)]:
        for value in values:
            words.option(name, value)


def compare(
    first: _Path,
    second: Optional[_Path] = None,
    *,
    models: Sequence[Model] = (),
    out: Optional[_Path] = None,
    seed: Optional[int] = None,
    threads: Optional[int] = None,
    cache: Optional[_Path] = None,
    budget: Optional[str] = None,
    force: bool = False,
    trust_scalars: bool = False,
    trust_zeros: bool = False,
    trust_speeds: bool = False,
    progress: Progress = None,
    **sets: Any,
) -> Result:
    """Compares ``models`` with the measurement set ``first``, or the run ``first`` with the run ``second``.

    Gives what ``comparison.json`` holds, or what ``plunge compare --json`` prints of two runs.
    """
    words, place = Words("compare", "--json"), Out(out)
    options: dict[str, Any] = dict(seed=seed, threads=threads, cache=cache, budget=budget, force=force)
    options.update({"trust-scalars": trust_scalars, "trust-zeros": trust_zeros, "trust-speeds": trust_speeds})
    _of_model(words, sets, {**options, "out": place.path})
    _of_set(words, models, (), ())
    words.last(first, *([] if second is None else [second]))
    (found,), _ = words.call(progress)
    return Result(found, place)


def diagnose(
    measured: _Path,
    *,
    model: Optional[Model] = None,
    out: Optional[_Path] = None,
    seed: Optional[int] = None,
    threads: Optional[int] = None,
    cache: Optional[_Path] = None,
    budget: Optional[str] = None,
    free: Sequence[str] = (),
    candidates: Sequence[str] = (),
    calibrate: bool = False,
    force: bool = False,
    trust_scalars: bool = False,
    trust_zeros: bool = False,
    trust_speeds: bool = False,
    progress: Progress = None,
    **sets: Any,
) -> Result:
    """Finds out which effect ``model`` lacks, before a measurement set; gives what ``diagnosis.json`` holds."""
    words, place = Words("diagnose", "--json"), Out(out)
    options = dict(seed=seed, threads=threads, cache=cache, budget=budget, calibrate=calibrate, force=force)
    options.update({"trust-scalars": trust_scalars, "trust-zeros": trust_zeros, "trust-speeds": trust_speeds})
    _of_model(words, sets, {**options, "out": place.path})
    _of_set(words, [] if model is None else [model], free, candidates)
    words.last(measured)
    (found,), _ = words.call(progress)
    return Result(found, place)


def import_tracks(
    files: Union[_Path, Sequence[_Path]],
    out: _Path,
    *,
    column: Optional[Mapping[str, str]] = None,
    force: bool = False,
    **options: Union[str, bool, _Path, None],
) -> Result:
    """Makes the measurement set ``out`` of tables of tracking programs, as ``plunge import`` does.

    ``options`` are those of the command line: ``diameter="25.4 mm"``, ``length_unit="px"``, ``up=True``. ``column``
    names columns: ``{"t": "Time", "z": "Height"}``.
    """
    words, place = Words("import", "--json"), Out(out)
    for name, value in {**options, "out": place.path, "force": force}.items():
        words.option(name.replace("_", "-"), value)
    for key, name in (column or {}).items():
        words.option("column", f"{key}={name}")
    words.last(*([files] if isinstance(files, (str, os.PathLike)) else files))
    (found,), _ = words.call(False)
    return Result(found, place)


def new(name: str) -> Path:
    """Writes what comes with plunge into the working folder, as ``plunge new`` does: a model, a measurement set, a file to
    fill in."""
    words = Words("new", "--json")
    words.last(name)
    (written,), _ = words.call(False)
    return Path(written.get("folder") or written["file"])
