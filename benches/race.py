"""Times of calls that take turns."""

import time

import jax


def race(runners, rounds=15, seconds=0.01):
    """The least seconds of one call of each, in rounds of calls that take this many seconds."""
    calls = []
    for run in runners:
        jax.block_until_ready(run())
        start = time.perf_counter()
        jax.block_until_ready(run())
        calls.append(max(1, int(seconds / (time.perf_counter() - start))))
    least = [float("inf")] * len(runners)
    for _ in range(rounds):
        for k, (run, count) in enumerate(zip(runners, calls)):
            start = time.perf_counter()
            for _ in range(count):
                found = run()
            jax.block_until_ready(found)
            least[k] = min(least[k], (time.perf_counter() - start) / count)
    return least
