"""A log of the comparison, filtered for every program in the same way."""

import numpy as np
from scipy.signal import butter, sosfiltfilt


def filtered(file: str, cutoff: float):
    """t, θ, θ̇, θ̈, τ at even times, without the ends of the filter."""
    rows = np.loadtxt(file, delimiter=",", skiprows=1)
    keep = np.concatenate([[True], np.any(rows[1:, 1:] != rows[:-1, 1:], axis=1)])
    rows = rows[keep]
    step = np.median(np.diff(rows[:, 0]))
    t = np.arange(rows[0, 0], rows[-1, 0], step)
    columns = np.column_stack([np.interp(t, rows[:, 0], column) for column in rows[:, 1:].T])
    columns = sosfiltfilt(butter(4, cutoff, fs=1 / step, output="sos"), columns, axis=0)
    n = columns.shape[1] // 3
    q, dq, tau = columns[:, :n], columns[:, n : 2 * n], columns[:, 2 * n :]
    trim = int(np.ceil(2 / (cutoff * step)))
    cut = slice(trim, len(t) - trim)
    return t[cut] - t[cut][0], q[cut], dq[cut], np.gradient(dq, step, axis=0)[cut], tau[cut]
