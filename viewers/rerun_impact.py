#!/usr/bin/env python3
"""Opens the logs of a run in Rerun: grains by speed, intruder, force on it, energy by channel, depth.

    python viewers/rerun_impact.py runs/hemisphere-3d                     # shows it
    python viewers/rerun_impact.py runs/hemisphere-3d -o hemisphere.rrd   # a file to open later

Needs: pip install mcap mcap-protobuf-support numpy rerun-sdk==0.41.0. Rerun calls the interface that
maps protobuf fields to curves unstable, hence the version. Of the messages that it reads by itself it takes
neither radii and colours of grains nor what is drawn on `/scene`: these are put into it here.
"""

import argparse
from pathlib import Path

import numpy as np
import rerun as rr
import rerun.blueprint as rrb
from mcap.reader import make_reader
from mcap_protobuf.decoder import DecoderFactory
from rerun.blueprint.encodings import ComponentSourceKind, VisualizerComponentMapping

BODY = [110, 130, 160, 255]
FORCE = [230, 60, 40, 255]


def topics(log):
    """Topic and full name of its message, of everything in a log."""
    with open(log, "rb") as file:
        summary = make_reader(file).get_summary()
    return {
        channel.topic: summary.schemas[channel.schema_id].name for channel in summary.channels.values()
    }


def curves(message, fields):
    """One curve per field of a protobuf message."""
    return [
        rrb.Visualizer(
            "SeriesLines",
            overrides=rr.SeriesLines(names=field).as_component_batches(),
            mappings=[
                VisualizerComponentMapping(
                    "Scalars:scalars",
                    ComponentSourceKind.SourceComponent,
                    source_component=f"{message}:message",
                    selector=f".{field}",
                )
            ],
        )
        for field in fields
    ]


def upward_forces(log, body):
    """The parts of the force of the bed: contacts of grains, or the terms of a resistive medium."""
    _, _, load = next(decoded(log, [f"/intruder/{body}/load"]))
    vectors = [field.name for field in load.DESCRIPTOR.fields if field.message_type]
    return [f"{name}.z" for name in vectors if name != "gravity" and not name.endswith("_torque")]


def energy_fields(log):
    """The channels of the ledger that reach a hundredth of the largest, without heights: their zero is arbitrary."""
    with open(log, "rb") as file:
        runs = (record.metadata for record in make_reader(file).iter_metadata() if record.name == "run")
        identity = next(runs, {"closure_identity": ""})["closure_identity"].split(" = ")[0]
    terms = [term for term in identity.replace("-", "+").split(" + ") if term and not term.startswith("potential_")]
    most = {term: 0.0 for term in terms}
    for _, _, budget in decoded(log, ["/energy/budget"]):
        most = {term: max(largest, abs(getattr(budget, term))) for term, largest in most.items()}
    return [term for term, largest in most.items() if largest > 0.01 * max(most.values())]


def decoded(log, topics):
    """Topic, time (ns) and message of everything on some topics."""
    with open(log, "rb") as file:
        reader = make_reader(file, decoder_factories=[DecoderFactory()])
        for _, channel, record, message in reader.iter_decoded_messages(topics=topics):
            yield channel.topic, record.log_time, message


def colours(shares):
    """Dark blue over green to yellow, as 0 goes to 1."""
    stops = np.array([[68, 1, 84], [59, 82, 139], [33, 145, 140], [94, 201, 98], [253, 231, 37]])
    at = np.clip(shares, 0, 1) * (len(stops) - 1)
    return np.stack([np.interp(at, range(len(stops)), stops[:, i]) for i in range(3)], axis=1).astype(np.uint8)


def xyz(vector):
    return [vector.x, vector.y, vector.z]


def turn(quaternion):
    return rr.Quaternion(xyzw=[quaternion.x, quaternion.y, quaternion.z, quaternion.w])


def draw_body(entity):
    """The shape of a body, in its own frame."""
    path = f"impact/{entity.id}"
    for sphere in entity.spheres:
        half = [0.5 * size for size in xyz(sphere.size)]
        rr.log(path, rr.Ellipsoids3D(half_sizes=[half], colors=BODY, fill_mode="solid"), static=True)
    for disc in entity.cylinders:
        size, pose = disc.size, disc.pose
        cylinder = rr.Cylinders3D(
            lengths=[size.z], radii=[0.5 * size.x], quaternions=[turn(pose.orientation)], colors=BODY, fill_mode="solid"
        )
        rr.log(path, cylinder, static=True)
    for mesh in entity.triangles:
        corners = np.array([xyz(point) for point in mesh.points])
        triangles = np.array(mesh.indices).reshape(-1, 3)
        rr.log(path, rr.Mesh3D(vertex_positions=corners, triangle_indices=triangles, albedo_factor=BODY), static=True)


def along(quaternion):
    """Where the x axis, along which arrows are drawn, points after a turn."""
    x, y, z, w = quaternion.x, quaternion.y, quaternion.z, quaternion.w
    return np.array([1 - 2 * (y * y + z * z), 2 * (x * y + w * z), 2 * (x * z - w * y)])


