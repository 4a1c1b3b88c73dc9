#!/usr/bin/env python3
"""Opens the logs of a run in Rerun: grains and intruder, energy by channel, depth and force.

    python viewers/rerun_impact.py runs/hemisphere-3d                     # shows it
    python viewers/rerun_impact.py runs/hemisphere-3d -o hemisphere.rrd   # a file to open later

Needs: pip install -r .ci/python-requirements.txt rerun-sdk==0.41.0. Rerun calls the interface that maps protobuf fields to curves unstable, hence the
version.
"""

import argparse
from pathlib import Path

import numpy as np
import rerun as rr
import rerun.blueprint as rrb
from mcap.reader import make_reader
from mcap_protobuf.decoder import DecoderFactory
from rerun.blueprint.encodings import ComponentSourceKind, VisualizerComponentMapping


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


def energy_fields(log):
    """The channels of the ledger, without those that count nothing."""
    with open(log, "rb") as file:
        for record in make_reader(file).iter_metadata():
            if record.name == "run":
                identity = record.metadata["closure_identity"].split(" = ")[0]
                return [term for term in identity.replace("-", "+").split(" + ") if term]
    return []


def middling_radius(run):
    """The median radius of the grains (m)."""
    with open(run / "grains.mcap", "rb") as file:
        reader = make_reader(file, decoder_factories=[DecoderFactory()])
        _, _, _, cloud = next(iter(reader.iter_decoded_messages(topics=["/grains"])))
    kinds = [(field.name, "<u4" if field.name == "id" else "<f4") for field in cloud.fields]
    return float(np.median(np.frombuffer(cloud.data, dtype=kinds)["radius"]))


def blueprint(run):
    log = run / "run.mcap"
    found = topics(log)
    bodies = [topic.split("/")[2] for topic in found if topic.endswith("/state")]
    views = [
        rrb.TimeSeriesView(
            name="energy (J)",
            contents="/energy/budget",
            plot_legend=rrb.PlotLegend(visible=False),
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
                f"/intruder/{name}/load": curves(found[f"/intruder/{name}/load"], ["contact.z"])
                for name in bodies
            },
        ),
    ]
    return rrb.Blueprint(
        rrb.Horizontal(
            rrb.Spatial3DView(
                name="bed",
                origin="/",
                contents=["+ /grains", "+ /intruder/**", "+ /scene"],
                # Rerun does not take the radii from the cloud: all grains are drawn as a middling one.
                defaults=[rr.Points3D.from_fields(radii=middling_radius(run))],
            ),
            rrb.Vertical(*views),
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
    for name in ["run.mcap", "grains.mcap"]:
        if (arguments.run / name).exists():
            rr.log_file_from_path(arguments.run / name)


if __name__ == "__main__":
    main()
