"""Pages and figures of motions."""

import pickle

import mozzi
import numpy as np
import pytest


def fall(robot, steps=50):
    return robot.simulate(np.zeros(robot.nq), np.zeros(robot.n), 0.1, steps)


def test_a_motion_becomes_a_page(ur5, tmp_path):
    motion = fall(ur5)
    assert motion.model == ur5 and pickle.loads(pickle.dumps(motion)).model == ur5
    size = motion.report(tmp_path / "fall.html", shapes="ur5", title="let <go>")
    page = (tmp_path / "fall.html").read_text(encoding="utf-8")
    assert size == (51, 51, len(page.encode()))
    thinned = motion.report(tmp_path / "thinned.html", shapes="ur5", rows=10)
    assert thinned.rows == 6 and thinned.all_rows == 51 and thinned.bytes < size.bytes
    assert motion.report(tmp_path / "thinned.html", rows=None).rows == 51
    assert page.startswith("<!doctype html>") and "ur5, let &lt;go>" in page and "wrist_3_joint" in page
    ur5.report(str(tmp_path / "skeleton.html"))
    alone = (tmp_path / "skeleton.html").read_text(encoding="utf-8")
    assert '"motion":null' in alone and '"motion":null' not in page


def test_what_is_wrong_is_named(ur5, tmp_path):
    path = tmp_path / "x.html"
    with pytest.raises(ValueError, match="meshes is 'all', expected 'visual', 'collision' or 'none'"):
        ur5.report(path, meshes="all")
    with pytest.raises(ValueError, match=r"theta has shape \(51, 2\), expected \(51, 6\)"):
        ur5.report(path, fall(mozzi.models.double_pendulum()))
    with pytest.raises(ValueError, match="no_robot"):
        ur5.report(path, shapes="no_robot")
    with pytest.raises(OSError, match="nowhere"):
        ur5.report(tmp_path / "nowhere" / "x.html")
    assert not path.exists()


def test_a_motion_becomes_a_figure():
    matplotlib = pytest.importorskip("matplotlib")
    matplotlib.use("svg")
    motion = fall(mozzi.models.double_pendulum())
    figure = motion.plot()
    axes = figure.axes
    assert len(axes) == 4
    np.testing.assert_array_equal(axes[0].lines[1].get_ydata(), motion.theta[:, 1])
    np.testing.assert_array_equal(axes[3].lines[2].get_ydata(), motion.energy)
