#!/usr/bin/python3
"""Fits the two logistic models of src/posevote/verify/presence.cpp and checks them.

    posevote evaluate SET... --negatives SET --set verify.false_alarms_per_1000_images=1e6 --dump claims.jsonl
    bench/calibrate_presence.py claims.jsonl PICTURES [--svg FILE]

with the number of pictures that were looked at (the negatives count once for each set) prints the constants of presence.cpp, the reliability of the probability and what the dial costs.
The figures headed "left out" come from models that did not see the set they are asked about.
"""
import argparse
import json

import numpy as np

NAMES = ("digits", "confidence", "coverage", "distortion", "structure", "structure_near_matches",
         "colour_difference", "visible", "rim", "found", "consensus")
RIDGE_OBJECT, RIDGE_PLACE = 1.0, 3.0

# Of each input as `read` gives them: 1 if more of it must not make a claim less probable, -1 if not
# more, 0 if it may do either (distortion, and that there is no consensus). What the data say
# otherwise is an accident of inputs that go together; such an input is left out.
SIGNS = np.array([1, 1, 1, 1, 1, -1, 1, 1, 0, 1, 1, 0])


def read(path):
    """Inputs, verdicts (1: right), whether the name was right but not the place, and the set."""
    inputs, right, misplaced, sets = [], [], [], []
    for line in map(json.loads, open(path)):
        if line["verdict"] not in ("right", "false"):
            continue
        values = [line["measured"][name] for name in NAMES]
        digits, confidence, coverage, distortion, structure, near, colour, visible, rim, found, \
            consensus = values
        inputs.append([np.log10(1 + max(0, digits)), np.log(confidence + 0.01), np.sqrt(coverage),
                       structure, near, colour, visible, rim,
                       distortion * (1 - coverage), np.sqrt(found), max(0, consensus),
                       float(consensus < 0)])
        right.append(line["verdict"] == "right")
        misplaced.append(line.get("truth") == line["object"] and not right[-1]
                         and line["iou"] > 0.15)
        sets.append(line["set"])
    return np.array(inputs), np.array(right), np.array(misplaced), np.array(sets)


def fit_freely(inputs, target, ridge):
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


def fit(inputs, target, ridge):
    """The same with the signs that SIGNS asks for; inputs that would need another weigh nothing."""
    used = np.arange(inputs.shape[1])
    while True:
        w = fit_freely(inputs[:, used], target, ridge)
        against = SIGNS[used] * w[1:] * inputs[:, used].std(0)
        if against.min() >= 0:
            break
        used = np.delete(used, against.argmin())
    result = np.zeros(inputs.shape[1] + 1)
    result[0], result[1 + used] = w[0], w[1:]
    return result


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


def reliability(probabilities, right):
    """(mean probability, claims, share that is right) of each bin that is not empty."""
    edges = (0, 0.1, 0.3, 0.5, 0.7, 0.8, 0.9, 0.95, 0.99, 1.01)
    bins = []
    for low, high in zip(edges, edges[1:]):
        bin_ = (probabilities >= low) & (probabilities < high)
        if bin_.any():
            bins.append((probabilities[bin_].mean(), int(bin_.sum()), right[bin_].mean()))
    return bins


def wilson(share, number, z=1.96):
    centre = (share + z * z / (2 * number)) / (1 + z * z / number)
    half = z * np.sqrt(share * (1 - share) / number + z * z / (4 * number**2)) / (1 + z * z / number)
    return centre - half, centre + half


def draw_reliability(bins, side=360, margin=56):
    """An SVG: what was claimed across, what was true up, with Wilson's intervals."""
    def x(value):
        return margin + side * value

    def y(value):
        return margin / 2 + side * (1 - value)

    size = side + 1.5 * margin
    parts = [
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {size:.0f} {size:.0f}" '
        'font-family="sans-serif" font-size="12">',
        f'<rect width="{size:.0f}" height="{size:.0f}" fill="white"/>']
    for tick in (0, 0.2, 0.4, 0.6, 0.8, 1):
        parts.append(f'<path d="M{x(0)} {y(tick)}H{x(1)}M{x(tick)} {y(0)}V{y(1)}" stroke="#ddd"/>')
        parts.append(f'<text x="{x(0) - 6}" y="{y(tick) + 4}" text-anchor="end">{tick:g}</text>')
        parts.append(f'<text x="{x(tick)}" y="{y(0) + 16}" text-anchor="middle">{tick:g}</text>')
    parts.append(f'<path d="M{x(0)} {y(0)}L{x(1)} {y(1)}" stroke="#888" stroke-dasharray="4 4"/>')
    for mean, number, share in bins:
        low, high = wilson(share, number)
        parts.append(f'<path d="M{x(mean):.1f} {y(low):.1f}V{y(high):.1f}" stroke="#2563a8"/>')
        parts.append(f'<circle cx="{x(mean):.1f}" cy="{y(share):.1f}" r="4" fill="#2563a8">'
                     f'<title>{number} claims</title></circle>')
    middle = x(0.5)
    parts.append(f'<text x="{middle}" y="{y(0) + 36}" text-anchor="middle">probability claimed, '
                 'by models that did not see the data set</text>')
    parts.append(f'<text transform="translate(16 {y(0.5)}) rotate(-90)" text-anchor="middle">'
                 'share that is right</text></svg>')
    return "\n".join(parts) + "\n"


def main(path, pictures, svg):
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
    bins = reliability(left_out, right)
    for mean, number, share in bins:
        print(f"  {mean:.3f} {number:6d} {share:.3f}")
    if svg:
        with open(svg, "w", encoding="utf-8") as file:
            file.write(draw_reliability(bins))
    print("\nleast probability: right and false with all sets | left out | false per 1000 pictures")
    fitted = probability(models, inputs)
    for least in (0.3, 0.5, 0.7, 0.8, 0.9, 0.95, 0.97):
        counts = [(int((p[right] >= least).sum()), int((p[~right] >= least).sum()))
                  for p in (fitted, left_out)]
        print(f"  {least:.2f}: {counts[0]} | {counts[1]} | {1000 * counts[1][1] / pictures:.1f}")


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("claims")
    parser.add_argument("pictures", type=int)
    parser.add_argument("--svg")
    given = parser.parse_args()
    main(given.claims, given.pictures, given.svg)
