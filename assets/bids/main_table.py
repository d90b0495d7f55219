"""Makes main-table.tsv once more from the events, and says how far the two are apart.

Needs Python 3 and nothing else: python3 main_table.py
"""

import csv
import glob
import json
import math
import os
import sys

FOLDER = os.path.dirname(os.path.abspath(__file__))


def rows(path):
    with open(path, encoding="utf-8", newline="") as file:
        return list(csv.DictReader(file, delimiter="\t"))


def counts(row):
    """Practice, what was given up and what was not felt do not count."""
    return row["practice"] == "0" and row["aborted"] == "0" and row["valid"] != "0"


def mean(values, is_geometric):
    if is_geometric:
        return math.exp(sum(math.log(value) for value in values) / len(values))
    return sum(values) / len(values)


def main():
    with open(os.path.join(FOLDER, "main-table.json"), encoding="utf-8") as file:
        how = json.load(file)
    found = {}
    pattern = os.path.join(FOLDER, "..", "sub-*", "ses-*", "beh", "*_events.tsv")
    for path in sorted(glob.glob(pattern)):
        names = dict(part.split("-", 1) for part in os.path.basename(path).split("_")[:-1])
        for table in how["tables"]:
            if names["task"] != table["task"]:
                continue
            for row in filter(counts, rows(path)):
                row["participant_id"] = "sub-" + names["sub"]
                if row.get(table["value"], "n/a") == "n/a":
                    continue
                key = (table["task"], table["value"], row["participant_id"], row.get(table["by"], "all"))
                values, _ = found.setdefault(key, ([], table["is_geometric"]))
                values.append(float(row[table["value"]]))
    largest = 0.0
    printed = rows(os.path.join(FOLDER, "main-table.tsv"))
    print("task\tvalue\tparticipant_id\tby\tn\tmean")
    for row in printed:
        key = (row["task"], row["value"], row["participant_id"], row["by"])
        values, is_geometric = found.pop(key, ([], False))
        if len(values) != int(row["n"]):
            sys.exit(f"{key}: {len(values)} rows, {row['n']} were counted")
        again = mean(values, is_geometric)
        largest = max(largest, abs(again - float(row["mean"])) / max(1.0, abs(again)))
        print("\t".join([*key, str(len(values)), f"{again:.12g}"]))
    if found:
        sys.exit(f"{len(found)} cells are not in main-table.tsv: {sorted(found)[0]}")
    print(f"{len(printed)} cells, apart by {largest:.1e} at most", file=sys.stderr)
    if largest > 1e-9:
        sys.exit("the tables differ")


main()
