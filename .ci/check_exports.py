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
from ase.io import read as read_frames
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
    """Positions, radii and velocities, frame by frame, with their times."""
    frames = []
    for time, data in poly_data(run, "grains"):
        points = vtk_to_numpy(data.GetPoints().GetData())
        radius = vtk_to_numpy(data.GetPointData().GetArray("radius"))
        ids = vtk_to_numpy(data.GetPointData().GetArray("id"))
        velocity = vtk_to_numpy(data.GetPointData().GetArray("velocity"))
        speed = vtk_to_numpy(data.GetPointData().GetArray("speed"))
        require(data.GetNumberOfVerts() == len(points), "a vertex per grain")
        # Single numbers, squared and added.
        require(np.allclose(np.linalg.norm(velocity, axis=1), speed, rtol=1e-6, atol=1e-30), "a speed is another")
        order = np.argsort(ids)
        frames.append((time, points[order], radius[order], velocity[order]))
    return frames


def radius_of_model(run):
    intruder = tomllib.loads((run / "model.toml").read_text())["intruder"]
    number, unit = intruder["diameter"].split()
    return 0.5 * float(number) * {"m": 1, "cm": 1e-2, "mm": 1e-3}[unit]


def bodies(run):
    """The disc of every frame is where the table of its states says, and as large as the model does."""
    states = pd.read_csv(run / "csv" / "intruder_intruder_state.csv")
    radius = radius_of_model(run)
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
        velocity = vtk_to_numpy(data.GetPointData().GetArray("velocity"))
        # The corners lie all around the centre, so what they turn with cancels.
        mean = velocity.mean(axis=0, dtype=float)
        moves = state[["velocity_x_m_per_s", "velocity_y_m_per_s", "velocity_z_m_per_s"]]
        require(np.allclose(mean, moves.to_numpy(float), rtol=1e-5, atol=1e-6), mean)
        count += 1
    require(count > 1, "more than one frame")
    return f"bodies.pvd: {count} frames"


def of_ovito(path):
    """The same of all particles, and which of them are grains."""
    pipeline = import_file(str(path))
    frames = []
    for number in range(pipeline.source.num_frames):
        data = pipeline.compute(number)
        particles = data.particles
        order = np.argsort(np.asarray(particles["Particle Identifier"]))
        types = np.asarray(particles["Particle Type"])
        columns = (np.asarray(particles[name])[order] for name in ("Position", "Radius", "Velocity"))
        frames.append((float(data.attributes["Time"]), *columns, (types == types.min())[order]))
    return frames


def of_ase(path):
    """The same by the elements that stand for grains and bodies."""
    for frame in read_frames(path, index=":"):
        order = np.argsort(frame.arrays["id"])
        columns = (frame.arrays[name][order] for name in ("positions", "radius", "velo"))
        require(set(frame.get_chemical_symbols()) == {"Si", "Fe"}, "the elements")
        yield (frame.info["Time"], *columns, (frame.arrays["body"] == 0)[order])


def same_grains(name, frames, vtk):
    """Grains are where VTK has them and move as there."""
    require(len(frames) == len(vtk), f"{name}: {len(frames)} frames, {len(vtk)} in VTK")
    for expected, (time, *found, grains) in zip(vtk, frames):
        require(abs(expected[0] - time) < 1e-12, f"{name}: times differ")
        for what, a, b in zip(("positions", "radii", "velocities"), expected[1:], found):
            # The log has single precision.
            require(np.allclose(a, b[grains], rtol=1e-6, atol=1e-9), f"{name}: {what} differ")


def same_disc(name, run, frames):
    """The one particle that is no grain is the disc of the model, where the table of its states says."""
    states = pd.read_csv(run / "csv" / "intruder_intruder_state.csv")
    for time, position, radius, velocity, grains in frames:
        require(np.count_nonzero(~grains) == 1, f"{name}: bodies are not one particle")
        state = states.iloc[abs(states["time_s"] - time).argmin()]
        expected = state[[f"position_{axis}_m" for axis in "xyz"]], state[[f"velocity_{axis}_m_per_s" for axis in "xyz"]]
        for logged, found in zip(expected, (position, velocity)):
            # Single numbers.
            require(np.allclose(logged.to_numpy(float), found[~grains][0], rtol=1e-6, atol=1e-8), f"{name}: {logged}")
        require(abs(radius[~grains][0] / radius_of_model(run) - 1) < 1e-6, f"{name}: the disc has another radius")


def main():
    run = Path(sys.argv[1])
    print(tables(run))
    print(bodies(run))
    vtk = of_vtk(run)
    require(len(vtk) > 1, "more than one frame")
    dump, xyz = run / "lammps-dump" / "grains.dump", run / "extxyz" / "grains.xyz"
    for name, frames in {
        "grains.dump": of_ovito(dump),
        "grains.xyz": of_ovito(xyz),
        "grains.xyz in ASE": list(of_ase(xyz)),
    }.items():
        same_grains(name, frames, vtk)
        same_disc(name, run, frames)
        print(f"{name}: {len(frames)} frames of {np.count_nonzero(frames[0][-1])} grains and a disc")


main()
