"""Ray Data over Parquet on this machine, with two workers of which one is killed: every row comes out once."""

import importlib.util
import os
import random
import shutil
import signal
import socket
import subprocess
import sys
import tempfile
import threading
import time
from pathlib import Path

import mozzi
import numpy as np
import pytest
from conftest import assert_close

ray = pytest.importorskip("ray", reason="Ray is not installed (pip install mozzi[ray])")
pytest.importorskip("ray.data", reason="Ray Data is not installed (pip install mozzi[ray])")
EXAMPLE = Path(__file__).parents[3] / "examples" / "ray" / "many_machines.py"
LONGEST = 90.0  # seconds that Ray may take to start on a busy machine


def free_ports(count):
    """Below those that the system gives out by itself, so that nothing takes one before Ray does."""
    found = []
    for port in random.sample(range(20_000, 30_000), 200):
        with socket.socket() as each:
            if each.connect_ex(("127.0.0.1", port)) != 0:
                found.append(port)
        if len(found) == count:
            return found
    pytest.skip("no free ports here")


@pytest.fixture
def cluster():
    """A Ray of its own. Its ports are given: where it has to find some, it gives its agent 15 seconds to start, which a busy machine takes."""
    names = ["port", "metrics-export-port", "dashboard-agent-grpc-port", "dashboard-agent-listen-port", "runtime-env-agent-port"]
    ports = free_ports(len(names))
    folder = tempfile.mkdtemp(prefix="ray")  # short: sockets lie in it, whose paths may have a hundred letters
    environment = {
        "RAY_AUTH_MODE": "disabled",
        "RAY_USAGE_STATS_ENABLED": "0",
        "RAY_agent_register_timeout_ms": "120000",
        "RAY_worker_register_timeout_seconds": "120",
        "RAY_GRACEFUL_SHUTDOWN_DRAIN_TIMEOUT_S": "1",
    }
    os.environ.update(environment)
    command = [sys.executable, "-c", "import sys, ray.scripts.scripts as s; sys.exit(s.main())", "start", "--head", "--block"]
    command += ["--num-cpus=3", "--object-store-memory=100000000", "--include-dashboard=false", f"--temp-dir={folder}"]
    command += ["--node-ip-address=127.0.0.1", "--disable-usage-stats"]
    command += [f"--{name}={port}" for name, port in zip(names, ports)]
    with open(Path(folder) / "start.txt", "w") as log:
        head = subprocess.Popen(command, stdout=log, stderr=log, stdin=subprocess.DEVNULL, start_new_session=True)
        begin, said = time.monotonic(), ""
        try:
            while "Ray runtime started" not in said:
                if head.poll() is not None or time.monotonic() - begin > LONGEST:
                    pytest.skip(f"Ray does not start here: {said[-400:]}")
                time.sleep(0.2)
                said = (Path(folder) / "start.txt").read_text()
            yield f"127.0.0.1:{ports[0]}"
        finally:
            ray.shutdown()
            head.terminate()
            try:
                head.wait(20)
            except subprocess.TimeoutExpired:
                os.killpg(head.pid, signal.SIGKILL)
                head.wait()
            [os.environ.pop(name) for name in environment]
            shutil.rmtree(folder, ignore_errors=True)


@pytest.fixture(autouse=True)
def not_forever():
    """A test that hangs fails."""

    def late(*_):
        raise TimeoutError("longer than Ray may take on a busy machine")

    before = signal.signal(signal.SIGALRM, late)
    signal.alarm(900)
    yield
    signal.alarm(0)
    signal.signal(signal.SIGALRM, before)


@pytest.fixture
def example():
    spec = importlib.util.spec_from_file_location("many_machines", EXAMPLE)
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    for each in (module.Study, module.table):
        each.__module__ = "__main__"  # workers get it by value, as when the example is run
    return module


def marked(study, folder):
    """The study, slowly, beside the process that made it. It leaves marks: when the model comes to a process, and of each batch."""

    class Marked(study):
        def __init__(self, robot):
            super().__init__(robot)
            self.mark("model")

        def mark(self, what):
            import os
            import tempfile

            self.process = os.getpid()
            os.close(tempfile.mkstemp(prefix=f"{what} {self.process} ", dir=folder)[0])

        def __call__(self, rows):
            import time

            import numpy as np

            time.sleep(0.05)
            self.mark("batch")
            return {**super().__call__(rows), "process": np.full(len(rows["row"]), self.process)}

    return Marked


def processes(marks, what):
    """Of each mark of this kind the process that left it."""
    return [int(mark.name.split()[1]) for mark in marks.iterdir() if mark.name.startswith(what)]


def kill_one_midway(marks, killed):
    """The first worker that begins its third batch. Without one it ends after fifteen minutes."""
    end = time.monotonic() + 900
    while not killed and time.monotonic() < end:
        batches = processes(marks, "batch")
        killed += [process for process in set(batches) if batches.count(process) >= 3][:1]
        time.sleep(0.01)
    [os.kill(process, signal.SIGKILL) for process in killed]


def test_every_row_once_though_a_worker_is_killed(cluster, example, tmp_path, monkeypatch):
    monkeypatch.setenv("RAY_ADDRESS", cluster)
    monkeypatch.setattr(example, "Study", marked(example.Study, str(tmp_path)))
    robot, killed = mozzi.models.two_link_planar(), []
    killer = threading.Thread(target=kill_one_midway, args=(tmp_path, killed), daemon=True)
    killer.start()
    rows = example.main()
    killer.join(10)
    assert [row["row"] for row in rows] == list(range(2000))
    given_models = processes(tmp_path, "model")
    assert killed[0] in given_models and len(given_models) == len(set(given_models)), "the model once for each process"
    assert {int(row["process"]) for row in rows} - set(killed), "another went on"
    for row in rows[::50]:
        theta, dtheta, ddtheta = (np.asarray(row[name]) for name in ("theta", "dtheta", "ddtheta"))
        assert_close(row["tau"], robot.inverse_dynamics(theta, dtheta, ddtheta))
        fall = robot.simulate(theta, dtheta, 0.5, 50, torque=lambda t, theta, dtheta: -dtheta)
        assert_close(row["later"], fall.theta[-1], tolerance=1e-9)
