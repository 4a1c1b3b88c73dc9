#!/usr/bin/env python3
"""Draws an impact from the logs of a run: the bed at four times, and where the energy went.

Needs: pip install mcap mcap-protobuf-support matplotlib numpy
"""

import argparse
from pathlib import Path

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np
from matplotlib.collections import EllipseCollection
from mcap.reader import make_reader
from mcap_protobuf.decoder import DecoderFactory

def messages(log, topic):
    """Simulated time (s) and message of everything on a topic."""
    with open(log, "rb") as file:
        reader = make_reader(file, decoder_factories=[DecoderFactory()])
        for _, _, raw, message in reader.iter_decoded_messages(topics=[topic]):
            yield raw.log_time * 1e-9, message


def cut(grains, y):
    """The discs in which the plane at y cuts the grains; a planar bed lies in it."""
    apart = grains["y"] - y
    here = np.abs(apart) < grains["radius"]
    return grains[here], np.sqrt(grains["radius"][here] ** 2 - apart[here] ** 2)


def turned(points, q):
    """Points turned by a quaternion."""
    axis = np.array([q.x, q.y, q.z])
    first = np.cross(axis, points)
    return points + 2 * (q.w * first + np.cross(axis, first))


def outline(entity, pose):
    """The body from the side, as corners in x and z."""
    turns = np.linspace(0, 2 * np.pi, 100)
    circle = np.column_stack([np.cos(turns), np.sin(turns)])
    for round_shape in [*entity.spheres, *entity.cylinders]:
        return 0.5 * round_shape.size.x * circle + [pose.position.x, pose.position.z]
    corners = np.array([[p.x, p.y, p.z] for p in entity.triangles[0].points])
    placed = turned(corners, pose.orientation)[:, [0, 2]] + [pose.position.x, pose.position.z]
    # Convex: its farthest corner in every direction.
    return placed[[np.argmax(placed @ direction) for direction in circle]]


def draw_bodies(axes, bodies, time):
    for entity, poses in bodies:
        axes.add_patch(plt.Polygon(outline(entity, poses[time]), color="tab:blue"))


def draw_bed(axes, time, grains, bodies, speed):
    grains, radius = cut(grains, bodies[0][1][time].position.y)
    centres = np.column_stack([grains["x"], grains["z"]])
    discs = EllipseCollection(
        2 * radius, 2 * radius, 0, units="x", offsets=centres, offset_transform=axes.transData, cmap="magma_r"
    )
    discs.set_array(grains["speed"])
    discs.set_clim(0, 0.5 * speed)
    axes.add_collection(discs)
    draw_bodies(axes, bodies, time)
    axes.set(title=f"{1e3 * time:.0f} ms", aspect="equal", xticks=[], yticks=[])
    return discs


def points(cloud):
    """The values of a point cloud by name."""
    kinds = np.dtype([(field.name, "<u4" if field.name == "id" else "<f4") for field in cloud.fields])
    return np.frombuffer(cloud.data, dtype=kinds)


def draw_fields(axes, time, field, crater, bodies):
    """Velocity where grains are, and the mean surface around the impact."""
    inside = field[field["packing_fraction"] > 0.2]
    axes.quiver(inside["x"], inside["z"], inside["vx_m_per_s"], inside["vz_m_per_s"], inside["speed_m_per_s"], cmap="viridis")
    axes.plot(crater["x"], crater["z"], color="tab:red", lw=1.5)
    nearest = min(bodies[0][1], key=lambda other: abs(other - time))
    draw_bodies(axes, bodies, nearest)
    axes.set(title=f"{1e3 * time:.0f} ms", aspect="equal", xticks=[], yticks=[])


def draw_energy(axes, log):
    budgets = list(messages(log, "/energy/budget"))[::20]
    times = np.array([time for time, _ in budgets])
    fields = [field.name for field in budgets[0][1].DESCRIPTOR.fields]
    value = {name: np.array([getattr(budget, name) for _, budget in budgets]) for name in fields}
    kinetic = [name for name in fields if name.startswith("kinetic_intruder")]
    initial = sum(value[name][0] for name in kinetic)

    def change(prefix):
        return sum(value[name] - value[name][0] for name in fields if name.startswith(prefix)) / initial

    shares = {
        "intruder, kinetic": sum(value[name] for name in kinetic) / initial,
        "grains and springs": change("kinetic_grains") + change("potential_grains") + change("elastic"),
        "normal damping": change("dissipated_normal_damping"),
        "tangential damping": change("dissipated_tangential_damping"),
        "sliding": change("dissipated_sliding"),
        "walls": change("dissipated_walls"),
    }
    shares["other channels"] = change("dissipated") - sum(list(shares.values())[2:])
    axes.stackplot(times, [np.maximum(share, 0) for share in shares.values()], labels=shares)
    axes.plot(times, 1 - change("potential_intruder"), "k--", lw=1, label="impact energy and fall")
    axes.set(xlabel="time (s)", ylabel="share of the impact energy", xlim=(0, times[-1]))
    axes.legend(fontsize=8, loc="upper left", bbox_to_anchor=(1, 1))


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("folder", type=Path, help="folder of a run, with run.mcap and grains.mcap")
    parser.add_argument("picture", type=Path, help="PNG or SVG to write")
    options = parser.parse_args()
    run, grains = options.folder / "run.mcap", options.folder / "grains.mcap"

    topics = [channel.topic for channel in make_reader(open(run, "rb")).get_summary().channels.values()]
    names = [topic.split("/")[2] for topic in topics if topic.startswith("/intruder/") and topic.endswith("/state")]
    _, scene = next(messages(grains, "/scene"))
    entities = {entity.id: entity for entity in scene.entities}
    bodies = [
        (entities[name], {time: pose.pose for time, pose in messages(grains, f"/intruder/{name}/pose")}) for name in names
    ]
    first = next(messages(run, f"/intruder/{names[0]}/state"))[1]
    speed, start = first.speed_m_per_s, first.position.x
    size = np.ptp(np.vstack([outline(entity, poses[0.0]) for entity, poses in bodies]), axis=0).max() / 2
    frames = [(time, points(cloud)) for time, cloud in messages(grains, "/grains")]
    picked = [frames[round(share * (len(frames) - 1))] for share in (0, 0.08, 0.3, 1)]
    fields = list(zip(messages(run, "/bed/field"), messages(run, "/bed/crater")))
    window = dict(xlim=(start - 7 * size, start + 7 * size), ylim=(-9 * size, 4 * size))
    if max(abs(frames[0][1]["y"])) > 0:
        window = dict(xlim=(start - 3.5 * size, start + 3.5 * size), ylim=(-6 * size, 3 * size))

    rows = 3 if fields else 2
    figure = plt.figure(figsize=(11, 3.1 * rows), layout="constrained")
    top, *middle, bottom = figure.subfigures(rows, 1)
    for axes, (time, cloud) in zip(top.subplots(1, 4), picked):
        discs = draw_bed(axes, time, cloud, bodies, speed)
        axes.set(**window)
    top.colorbar(discs, ax=top.axes, label="grain speed (m/s)", shrink=0.8)
    for part in middle:
        for axes, ((time, field), (_, crater)) in zip(part.subplots(1, len(fields), squeeze=False)[0], fields):
            draw_fields(axes, time, points(field), points(crater), bodies)
            axes.set(**window)
    draw_energy(bottom.subplots(), run)
    figure.savefig(options.picture, dpi=110)


main()
