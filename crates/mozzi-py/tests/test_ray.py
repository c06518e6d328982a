"""Ray Data over Parquet, with a worker that dies midway: every row comes out once."""

import importlib.util
import os
from pathlib import Path

import mozzi
import numpy as np
import pytest

ray = pytest.importorskip("ray", reason="Ray is not installed")
EXAMPLE = Path(__file__).parents[3] / "examples" / "17_many_machines.py"


def example():
    spec = importlib.util.spec_from_file_location("many_machines", EXAMPLE)
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def mortal(marker):
    """Inverse dynamics, by a worker that dies of its third table, once."""

    class Mortal:
        def __init__(self, robot):
            self.robot, self.tables = robot, 0

        def __call__(self, rows):
            self.tables += 1
            if self.tables == 3:
                try:
                    os.close(os.open(marker, os.O_CREAT | os.O_EXCL))
                    os._exit(1)
                except FileExistsError:
                    pass
            state = (np.stack(list(rows[name])) for name in ("theta", "dtheta", "ddtheta"))
            return {"row": rows["row"], "tau": self.robot.inverse_dynamics(*state, threads=1)}

    return Mortal


def test_every_row_once_though_a_worker_dies(tmp_path):
    robot, marker, states = mozzi.models.ur5(), tmp_path / "died", tmp_path / "states"
    states.mkdir()
    example().write_states(states, robot, 2000, 8)
    ray.init(num_cpus=2, include_dashboard=False, log_to_driver=False)
    try:
        table = ray.data.read_parquet(str(states))
        found = table.map_batches(mortal(str(marker)), fn_constructor_args=(robot,), batch_size=64, concurrency=2)
        rows = list(found.iter_rows())
        given = {row["row"]: row for row in table.iter_rows()}
    finally:
        ray.shutdown()
    assert marker.exists(), "a worker was to die"
    assert sorted(row["row"] for row in rows) == list(range(2000))
    for row in rows[::100]:
        state = given[row["row"]]
        expected = robot.inverse_dynamics(state["theta"], state["dtheta"], state["ddtheta"])
        assert np.allclose(row["tau"], expected, rtol=0, atol=1e-11)
