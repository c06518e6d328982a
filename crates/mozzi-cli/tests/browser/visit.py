"""Opens pages and does a job in each, for the scripts of this folder."""

import json
import sys

from playwright.sync_api import sync_playwright

ARGUMENTS = ["--use-angle=swiftshader", "--enable-unsafe-swiftshader", "--no-sandbox"]
# Pixels for each CSS pixel: the processor draws a quarter of the picture, and the layout is that of any screen.
PIXELS = 0.5
# What the drawing by the processor says of itself.
NOISE = ("GPU stall", "GL Driver Message", "software WebGL")
# Every text below the scene, in order.
HINTS = """window.hints = [];
document.addEventListener("DOMContentLoaded", () => {
  const hint = document.getElementById("hint");
  if (hint) new MutationObserver(() => window.hints.push(hint.textContent)).observe(hint, { childList: true });
});"""


LEAST = """() => {
      const channel = (x) => (x <= 0.04045 ? x / 12.92 : ((x + 0.055) / 1.055) ** 2.4);
      const light = ([r, g, b]) => 0.2126 * channel(r / 255) + 0.7152 * channel(g / 255) + 0.0722 * channel(b / 255);
      const probe = document.createElement("canvas").getContext("2d", { willReadFrequently: true });
      const colour = (text) => {
        probe.clearRect(0, 0, 1, 1);
        probe.fillStyle = text;
        probe.fillRect(0, 0, 1, 1);
        return [...probe.getImageData(0, 0, 1, 1).data];
      };
      const groundOf = (one) => {
        for (; one; one = one.parentElement) {
          const own = colour(getComputedStyle(one).backgroundColor);
          if (own[3] > 200) return own;
        }
        return [255, 255, 255];
      };
      let found = [99, ""];
      for (const one of document.querySelectorAll("body *")) {
        if (!one.checkVisibility() || ![...one.childNodes].some((node) => node.nodeType === 3 && node.textContent.trim())) continue;
        if (one.closest("script, style, noscript, option, .values") || one.disabled) continue;
        const [a, b] = [light(colour(getComputedStyle(one).color)), light(groundOf(one))];
        const ratio = (Math.max(a, b) + 0.05) / (Math.min(a, b) + 0.05);
        if (ratio < found[0]) found = [ratio, one.textContent.slice(0, 40)];
      }
      return found;
    }"""


def least(page):
    """The least contrast of text with its ground."""
    return page.evaluate(LEAST)


def contrast(page):
    """The same in both themes of the pages."""
    found = [least(page)]
    page.keyboard.press("d")
    return [*found, least(page)]


def empty(browser, job):
    """A page of the job's size."""
    page = browser.new_page(viewport={"width": job["width"], "height": job["height"]}, device_scale_factor=PIXELS)
    page.set_default_timeout(300_000)  # a busy machine draws slowly
    return page


def launch(playwright):
    return playwright.chromium.launch(executable_path=sys.argv[1], args=ARGUMENTS)


def visit(browser, job, do):
    page = empty(browser, job)
    page.add_init_script(HINTS)
    found = {"errors": [], "requests": []}
    said = lambda message: any(noise in message.text for noise in NOISE) or found["errors"].append(message.text)
    page.on("console", said)
    page.on("pageerror", lambda error: found["errors"].append(str(error)))
    page.on("request", lambda request: request.url.startswith(("data:", "blob:")) or found["requests"].append(request.url))
    page.goto(job["url"])
    page.evaluate("window.mozzi ? mozzi.ready.then(() => true) : true")
    found.update(do[job["do"]](page, job))
    if job.get("looks"):
        found["contrast"] = contrast(page)
    found["wide"] = page.evaluate("document.documentElement.scrollWidth")
    page.close()
    return found


def serve(do):
    with sync_playwright() as playwright:
        browser = launch(playwright)
        print(json.dumps([visit(browser, job, do) for job in json.load(sys.stdin)]))
        browser.close()
