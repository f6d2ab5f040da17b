#!/usr/bin/python3
"""What each mechanism brings: the same data sets with one mechanism changed in turn.

    bench/ablation.py PROGRAM SET... [--negatives SET] [--limit N]

PROGRAM is the posevote executable. Prints a table in Markdown: right answers and false ones, over
all sets and set by set, and the median time of a picture of the largest set.
"""
import argparse
import json
import subprocess
import sys

MECHANISMS = (
    ("the default", ()),
    ("the paper's preset", ("--preset", "paper")),
    ("no rating by the whole object's look", ("--set", "verify.false_alarms_per_1000_images=1e6")),
    ("every feature taught", ("--set", "teach.only_repeatable=false")),
    ("no features seen from above", ("--set", "teach.foreshortened=false")),
    ("one neighbour of each feature", ("--set", "match.neighbors=2")),
    ("a stricter ratio (0.8)", ("--set", "match.max_ratio=0.8")),
    ("the paper's grid of votes", ("--set", "vote.grid=image")),
    ("similarities only", ("--set", "verify.pose.stretch_prior=1e-6",
                           "--set", "verify.pose.perspective_prior=1e-6")),
    ("scene's rivals not asked", ("--set", "verify.evidence.rivals=1000")),
    ("2000 features", ("--set", "feature.max_features=2000")),
    ("SIFT features", ("--set", "feature.kind=sift")),
)


def run(program, arguments):
    text = subprocess.run([program, "evaluate", *arguments, "--json"], check=True,
                          stdout=subprocess.PIPE, text=True).stdout
    return [json.loads(line) for line in text.splitlines()]


def false_of(result):
    return result["all"]["false_positives"]


def negative_false_of(result):
    return (result.get("negatives") or {}).get("false_positives", 0)


def row(name, results):
    right = sum(result["all"]["right"] for result in results)
    false = sum(map(false_of, results))
    negative = sum(map(negative_false_of, results))
    largest = max(results, key=lambda result: result["all"]["images"])
    each = " | ".join(f"{r['all']['right']}, {false_of(r)}" for r in results)
    milliseconds = largest["all"]["time_ms"]["total"]["median"]
    return f"| {name} | **{right}** | **{false}** | {negative} | {each} | {milliseconds:.0f} |"


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("program")
    parser.add_argument("sets", nargs="+")
    parser.add_argument("--negatives")
    parser.add_argument("--limit", type=int, default=0)
    options = parser.parse_args()
    common = [*options.sets, "--limit", str(options.limit)]
    if options.negatives:
        common += ["--negatives", options.negatives]
    for number, (name, arguments) in enumerate(MECHANISMS):
        results = run(options.program, [*common, *arguments])
        if number == 0:
            names = " | ".join(result["dataset"] for result in results)
            print(f"| | right | false | on negatives | {names} | ms |")
            print("|---|" + "---:|" * (4 + len(results)))
        print(row(name, results), flush=True)


if __name__ == "__main__":
    sys.exit(main())
