"""Times mozzi's expansion of the PR2 and that of PyPI's xacro in turn.

    python speed.py BATCH FOLDER [ROUNDS]

BATCH is the example `batch` of mozzi-xacro, FOLDER the PR2 of xacro's own tests. Needs `pip install xacro==2.1.1`.
"""

import contextlib
import io
import os
import pathlib
import shutil
import statistics
import subprocess
import sys
import tempfile
import time
import types

program, source = (os.path.abspath(path) for path in sys.argv[1:3])
rounds = int(sys.argv[3]) if len(sys.argv) > 3 else 9
with tempfile.TemporaryDirectory() as home:
    shutil.copytree(source, pathlib.Path(home) / "test/robots/pr2")
    path = f"{home}/test/robots/pr2/pr2.urdf.xacro"
    # without ROS: where its index says that the package lies
    index = types.ModuleType("ament_index_python.packages")
    index.get_package_share_directory = lambda name: home
    sys.modules["ament_index_python"] = types.ModuleType("ament_index_python")
    sys.modules["ament_index_python.packages"] = index
    import xacro

    batch = subprocess.Popen([program], stdin=subprocess.PIPE, stdout=subprocess.PIPE)

    def ours():
        batch.stdin.write(f"{path}\txacro={home}\n".encode())
        batch.stdin.flush()
        verdict, length = batch.stdout.readline().split()
        assert verdict == b"ok"
        return batch.stdout.read(int(length))

    def theirs():
        with contextlib.redirect_stderr(io.StringIO()):
            return xacro.process_file(path).toprettyxml(indent="  ")

    ours(), theirs()
    times = {ours: [], theirs: []}
    for _ in range(rounds):
        for way in times:
            start = time.perf_counter()
            way()
            times[way].append(time.perf_counter() - start)
    a, b = (statistics.median(times[way]) for way in (ours, theirs))
    print(f"mozzi {a * 1e3:.1f} ms, PyPI's xacro {b * 1e3:.0f} ms: {b / a:.0f} times as fast (medians of {rounds}, in turn)")