def draw_frames(log, speed):
    """Everything that is drawn of the frames of a log; grains are yellow from `speed` (m/s) on.

    A bed in space is cut open through the body at the start: the half towards the eye is left out.
    """
    drawn, cut = set(), None
    for topic, time, message in decoded(log, ["/tf", "/scene", "/grains"]):
        rr.set_time("message_log_time", timestamp=np.datetime64(time, "ns"))
        if topic == "/tf":
            if cut is None and message.transforms:
                cut = message.transforms[0].translation.y - 1e-9
            for place in message.transforms:
                pose = rr.Transform3D(translation=xyz(place.translation), quaternion=turn(place.rotation))
                rr.log(f"impact/{place.child_frame_id}", pose)
        elif topic == "/scene":
            for entity in message.entities:
                if entity.id == entity.frame_id and entity.id not in drawn:
                    drawn.add(entity.id)
                    draw_body(entity)
                if entity.id == "force":
                    vectors = [arrow.shaft_length * along(arrow.pose.orientation) for arrow in entity.arrows]
                    origins = [xyz(arrow.pose.position) for arrow in entity.arrows]
                    rr.log("impact/force", rr.Arrows3D(vectors=vectors, origins=origins, colors=FORCE))
        else:
            grains = points(message)
            grains = grains if cut is None else grains[grains["y"] >= cut]
            positions = np.stack([grains[axis] for axis in "xyz"], axis=1)
            shades = colours(grains["speed"] / speed)
            rr.log("impact/grains", rr.Points3D(positions, radii=grains["radius"], colors=shades))


def points(cloud):
    kinds = [(field.name, "<u4" if field.name == "id" else "<f4") for field in cloud.fields]
    return np.frombuffer(cloud.data, dtype=kinds)


def speed_of_impact(log):
    """Of the fastest body, at the start (m/s)."""
    first = {}
    for topic, _, state in decoded(log, [topic for topic in topics(log) if topic.endswith("/state")]):
        first.setdefault(topic, state.speed_m_per_s)
    return max(first.values()) or 1.0


def from_the_side(run):
    """A look along y at the place of the impact."""
    log = next(log for log in (run / "grains.mcap", run / "run.mcap") if log.exists())
    _, _, first = next(decoded(log, ["/tf"]))
    x, y, z = xyz(first.transforms[0].translation)
    clouds = decoded(log, ["/grains"])
    width = max((np.ptp(points(cloud)["x"]) for _, _, cloud in [next(clouds, (0, 0, None))] if cloud), default=0.12)
    target = [x, y, z - 0.3 * width]
    return rrb.EyeControls3D(position=[x, y - 1.2 * width, target[2]], look_target=target, eye_up=[0, 0, 1])


def blueprint(run):
    log = run / "run.mcap"
    found = topics(log)
    bodies = [topic.split("/")[2] for topic in found if topic.endswith("/state")]
    views = [
        rrb.TimeSeriesView(
            name="energy (J)",
            contents="/energy/budget",
            plot_legend=rrb.PlotLegend(corner=rrb.Corner2D.RightTop),
            overrides={"/energy/budget": curves(found["/energy/budget"], energy_fields(log))},
        ),
        rrb.TimeSeriesView(
            name="depth (m)",
            contents=[f"/intruder/{name}/state" for name in bodies],
            overrides={
                f"/intruder/{name}/state": curves(found[f"/intruder/{name}/state"], ["depth_m"])
                for name in bodies
            },
        ),
        rrb.TimeSeriesView(
            name="upward force of the bed (N)",
            contents=[f"/intruder/{name}/load" for name in bodies],
            overrides={
                f"/intruder/{name}/load": curves(found[f"/intruder/{name}/load"], upward_forces(log, name))
                for name in bodies
            },
        ),
    ]
    return rrb.Blueprint(
        rrb.Horizontal(
            rrb.Spatial3DView(name="impact", origin="/impact", eye_controls=from_the_side(run)),
            rrb.Vertical(*views, row_shares=[2, 1, 1]),
            column_shares=[3, 2],
        ),
        collapse_panels=True,
    )


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("run", type=Path, help="folder of a run")
    parser.add_argument("-o", "--output", type=Path, help="write an .rrd file in place of showing it")
    arguments = parser.parse_args()
    layout = blueprint(arguments.run)
    rr.init("plunge", spawn=arguments.output is None, default_blueprint=layout)
    if arguments.output is not None:
        rr.save(arguments.output, default_blueprint=layout)
    rr.log_file_from_path(arguments.run / "run.mcap")
    grains = arguments.run / "grains.mcap"
    frames = grains if grains.exists() else arguments.run / "run.mcap"
    draw_frames(frames, 0.5 * speed_of_impact(arguments.run / "run.mcap"))


if __name__ == "__main__":
    main()
