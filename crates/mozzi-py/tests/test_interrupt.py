"""Ctrl-C ends long computations of one call."""

import _thread
import signal
import threading
import time

import mozzi
import numpy as np
import pytest
from mozzi.trajectories import Line

HOME = np.zeros(6)


@pytest.mark.parametrize(
    "work",
    [
        lambda: mozzi.models.panda().derive("inverse_dynamics"),
        lambda: mozzi.excite(mozzi.models.ur5(), 60.0),
        lambda: mozzi.InverseKinematics(mozzi.models.ur5()).solve(HOME, position=np.full((9999, 3), 9.0)),
        lambda: Line(mozzi.models.ur5(), HOME, HOME + 1).time_optimal(acceleration=1.0, intervals=100_000),
        lambda: mozzi.compare("ur5", states=3_000),
    ],
    ids=["derive", "excite", "inverse kinematics", "time-optimal", "compare"],
)
def test_a_long_call_is_interrupted(work):
    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    timer = threading.Timer(0.5, _thread.interrupt_main)
    start = time.monotonic()
    try:
        with pytest.raises(KeyboardInterrupt):
            timer.start()
            work()
    finally:
        timer.cancel()
        signal.signal(signal.SIGINT, before)
    assert time.monotonic() - start < 60
