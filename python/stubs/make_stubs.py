"""Writes the stubs: make_stubs.py TEMPLATE STUBS.

A line of the template that ends with `**options: NAME` stands for one keyword for each option that
the library describes under that name.
"""

import re
import sys
from pathlib import Path

from posevote import _core

OPTIONS = {
    "surf": lambda: _core._extractor_options("surf"),
    "sift": lambda: _core._extractor_options("sift"),
    "recognize": lambda: _core._recognize_options("default"),
    "teach": _core._teach_options,
    "segment": _core._segment_options,
    "evaluate": lambda: _core._recognize_options("default")
    + [{**option, "name": "teach_" + option["name"]} for option in _core._teach_options()],
}


def keyword(option):
    """`name: type = default` of an option."""
    kind = type(option["default"]).__name__
    if option["choices"]:
        kind = "Literal[" + ", ".join(map(repr, option["choices"])) + "]"
    return f"{option['name']}: {kind} = {option['default']!r},"


def expand(line):
    found = re.fullmatch(r"(\s*)\*\*options: (\w+),?", line)
    if not found:
        return [line]
    return [found[1] + keyword(option) for option in OPTIONS[found[2]]()]


def main(template, stubs):
    lines = Path(template).read_text(encoding="utf-8").splitlines()
    text = "\n".join(new for line in lines for new in expand(line)) + "\n"
    Path(stubs).write_text(text, encoding="utf-8")


if __name__ == "__main__":
    main(*sys.argv[1:])
