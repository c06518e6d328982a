"""Pages in a notebook: a frame that holds a whole page."""

import html.parser
import json
import re

import mozzi
import pytest


class Frames(html.parser.HTMLParser):
    def __init__(self, text):
        super().__init__()
        self.frames = []
        self.feed(text)

    def handle_starttag(self, tag, attributes):
        assert tag == "iframe"
        self.frames.append(dict(attributes))


def page(shown):
    """The page in the only frame of a notebook's cell."""
    [frame] = Frames(shown._repr_html_()).frames
    assert "allow-scripts" in frame["sandbox"] and "allow-same-origin" not in frame["sandbox"]
    assert frame["title"]
    text = frame["srcdoc"]
    assert text.lstrip().lower().startswith("<!doctype html>") and text.rstrip().endswith("</html>")
    assert "default-src 'none'" in text
    return text


@pytest.fixture(scope="module")
def motion():
    return mozzi.models.double_pendulum().simulate([1.2, 0.4], [0, 0], 0.5, 50)


def test_a_motion_shows_itself(motion, tmp_path):
    text = page(motion)
    assert text == motion.page().text
    motion.page().save(tmp_path / "swing.html")
    assert (tmp_path / "swing.html").read_text(encoding="utf-8") == text
    motion.model.report(tmp_path / "report.html", motion)
    assert (tmp_path / "report.html").read_text(encoding="utf-8") == text
    assert "MB" in repr(motion.page())


def test_a_model_plays(tmp_path):
    ur5 = mozzi.models.ur5()
    shown = ur5.play()
    text = page(shown)
    data = json.loads(re.search(r'<script[^>]*type="application/json"[^>]*>(.*?)</script>', text, re.S)[1])
    names = [robot["name"] for robot in data["robots"]]
    assert {"ur5", "panda", "anymal"} <= set(names) and names[data["first"]] == "ur5"
    # another robot than the embedded one comes first, as it is
    heavier = ur5.with_payload("tool0", 2.0)
    data = json.loads(re.search(r'<script[^>]*type="application/json"[^>]*>(.*?)</script>', page(heavier.play()), re.S)[1])
    assert data["first"] == 0 and len(data["robots"]) == len(names) + 1
    shown.save(tmp_path / "play.html")
    assert (tmp_path / "play.html").stat().st_size > 1e6
