#!/usr/bin/env python3
"""Lists the topics of a run log and sums its energy ledger again, from the fields alone.

Exits with 1 if any step disagrees with the log's own `unaccounted_J` by more than round-off.
Needs: pip install mcap mcap-protobuf-support
"""

import argparse
import math
import sys

from mcap.reader import make_reader
from mcap_protobuf.decoder import DecoderFactory

SIGNS = {"kinetic": 1, "potential": 1, "elastic": 1, "dissipated": 1, "input": -1}


def terms(budget):
    """The ledger's terms as they enter the sum: energy put in counts negative."""
    names = (field.name for field in budget.DESCRIPTOR.fields)
    prefixes = ((name, name.split("_")[0]) for name in names)
    return [SIGNS[prefix] * getattr(budget, name) for name, prefix in prefixes if prefix in SIGNS]


parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
parser.add_argument("log", help="run.mcap; unfinished ones go through `plunge recover` first")
with open(parser.parse_args().log, "rb") as file:
    reader = make_reader(file, decoder_factories=[DecoderFactory()])
    summary = reader.get_summary()
    for id, channel in sorted(summary.channels.items()):
        count = summary.statistics.channel_message_counts.get(id, 0)
        print(f"{count:9d}  {channel.topic}  {summary.schemas[channel.schema_id].name}")

    first, worst, bad, steps = None, 0.0, 0, 0
    for message in reader.iter_decoded_messages(topics=["/energy/budget"]):
        budget = message.decoded_message
        now = terms(budget)
        first = first or (now, budget.unaccounted_J)
        start, start_unaccounted = first
        error = abs((math.fsum(now) - math.fsum(start)) - (budget.unaccounted_J - start_unaccounted))
        # The engine adds the n terms of each total one after the other: n - 1 roundings of partial
        # sums, none above the sum of magnitudes, and one more for each difference: n + 1 in all.
        size = math.fsum(map(abs, now)) + math.fsum(map(abs, start))
        bound = (len(now) + 1) * sys.float_info.epsilon * size
        steps, bad, worst = steps + 1, bad + (error > bound), max(worst, error)

print(f"{steps} steps of the ledger summed again: largest disagreement {worst:.3g} J, {bad} above round-off")
sys.exit(1 if bad or not steps else 0)
