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


def test_a_full_disk_leaves_the_older_page(ur5, tmp_path):
    resource = pytest.importorskip("resource")
    signal = pytest.importorskip("signal")
    path = tmp_path / "old.html"
    path.write_text("older")
    limits, handler = resource.getrlimit(resource.RLIMIT_FSIZE), signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
    resource.setrlimit(resource.RLIMIT_FSIZE, (8192, limits[1]))
    try:
        with pytest.raises(OSError, match="old.html"):
            ur5.report(path)
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, limits)
        signal.signal(signal.SIGXFSZ, handler)
    assert path.read_text() == "older" and list(tmp_path.iterdir()) == [path]


def test_meshes_beside_the_robots_folder_need_a_root(ur5, tmp_path):
    for folder in ("urdf", "stls"):
        (tmp_path / folder).mkdir()
    robot = tmp_path / "urdf" / "a.urdf"
    robot.write_text('<robot name="a"><link name="b"><visual><geometry><mesh filename="../stls/b.stl"/></geometry></visual></link></robot>')
    (tmp_path / "stls" / "b.stl").write_text(
        "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\nendsolid a\n"
    )
    page = tmp_path / "a.html"
    with pytest.warns(mozzi.LoadWarning, match="outside of the robot's folder"):
        ur5.report(page, shapes=robot)
    without = page.read_text(encoding="utf-8")
    ur5.report(page, shapes=robot, mesh_root=tmp_path)
    assert '"format":"stl"' not in without and '"format":"stl"' in page.read_text(encoding="utf-8")
    with pytest.raises(ValueError, match="mesh_root is .*, expected a folder"):
        ur5.report(page, shapes=robot, mesh_root=tmp_path / "none")


def test_what_is_wrong_is_named(ur5, tmp_path):
    path = tmp_path / "x.html"
    with pytest.raises(ValueError, match="meshes is 'all', expected 'visual', 'collision' or 'none'"):
        ur5.report(path, meshes="all")
    with pytest.raises(ValueError, match=r"theta has shape \(51, 2\), expected \(51, 6\)"):
        ur5.report(path, fall(mozzi.models.double_pendulum()))
    for argument, needs in [
        ({"title": "falls"}, "trajectory"),
        ({"rows": 10}, "trajectory"),
        ({"meshes": "none"}, "shapes"),
        ({"mesh_root": tmp_path}, "shapes"),
    ]:
        name = next(iter(argument))
        with pytest.raises(ValueError, match=f"{name} is given without {needs}: it would have no effect"):
            ur5.report(path, **argument)
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
