"""Ray Data over Parquet on this machine, with two workers of which one is killed: every row comes out once."""

import importlib.util
import os
import shutil
import signal
import socket
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import mozzi
import numpy as np
import pytest
from conftest import assert_close

ray = pytest.importorskip("ray", reason="Ray is not installed (pip install mozzi[ray])")
pytest.importorskip("ray.data", reason="Ray Data is not installed (pip install mozzi[ray])")
EXAMPLE = Path(__file__).parents[3] / "examples" / "ray" / "many_machines.py"
LONGEST = 60.0  # seconds that Ray may take to start on a busy machine


def free_ports(count):
    sockets = [socket.socket() for _ in range(count)]
    for each in sockets:
        each.bind(("127.0.0.1", 0))
    ports = [each.getsockname()[1] for each in sockets]
    [each.close() for each in sockets]
    return ports


@pytest.fixture(scope="module")
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
    with open(Path(folder) / "start.txt", "w+") as log:
        head = subprocess.Popen(command, stdout=log, stderr=log, stdin=subprocess.DEVNULL, start_new_session=True)
        address, why, begin = f"127.0.0.1:{ports[0]}", None, time.monotonic()
        try:
            while not ray.is_initialized():
                try:
                    ray.init(address, log_to_driver=False, logging_level="ERROR", _temp_dir=folder)
                except Exception as error:
                    why = error
                if head.poll() is not None or time.monotonic() - begin > LONGEST:
                    break
                time.sleep(0.5)
            if not ray.is_initialized():
                log.seek(0)
                pytest.skip(f"Ray does not start here: {why}; {log.read()[-400:]}")
            yield address
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
        raise TimeoutError("longer than two minutes")

    before = signal.signal(signal.SIGALRM, late)
    signal.alarm(120)
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
    """The study, slowly, beside the process that made it; each time the model comes to a process, a mark."""

    class Marked(study):
        def __init__(self, robot):
            import os
            import tempfile

            super().__init__(robot)
            self.process = os.getpid()
            os.close(tempfile.mkstemp(prefix=f"{self.process}-", dir=folder)[0])

        def __call__(self, rows):
            import time

            import numpy as np

            time.sleep(0.05)
            return {**super().__call__(rows), "process": np.full(len(rows["row"]), self.process)}

    return Marked


def test_every_row_once_though_a_worker_is_killed(cluster, example, tmp_path):
    robot, states, marks, count = mozzi.models.ur5(), tmp_path / "states", tmp_path / "marks", 2000
    states.mkdir(), marks.mkdir()
    example.write_states(states, robot, count, files=20)
    table = example.read(str(states))
    rows, killed = [], None
    for row in example.compute(table, marked(example.Study, str(marks)), robot, batch_size=32).iter_rows():
        rows.append(row)
        if killed is None:
            killed = int(row["process"])
            os.kill(killed, signal.SIGKILL)
    assert sorted(row["row"] for row in rows) == list(range(count))
    workers = [int(mark.name.split("-")[0]) for mark in marks.iterdir()]
    assert killed in workers and len(workers) == len(set(workers)) in (2, 3), "the model once for each process"
    assert {int(row["process"]) for row in rows} - {killed}, "another went on"
    given = {row["row"]: row for row in table.iter_rows()}
    for row in rows[::50]:
        theta, dtheta, ddtheta = (np.asarray(given[row["row"]][name]) for name in ("theta", "dtheta", "ddtheta"))
        assert_close(row["tau"], robot.inverse_dynamics(theta, dtheta, ddtheta))
        fall = robot.simulate(theta, dtheta, 0.5, 50, torque=lambda t, theta, dtheta: -dtheta)
        assert_close(row["later"], fall.theta[-1], tolerance=1e-9)


def test_the_example(cluster, example, monkeypatch, capsys):
    ray.shutdown()
    monkeypatch.setenv("RAY_ADDRESS", cluster)
    example.main()
    assert "4000 rows, the first: " in capsys.readouterr().out
