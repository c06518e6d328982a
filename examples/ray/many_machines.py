"""Dynamics and Monte-Carlo simulation over a table of states, by Ray Data: `pip install mozzi[ray]`, then `python many_machines.py`.

The states lie in Parquet files. Each worker is given the model once, when it starts, and then batches of rows; a worker that dies is replaced, and
its batch computed again, so that each row is in the result once. Without a cluster Ray uses this machine; on a cluster set RAY_ADDRESS, and
put the files where all machines see them.
"""

import os
import tempfile
from pathlib import Path
from typing import Any

import mozzi
import numpy as np
import pyarrow
import pyarrow.parquet
import ray
from numpy.typing import NDArray

Rows = dict[str, NDArray[Any]]
WORKERS = 2


def table(rows: Rows, name: str) -> NDArray[Any]:
    """A column of vectors as an array (rows, n)."""
    return np.stack(list(rows[name]))


class Study:
    """Of each row's state: τ, and where the robot is half a second later if its motors only brake."""

    def __init__(self, robot: mozzi.Model) -> None:
        self.robot = robot

    def __call__(self, rows: Rows) -> Rows:
        theta, dtheta, ddtheta = (table(rows, name) for name in ("theta", "dtheta", "ddtheta"))
        tau = self.robot.inverse_dynamics(theta, dtheta, ddtheta, threads=1)
        falls: mozzi.Trajectories = self.robot.simulate(
            theta, dtheta, 0.5, 50, torque=lambda t, theta, dtheta: -dtheta, record_every=50, threads=1
        )
        return {**rows, "tau": tau, "later": falls.theta[:, -1]}


def write_states(folder: Path, robot: mozzi.Model, count: int, files: int) -> None:
    """Random states, as Parquet."""
    random = np.random.default_rng(1)
    for part, some in enumerate(np.array_split(np.arange(count), files)):
        columns = {name: list(random.uniform(-1, 1, (len(some), robot.n))) for name in ("theta", "dtheta", "ddtheta")}
        pyarrow.parquet.write_table(pyarrow.table({"row": some, **columns}), folder / f"states{part}.parquet")


def main() -> list[dict[str, Any]]:
    # without a cluster this machine: one core reads the files, the others compute
    local: dict[str, Any] = {} if "RAY_ADDRESS" in os.environ else {"num_cpus": WORKERS + 1, "include_dashboard": False}
    ray.init(log_to_driver=False, **local)
    robot, count = mozzi.models.two_link_planar(), 2000
    with tempfile.TemporaryDirectory() as folder:
        write_states(Path(folder), robot, count, files=16)
        states = ray.data.read_parquet(folder, override_num_blocks=8 * WORKERS)  # pieces enough for all workers
        workers = ray.data.ActorPoolStrategy(size=WORKERS)
        found = states.map_batches(Study, fn_constructor_args=(robot,), batch_size=64, compute=workers)
        rows = sorted(found.take_all(), key=lambda row: row["row"])
    ray.shutdown()
    assert [row["row"] for row in rows] == list(range(count))
    print(f"{count} rows, the first: {rows[0]}")
    return rows


if __name__ == "__main__":
    main()
