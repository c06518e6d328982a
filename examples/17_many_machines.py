"""Dynamics and Monte-Carlo simulation over a table of states on many machines, by Ray Data: `pip install mozzi[ray]`.

The model goes to each worker once; each row of the Parquet files comes out once, whatever happens to a worker. Here on this machine, with
two workers; on a cluster `ray.init("auto")` and a path that all machines see is all the difference.
"""

import tempfile
from pathlib import Path
from typing import Any

import mozzi
import numpy as np
import pyarrow
import pyarrow.parquet
from numpy.typing import NDArray

Table = dict[str, NDArray[Any]]


class Dynamics:
    """τ of each row's state."""

    def __init__(self, robot: mozzi.Model) -> None:
        self.robot = robot

    def __call__(self, rows: Table) -> Table:
        state = (np.stack(list(rows[name])) for name in ("theta", "dtheta", "ddtheta"))
        return {"row": rows["row"], "tau": self.robot.inverse_dynamics(*state, threads=1)}


class Falls:
    """Where the robot is after half a second without torques, from each row's state."""

    def __init__(self, robot: mozzi.Model) -> None:
        self.robot = robot

    def __call__(self, rows: Table) -> Table:
        motions = [
            self.robot.simulate(theta, dtheta, 0.5, 50, record_every=50)
            for theta, dtheta in zip(rows["theta"], rows["dtheta"])
        ]
        return {"row": rows["row"], "theta": np.array([motion.theta[-1] for motion in motions])}


def write_states(folder: Path, robot: mozzi.Model, count: int, files: int) -> None:
    """Random states, as Parquet."""
    random, rows = np.random.default_rng(1), np.arange(count)
    for part, some in enumerate(np.array_split(rows, files)):
        columns = {name: list(random.uniform(-1, 1, (len(some), robot.n))) for name in ("theta", "dtheta", "ddtheta")}
        pyarrow.parquet.write_table(pyarrow.table({"row": some, **columns}), folder / f"states{part}.parquet")


def main() -> None:
    import ray

    ray.init(num_cpus=2, include_dashboard=False, log_to_driver=False)
    arm = mozzi.models.two_link_planar()
    with tempfile.TemporaryDirectory() as folder:
        write_states(Path(folder), arm, 4000, 8)
        states = ray.data.read_parquet(folder)
        for quantity in (Dynamics, Falls):
            # the class is made once in each worker, with the model, which pickles
            found = states.map_batches(quantity, fn_constructor_args=(arm,), batch_size=256, concurrency=2)
            rows = sorted(row["row"] for row in found.iter_rows())
            print(f"{quantity.__name__}: {len(rows)} rows")
            assert rows == list(range(4000))
    ray.shutdown()


if __name__ == "__main__":
    main()
