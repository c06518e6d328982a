"""Opens pages in a browser and does to them what a visitor does: python look.py BROWSER < jobs.json > found.json

A job: {"url", "width", "height", "times": [s, ...] or "theta": [[...], ...], "frames": [name, ...]}, with "tip": an end effector's name or none,
and "requests": [{"request", "inputs"}, ...] or none: quantities, computed after the states.
"""

import json
import sys

from playwright.sync_api import sync_playwright
from visit import empty, launch

STATE = """(frames) => ({
  theta: mozzi.state().theta,
  dtheta: mozzi.state().dtheta,
  ddtheta: mozzi.state().ddtheta,
  poses: frames.map(mozzi.framePose),
  M: mozzi.massMatrix(),
  vectors: mozzi.vectors(),
  center: mozzi.centerOfMass(),
  tip: mozzi.overlays.frame.name,
  semiAxes: mozzi.semiAxes(),
  contacts: mozzi.contacts(),
  planes: mozzi.planes(),
  hint: document.getElementById("hint").textContent,
  clock: document.getElementById("clock").textContent,
})"""

COMPUTED = """(all) => all.map(({ request, inputs }) => {
  try {
    return mozzi.compute(request, inputs);
  } catch (error) {
    return { error: error.message };
  }
})"""

PAINTED = """() => {
  const scene = document.querySelector("#scene canvas");
  const small = Object.assign(document.createElement("canvas"), { width: 64, height: 64 });
  small.getContext("2d").drawImage(scene, 0, 0, 64, 64);
  const { data } = small.getContext("2d").getImageData(0, 0, 64, 64);
  return data.filter((_, k) => k % 4 === 3 && data[k] > 200).length;
}"""


def look(browser, job):
    page = empty(browser, job)
    found = {"errors": [], "requests": [], "states": []}
    page.on("console", lambda said: said.type == "error" and found["errors"].append(said.text))
    page.on("pageerror", lambda error: found["errors"].append(str(error)))
    page.on("request", lambda request: request.url.startswith("data:") or found["requests"].append(request.url))
    page.goto(job["url"])
    page.evaluate("mozzi.ready.then(() => true)")
    if "tip" in job:
        page.select_option("#panel select", label=job["tip"])
    if job.get("applied"):
        page.evaluate("mozzi.show('applied', true)")
    for time in job.get("times", []):
        page.evaluate("(time) => mozzi.seek(time)", time)
        found["states"].append(page.evaluate(STATE, job["frames"]))
    for theta in job.get("theta", []):
        page.evaluate("(theta) => mozzi.setTheta(theta)", theta)
        found["states"].append(page.evaluate(STATE, job["frames"]))
    found["computed"] = page.evaluate(COMPUTED, job.get("requests", []))
    pressed = "(button) => button.getAttribute('aria-pressed')"
    found["toggles"] = {}
    for button in page.query_selector_all("#toggles button"):
        states = [button.evaluate(pressed)]
        for _ in range(2):
            button.dispatch_event("click")
            states.append(button.evaluate(pressed))
        found["toggles"][button.get_attribute("data-kind")] = states
    dark = "() => document.documentElement.dataset.theme"
    found["themes"] = [page.evaluate(dark)]
    page.keyboard.press("d")
    found["themes"].append(page.evaluate(dark))
    page.evaluate("mozzi.show('axes', true)")
    for _ in range(600):  # a busy machine paints late
        found["painted"] = page.evaluate(PAINTED)
        if found["painted"] > 5:
            break
        page.wait_for_timeout(100)
    # what of the scene the picture of M covers, in pixels
    found["covered"] = page.evaluate("""() => {
      window.mozzi.show("mass", true);
      const [a, b] = ["matrix", "scene"].map((id) => document.getElementById(id).getBoundingClientRect());
      const shared = (from, to) => Math.max(Math.min(a[to], b[to]) - Math.max(a[from], b[from]), 0);
      return a.width * a.height > 0 ? shared("left", "right") * shared("top", "bottom") : -1;
    }""")
    found["width"] = page.evaluate("document.documentElement.scrollWidth")
    if job.get("times"):
        found["scrubbed"] = scrub(page)
    else:
        theta = "() => [...mozzi.state().theta]"
        sliders = page.query_selector_all("#panel input[type=range]")
        found["sliders"] = len(sliders)
        before = page.evaluate(theta)
        for slider in sliders:
            slider.focus()
            page.keyboard.press("ArrowRight")
        found["slid"] = [before, page.evaluate(theta)]
        page.get_by_text("a random pose").dispatch_event("click")
        found["random"] = [found["slid"][1], page.evaluate(theta)]
    page.close()
    return found


def scrub(page):
    """The time after: start, the slider's middle, a row on, slow play and pause, a click on a plot's right end."""
    time = "() => Number(document.getElementById('time').value)"
    page.evaluate("mozzi.seek(0)")
    times = [page.evaluate(time)]
    box = page.query_selector("#time").bounding_box()
    page.mouse.click(box["x"] + box["width"] / 2, box["y"] + box["height"] / 2)
    times.append(page.evaluate(time))
    page.evaluate("document.activeElement.blur()")
    page.keyboard.press("Shift+ArrowRight")
    times.append(page.evaluate(time))
    for _ in range(4):
        page.keyboard.press("-")
    page.keyboard.press(" ")
    page.wait_for_function("(before) => Number(document.getElementById('time').value) > before + 0.001", arg=times[-1])
    page.keyboard.press(" ")
    times.append(page.evaluate(time))
    plot = page.query_selector(".plot canvas")
    plot.scroll_into_view_if_needed()
    box = plot.bounding_box()
    page.mouse.click(box["x"] + box["width"] - 9, box["y"] + 30)
    times.append(page.evaluate(time))
    return times


with sync_playwright() as playwright:
    browser = launch(playwright)
    print(json.dumps([look(browser, job) for job in json.load(sys.stdin)]))
    browser.close()
