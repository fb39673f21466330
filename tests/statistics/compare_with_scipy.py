"""Compares the answer of a campaign with SciPy. docs/testing.md shows the commands.

Usage: compare_with_scipy.py RUN.csv ANSWER.json [VS.csv VS.json]

The second pair is from a campaign with --vs. Exits with 1 if a number differs.
"""

import csv
import json
import math
import re
import sys
from pathlib import Path

import numpy as np
from scipy import stats

wrong = 0


def compare(what, ours, theirs, tolerance=1e-9):
    global wrong
    same = math.isclose(ours, theirs, rel_tol=tolerance, abs_tol=tolerance)
    wrong += not same
    print(f"{'ok   ' if same else 'WRONG'} {what}: {ours!r} {theirs!r}")


def rows(path, side="a"):
    with open(path, newline="") as file:
        return [row for row in csv.DictReader(file) if row["side"] == side]


def numbers(rows, name):
    return np.array([float(row[name]) if row[name] else math.nan for row in rows])


def one_side(path, answer):
    flights = rows(path)
    failed = np.array([row["outcome"] == "failed" for row in flights], dtype=float)
    success = answer["success"]
    interval = stats.binomtest(success["passed"], success["judged"]).proportion_ci(0.95, method="wilson")
    compare("Wilson, low", success["low"], interval.low)
    compare("Wilson, high", success["high"], interval.high)
    for name, found in answer["distributions"].items():
        values = numbers(flights, name)
        values = values[~np.isnan(values)]
        for key, share in [("min", 0), ("p5", 5), ("median", 50), ("p95", 95), ("max", 100)]:
            compare(f"{name}, {key}", found[key], np.percentile(values, share))
        compare(f"{name}, mean", found["mean"], values.mean())
    for cause in answer["causes"]:
        name = cause["input"]
        if cause["rank_correlation"] is None or name not in flights[0]:
            continue
        values = numbers(flights, name)
        compare(f"Spearman of {name}", cause["rank_correlation"], stats.spearmanr(values, failed).statistic)
        inside = values > cause["value"] if cause["operator"] == ">" else values <= cause["value"]
        compare(f"failures with {name}", cause["failed_inside"], failed[inside].sum())
        compare(f"flights with {name}", cause["flights_inside"], inside.sum())

        def entropy(part):
            return stats.entropy([part.mean(), 1 - part.mean()], base=2)

        gain = entropy(failed) - inside.mean() * entropy(failed[inside]) - (~inside).mean() * entropy(failed[~inside])
        compare(f"information of {name}", cause["gain_bits"], gain)


def two_sides(path, answer):
    a, b = rows(path, "a"), rows(path, "b")
    versus = answer["versus"]
    passed = [np.array([row["outcome"] == "passed" for row in side]) for side in (a, b)]
    only_a, only_b = int((passed[0] & ~passed[1]).sum()), int((passed[1] & ~passed[0]).sum())
    compare("only A", versus["only_a"], only_a)
    compare("only B", versus["only_b"], only_b)
    if only_a + only_b:
        compare("McNemar", versus["significance"]["p"], stats.binomtest(only_a, only_a + only_b).pvalue)
    for name, found in versus["metrics"].items():
        difference = numbers(b, name) - numbers(a, name)
        difference = difference[~np.isnan(difference)]
        compare(f"{name}, B - A", found["difference"], np.median(difference), 1e-6)
        test = found["significance"]
        difference = difference[difference != 0]
        if test and test["test"] == "Wilcoxon":
            # The differences are rounded alike, so that ties are the same.
            theirs = stats.wilcoxon(difference, method="approx", correction=False).pvalue
            compare(f"{name}, Wilcoxon", test["p"], theirs, 1e-6)
        elif test:
            positive = int((difference > 0).sum())
            compare(f"{name}, sign test", test["p"], stats.binomtest(positive, len(difference)).pvalue)


def sobol():
    """Compares the direction numbers of the program with those of SciPy."""
    source = (Path(__file__).parents[2] / "src/design/sobol.rs").read_text()
    table = source.split("const ROWS")[1].split("];\n")[0]
    dimensions = [(int(a), [int(m) for m in ms.split(",")]) for a, ms in re.findall(r"\((\d+), &\[([\d, ]+)\]\)", table)]
    theirs = stats.qmc.Sobol(len(dimensions) + 1, scramble=False, bits=32).random_base2(10)
    for column, (coefficients, first) in enumerate(dimensions, start=1):
        degree, directions = len(first), []
        for bit in range(32):
            if bit < degree:
                directions.append(first[bit] << (31 - bit))
                continue
            number = directions[bit - degree] ^ (directions[bit - degree] >> degree)
            for term in range(1, degree):
                if coefficients >> (degree - 1 - term) & 1:
                    number ^= directions[bit - term]
            directions.append(number)
        ours = []
        for index in range(1024):
            gray, value = index ^ (index >> 1), 0
            for bit in range(32):
                if gray >> bit & 1:
                    value ^= directions[bit]
            ours.append(value / 2**32)
        compare(f"Sobol, dimension {column + 1}", float(np.abs(np.array(ours) - theirs[:, column]).max()), 0.0)


sobol()
one_side(sys.argv[1], json.loads(Path(sys.argv[2]).read_text()))
if len(sys.argv) > 4:
    two_sides(sys.argv[3], json.loads(Path(sys.argv[4]).read_text()))
print(f"{wrong} wrong")
sys.exit(wrong > 0)
