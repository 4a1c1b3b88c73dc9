"""The tour of docs/tour.md in Python: from a run to the effect that a model lacks. Writes into the working folder."""

import plunge

# A run: a resistive-force model takes milliseconds.
run = plunge.run("two-term-vector")
print(f"{1e3 * run.depth.max():.2f} mm deep after {run.time[-1]:.4f} s")
dissipated = {name: values[-1] for name, values in run.energy.items() if name.startswith("dissipated")}
print({name: f"{1e3 * energy:.1f} mJ" for name, energy in dissipated.items()})

# How wrong is the model? Published depths and stopping times ship as a set, a force law as its model.
tables = plunge.new("s1-tables-vertical")
before = plunge.compare(tables)
print(f"error {before['models'][0]['rms']['fit']['rms_relative']:.1%}, lack of fit p = {before['models'][0]['p_lof']:.1e}")

# What is missing?
found = plunge.diagnose(tables)
print(f"{found['verdict']}, {found['strength']}: {', '.join(found['not_separable'])}")

# The diagnosis has written a model with each of the effects; with this one, the error falls.
better = found.folder / "model+depth-exponent.toml"
after = plunge.compare(tables, models=["two-term-components", better])
for model in after["models"]:
    print(f"{model['model']}: held out {model['rms']['holdout']['rms_relative']:.1%}")

# Many impacts side by side.
speeds = [1.0, 2.0, 3.0, 4.0]
runs = plunge.run_many("two-term-vector", [{"impact.speed": f"{speed} m/s"} for speed in speeds])
for speed, one in zip(speeds, runs):
    print(f"{speed} m/s: {1e3 * one.depth.max():.1f} mm")
