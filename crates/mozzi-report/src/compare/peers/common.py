"""What Pinocchio or MuJoCo make of a robot: a question as JSON on standard input, the answer on standard output.

Numbers are passed on as the library computes them; the caller compares and explains. Six-vectors are angular first.
"""

import sys

sys.path = [folder for folder in sys.path if folder]  # no file of the working folder is taken for a library

import importlib.metadata
import json
import os
import xml.etree.ElementTree as ElementTree

out = os.fdopen(os.dup(1), "w", encoding="utf-8")
os.dup2(2, 1)  # what the libraries print goes to standard error


class Refused(Exception):
    """The library does not load the file."""


def one_line(error):
    return " ".join(str(error).split()) or type(error).__name__


def attempt(load):
    try:
        return load()
    except Exception as error:
        raise Refused(one_line(error))


def numbers(vector):
    flat = vector.ravel() if hasattr(vector, "ravel") else vector  # a column, or of one number a scalar
    return [float(x) if abs(x) < float("inf") else None for x in flat]  # JSON has no word for NaN


def rows(matrix):
    return [numbers(row) for row in matrix]


def rename(joints, known):
    """The asker's names: by name, else by the same axis, else, of balls and free joints, by a like name or as the only one; else their own."""
    names = {joint["name"] for joint in joints}
    missing = [joint for joint in known if joint["name"] not in names]
    wanted = {joint["name"] for joint in known}
    for joint in joints:
        joint["called"] = joint["name"]
        if joint["name"] in wanted:
            continue
        candidates = [candidate for candidate in missing if candidate["nv"] == joint["nv"]]
        if joint["nv"] == 1:
            far = lambda candidate: max(abs(a - b) for a, b in zip(candidate["axis"], joint["axes"][0]))
            candidates = [candidate for candidate in candidates if far(candidate) < 1e-9]
        else:
            like = [candidate for candidate in candidates if candidate["name"].replace(":", "_") == joint["name"]]
            candidates = like or candidates * (len(candidates) == 1)
        if candidates:
            joint["name"] = candidates[0]["name"]
            missing.remove(candidates[0])
