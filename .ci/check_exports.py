"""Opens every export of one run with the reader that it is for, and holds them against each other.

usage: check_exports.py RUN

RUN is the folder of a finished run on grains with its exports in csv, parquet, vtp, lammps-dump and
extxyz, as `plunge export` leaves them.
"""

import sys
import tomllib
import xml.etree.ElementTree as ElementTree
from pathlib import Path

import numpy as np
import pandas as pd
from ovito.io import import_file
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkIOXML import vtkXMLPolyDataReader


def require(condition, what):
    if not condition:
        raise AssertionError(what)


def tables(run):
    """Both kinds of tables hold the same numbers, and the ledger closes in them."""
    names = sorted(path.stem for path in (run / "csv").glob("*.csv"))
    require(names == sorted(path.stem for path in (run / "parquet").glob("*.parquet")), names)
    for name in names:
        text = pd.read_csv(run / "csv" / f"{name}.csv")
        binary = pd.read_parquet(run / "parquet" / f"{name}.parquet")
        pd.testing.assert_frame_equal(text, binary, check_exact=True, check_dtype=False)
    budget = pd.read_parquet(run / "parquet" / "energy_budget.parquet")
    terms = [key for key in budget if key.startswith(("kinetic_", "potential_", "elastic_", "dissipated_"))]
    input_terms = [key for key in budget if key.startswith("input_")]
    held = budget[terms].sum(axis=1) - budget[input_terms].sum(axis=1)
    gained, logged = (values - values.iloc[0] for values in (held, budget["unaccounted_J"]))
    apart = abs(gained - logged).max()
    # Sums of a dozen doubles, none larger than what is held and lost together.
    require(apart < 1e-12 * abs(budget[terms]).sum(axis=1).max(), f"the ledger misses {apart} J")
    return f"{len(names)} tables, {len(budget)} rows"


def poly_data(run, name):
    """What ParaView reads of an index, frame by frame, with the times."""
    index = ElementTree.parse(run / "vtp" / f"{name}.pvd").getroot()
    for entry in index.iter("DataSet"):
        reader = vtkXMLPolyDataReader()
        reader.SetFileName(str(run / "vtp" / entry.get("file")))
        reader.Update()
        yield float(entry.get("timestep")), reader.GetOutput()


def of_vtk(run):
    """Positions and radii, frame by frame, with their times."""
    frames = []
    for time, data in poly_data(run, "grains"):
        points = vtk_to_numpy(data.GetPoints().GetData())
        radius = vtk_to_numpy(data.GetPointData().GetArray("radius"))
        ids = vtk_to_numpy(data.GetPointData().GetArray("id"))
        require(data.GetNumberOfVerts() == len(points), "a vertex per grain")
        order = np.argsort(ids)
        frames.append((time, points[order], radius[order]))
    return frames


def bodies(run):
    """The disc of every frame is where the table of its states says, and as large as the model does."""
    states = pd.read_csv(run / "csv" / "intruder_intruder_state.csv")
    intruder = tomllib.loads((run / "model.toml").read_text())["intruder"]
    number, unit = intruder["diameter"].split()
    radius = 0.5 * float(number) * {"m": 1, "cm": 1e-2, "mm": 1e-3}[unit]
    count = 0
    for time, data in poly_data(run, "bodies"):
        state = states.iloc[abs(states["time_s"] - time).argmin()]
        west, east, _, _, low, high = data.GetBounds()
        centre = [0.5 * (west + east), 0.5 * (low + high)]
        # Frames have the precision of single numbers.
        require(np.allclose(centre, state[["position_x_m", "position_z_m"]], atol=1e-8), centre)
        # A polygon of 48 corners, turned by anything, is as wide as its circle to within cos(pi / 48).
        widths = np.array([east - west, high - low]) / (2 * radius)
        require(np.all((np.cos(np.pi / 48) - 1e-6 < widths) & (widths < 1 + 1e-6)), widths)
        require(data.GetNumberOfPolys() > 0 and data.GetNumberOfVerts() == 0, "a surface")
        count += 1
    require(count > 1, "more than one frame")
    return f"bodies.pvd: {count} frames"


def of_ovito(path):
    pipeline = import_file(str(path))
    frames = []
    for number in range(pipeline.source.num_frames):
        data = pipeline.compute(number)
        ids = np.asarray(data.particles["Particle Identifier"])
        order = np.argsort(ids)
        frames.append((
            float(data.attributes["Time"]),
            np.asarray(data.particles["Position"])[order],
            np.asarray(data.particles["Radius"])[order],
        ))
    return frames


def main():
    run = Path(sys.argv[1])
    print(tables(run))
    print(bodies(run))
    vtk = of_vtk(run)
    require(len(vtk) > 1, "more than one frame")
    for path in (run / "lammps-dump" / "grains.dump", run / "extxyz" / "grains.xyz"):
        ovito = of_ovito(path)
        require(len(ovito) == len(vtk), f"{path}: {len(ovito)} frames, {len(vtk)} in VTK")
        for (time_a, points_a, radius_a), (time_b, points_b, radius_b) in zip(vtk, ovito):
            require(abs(time_a - time_b) < 1e-12, f"{path}: times differ")
            # The log has single precision.
            require(np.allclose(points_a, points_b, rtol=1e-6, atol=1e-9), f"{path}: positions differ")
            require(np.allclose(radius_a, radius_b, rtol=1e-6), f"{path}: radii differ")
        print(f"{path.name}: {len(ovito)} frames of {len(radius_a)} grains, as in VTK")


main()
