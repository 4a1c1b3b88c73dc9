#!/usr/bin/env python3
"""Draws an impact from the logs of a run: the bed at four times, and where the energy went.

Needs: pip install -r .ci/python-requirements.txt matplotlib numpy
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

GRAIN = np.dtype([(name, "<f4") for name in ("x", "y", "z", "radius", "speed", "force")] + [("id", "<u4")])


def messages(log, topic):
    """Simulated time (s) and message of everything on a topic."""
    with open(log, "rb") as file:
        reader = make_reader(file, decoder_factories=[DecoderFactory()])
        for _, _, raw, message in reader.iter_decoded_messages(topics=[topic]):
            yield raw.log_time * 1e-9, message


def draw_bed(axes, time, grains, pose, radius, speed):
    centres = np.column_stack([grains["x"], grains["z"]])
    sizes = 2 * grains["radius"]
    discs = EllipseCollection(
        sizes, sizes, 0, units="x", offsets=centres, offset_transform=axes.transData, cmap="magma_r"
    )
    discs.set_array(grains["speed"])
    discs.set_clim(0, 0.5 * speed)
    axes.add_collection(discs)
    axes.add_patch(plt.Circle((pose.x, pose.z), radius, color="tab:blue"))
    axes.set(title=f"{1e3 * time:.0f} ms", aspect="equal", xticks=[], yticks=[])
    return discs


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
    name = next(topic.split("/")[2] for topic in topics if topic.startswith("/intruder/"))
    states = list(messages(run, f"/intruder/{name}/state"))
    speed = states[0][1].speed_m_per_s
    radius = states[0][1].position.z
    frames = [(time, np.frombuffer(cloud.data, dtype=GRAIN)) for time, cloud in messages(grains, "/grains")]
    poses = {time: pose.pose.position for time, pose in messages(grains, f"/intruder/{name}/pose")}
    picked = [frames[round(share * (len(frames) - 1))] for share in (0, 0.08, 0.3, 1)]

    figure = plt.figure(figsize=(11, 6.2), layout="constrained")
    top, bottom = figure.subfigures(2, 1, height_ratios=(1.25, 1))
    for axes, (time, cloud) in zip(top.subplots(1, 4), picked):
        discs = draw_bed(axes, time, cloud, poses[time], radius, speed)
        start = states[0][1].position.x
        axes.set(xlim=(start - 7 * radius, start + 7 * radius), ylim=(-9 * radius, 4 * radius))
    top.colorbar(discs, ax=top.axes, label="grain speed (m/s)", shrink=0.8)
    draw_energy(bottom.subplots(), run)
    figure.savefig(options.picture, dpi=110)


main()
