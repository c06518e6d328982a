#!/usr/bin/env python3
"""The words of MuJoCo's XML schema, a line for each element: its path, then its attributes.

    python oracles/make_schema.py > oracles/mjcf_schema.txt

A test of mozzi-urdf goes through them: each is computed, refused, or listed as ignored.
"""

import mujoco


def main():
    print(f"# MuJoCo {mujoco.__version__}: python oracles/make_schema.py")
    path, lines = [], []
    for line in mujoco.mj_printSchema(False, True).splitlines():
        if not line.strip():
            continue
        depth = (len(line) - len(line.lstrip())) // 3
        words = line.split()
        if depth > 9:  # attributes go on
            lines[-1][1].extend(words)
            continue
        # the first column is the element and how often it may stand, the rest are attributes
        path = path[:depth] + [words[0].replace("(world)", "")]
        lines.append(("/".join(path), words[2:]))
    for name, attributes in lines:
        print(" ".join([name, *sorted(attributes)]))


if __name__ == "__main__":
    main()
