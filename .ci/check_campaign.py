"""Holds the table of a campaign against its plan and against what its points say themselves.

usage: check_campaign.py CAMPAIGN

CAMPAIGN is the folder of a campaign as `plunge sweep` leaves it.
"""

import json
import sys
from pathlib import Path

import pandas as pd


def require(condition, what):
    if not condition:
        raise AssertionError(what)


def main():
    folder = Path(sys.argv[1])
    plan = json.loads((folder / "points.json").read_text())["points"]
    table = pd.read_parquet(folder / "results.parquet").set_index("point")
    require(len(table) == len(plan) and table["hash"].is_unique, "a row per point")
    for point in plan:
        row = table.loc[point["point"]]
        require(row["hash"] == point["hash"] and row["model"] == point["model"], "another point")
        done = json.loads((folder / "points" / point["hash"] / "done.json").read_text())
        require(row["status"] == done["status"], "another end")
        for key, value in done.get("headline", {}).items():
            if key in row and value is not None:
                require(row[key] == value, f"{key}: {row[key]} in the table, {value} of the point")
        for setting in point["set"]:
            key, _, value = setting.partition("=")
            columns = [column for column in table if column.startswith(key)]
            number = float(value.strip('"').split()[0])
            require(not columns or row[columns[0]] == number, f"{key}: {row[columns[0]]}, not {number}")
    print(f"{folder}: {len(table)} points, {len(table.columns)} columns")


main()
