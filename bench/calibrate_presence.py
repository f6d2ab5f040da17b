#!/usr/bin/python3
"""Fits the two logistic models of src/posevote/verify/presence.cpp and checks them.

    posevote evaluate SET... --negatives SET --set verify.false_alarms_per_1000_images=1e6 --dump claims.jsonl
    bench/calibrate_presence.py claims.jsonl PICTURES

with the number of pictures that were looked at (the negatives count once for each set) prints the constants of presence.cpp, the reliability of the probability and what the dial costs.
The figures headed "left out" come from models that did not see the set they are asked about.
"""
import json
import sys

import numpy as np

NAMES = ("digits", "confidence", "coverage", "distortion", "structure", "structure_near_matches",
         "colour_difference", "visible", "rim")
RIDGE_OBJECT, RIDGE_PLACE = 1.0, 3.0


def read(path):
    """Inputs, verdicts (1: right), whether the name was right but not the place, and the set."""
    inputs, right, misplaced, sets = [], [], [], []
    for line in map(json.loads, open(path)):
        if line["verdict"] not in ("right", "false"):
            continue
        values = [line["measured"][name] for name in NAMES]
        digits, confidence, coverage, distortion, structure, near, colour, visible, rim = values
        inputs.append([np.log10(1 + max(0, digits)), np.log(confidence + 0.01), np.sqrt(coverage),
                       structure, near, colour, visible, rim,
                       distortion * (1 - coverage)])
        right.append(line["verdict"] == "right")
        misplaced.append(line.get("truth") == line["object"] and not right[-1]
                         and line["iou"] > 0.15)
        sets.append(line["set"])
    return np.array(inputs), np.array(right), np.array(misplaced), np.array(sets)


def fit(inputs, target, ridge):
    """Bias and weights of a logistic regression, by Newton's method on standardised inputs."""
    mean, deviation = inputs.mean(0), inputs.std(0) + 1e-9
    rows = np.c_[np.ones(len(inputs)), (inputs - mean) / deviation]
    penalty = ridge * np.diag([0.0] + [1.0] * inputs.shape[1])
    w = np.zeros(rows.shape[1])
    for _ in range(60):
        p = 1 / (1 + np.exp(-rows @ w))
        gradient = rows.T @ (target - p) - penalty @ w
        curvature = (rows * (p * (1 - p))[:, None]).T @ rows + penalty + 1e-9 * np.eye(len(w))
        w += np.linalg.solve(curvature, gradient)
    weights = w[1:] / deviation
    return np.r_[w[0] - weights @ mean, weights]


def fit_both(inputs, right, misplaced, rows):
    of_object, of_place = rows & (right | ~misplaced), rows & (right | misplaced)
    return (fit(inputs[of_object], right[of_object], RIDGE_OBJECT),
            fit(inputs[of_place], right[of_place], RIDGE_PLACE))


def probability(models, inputs):
    return np.prod([1 / (1 + np.exp(-(m[0] + inputs @ m[1:]))) for m in models], axis=0)


def fit_dial(left_out, right, pictures):
    """False detections per 1000 pictures at even odds, and how much faster than they the odds grow."""
    least = np.arange(0.5, 0.98, 0.01)
    false = np.array([(left_out[~right] >= p).sum() for p in least])
    log_odds, weight = np.log(least / (1 - least)), np.sqrt(false)
    usable = false > 0
    slope, log_even = np.polyfit(log_odds[usable], np.log(1000 * false[usable] / pictures), 1,
                                 w=weight[usable])
    return np.exp(log_even), -1 / slope


def main(path, pictures):
    inputs, right, misplaced, sets = read(path)
    everything = np.ones(len(right), bool)
    models = fit_both(inputs, right, misplaced, everything)
    left_out = np.zeros(len(right))
    for name in set(sets):
        others = fit_both(inputs, right, misplaced, sets != name)
        left_out[sets == name] = probability(others, inputs[sets == name])

    for name, model in zip(("kObject", "kPlace"), models):
        weights = ", ".join(f"{w:.3f}" for w in model[1:])
        print(f"constexpr Model {name}{{{model[0]:.2f}, {{{weights}}}}};")
    even, steepness = fit_dial(left_out, right, pictures)
    print(f"constexpr Dial kDial{{{even:.0f}, {steepness:.2f}}};")
    print("\nreliability, left out: probability, claims, share that is right")
    edges = (0, 0.1, 0.3, 0.5, 0.7, 0.8, 0.9, 0.95, 0.99, 1.01)
    for low, high in zip(edges, edges[1:]):
        bin_ = (left_out >= low) & (left_out < high)
        if bin_.any():
            print(f"  {left_out[bin_].mean():.3f} {bin_.sum():6d} {right[bin_].mean():.3f}")
    print("\nleast probability: right and false with all sets | left out | false per 1000 pictures")
    fitted = probability(models, inputs)
    for least in (0.3, 0.5, 0.7, 0.8, 0.9, 0.95, 0.97):
        counts = [(int((p[right] >= least).sum()), int((p[~right] >= least).sum()))
                  for p in (fitted, left_out)]
        print(f"  {least:.2f}: {counts[0]} | {counts[1]} | {1000 * counts[1][1] / pictures:.1f}")


if __name__ == "__main__":
    main(sys.argv[1], int(sys.argv[2]))
