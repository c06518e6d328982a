"""Looks at pages as a teacher does: python looks.py BROWSER < jobs.json > found.json

A job: {"do": name of a function below, "url", "width", "height", …}; with "looks" also the least contrast in light and dark.
"""

from visit import empty, least, serve

DROP = "(texts) => mozzi.openTexts(texts)"

SHOWN = """() => {
  const { stage, robot } = mozzi.app;
  const seen = (list) => list.filter((part) => part.visible).length;
  return {
    name: robot.name, shapes: seen(stage.shapes), bones: seen(stage.skeleton),
    lit: [...document.querySelectorAll("#toggles [aria-pressed=true]")].map(({ dataset }) => dataset.kind),
    buttons: [...document.querySelectorAll("#toggles [data-kind]")].map(({ dataset }) => dataset.kind),
    hint: document.getElementById("hint").innerText, about: document.getElementById("about").innerText,
  };
}"""

# A point of the scene at which a body's shapes or bones are drawn.
ON = """(body) => {
  const { stage } = mozzi.app;
  const { scene, robot } = stage;
  scene.drawNow();
  const at = scene.frames[robot.bodies[body].frame].position.clone().setFromMatrixPosition(scene.frames[robot.bodies[body].frame].matrixWorld).project(scene.camera);
  const { left, top, width, height } = scene.renderer.domElement.getBoundingClientRect();
  return [left + ((at.x + 1) / 2) * width, top + ((1 - at.y) / 2) * height];
}"""


def first(page, job):
    """Every robot of the menu as it is first shown."""
    found = []
    for k in range(page.evaluate("() => mozzi.entries.length")):
        page.select_option("#robot", str(k))
        page.wait_for_function("(k) => mozzi.app.entry === mozzi.entries[k]", arg=k)
        found.append(page.evaluate(SHOWN))
    return {"robots": found, "first": page.evaluate("() => mozzi.app.firstPicture")}


def missing(page, job):
    """A robot whose meshes are not there, then the folder that has them; the joint under the pointer."""
    page.evaluate(DROP, job["texts"])
    found = {"without": page.evaluate(SHOWN), "offered": page.is_visible("#missing")}
    x, y = page.evaluate(ON, 2)
    page.mouse.move(x, y)
    page.wait_for_selector("#tag:not([hidden])")
    found["tag"] = page.inner_text("#tag")
    found["axes"] = page.evaluate("() => mozzi.app.stage.overlays.axes.length")
    page.mouse.move(x, 3)
    page.wait_for_selector("#tag[hidden]", state="attached")
    page.set_input_files("#folders", job["folder"])
    page.wait_for_function("() => mozzi.app.stage.missing === 0 && mozzi.app.stage.waiting === 0")
    return found | {"with": page.evaluate(SHOWN), "after": page.is_visible("#missing")}


def kept(page, job):
    return page.evaluate(SHOWN)


def loads(page, job):
    """When the first picture was drawn, and what was said about meshes meanwhile."""
    return {"first": page.evaluate("() => mozzi.firstPicture"), "hints": page.evaluate("() => hints")}


def forces(page, job):
    """A quadruped on the ground: which layers there are, which way forces point, the floor."""
    found = {"before": page.evaluate(SHOWN)}
    settings(page)
    page.click("#floating")
    page.wait_for_function("() => mozzi.app.robot.isFloating")
    page.click("#ground")
    page.select_option("#motors", "pd")
    page.evaluate("document.activeElement.blur()")
    page.keyboard.press("Escape")
    page.click("#play")
    page.wait_for_function("() => mozzi.state().time > 0.3 && mozzi.state().touches.length > 2")
    page.click("#play")
    found["after"] = page.evaluate(SHOWN)
    # each arrow's direction as it is drawn, and the force of the simulation: the robot's on the ground
    arrows = """() => mozzi.app.stage.touches.filter(({ visible }) => visible).map((arrow) => {
      arrow.updateMatrixWorld(true);
      const { elements } = arrow.head.matrixWorld;
      return elements[10] / Math.hypot(elements[8], elements[9], elements[10]);
    })"""
    found["up"] = page.evaluate(arrows)
    found["applied"] = page.evaluate("() => mozzi.state().touches.map(({ f }) => f[2])")
    press(page, "applied")
    found["down"] = page.evaluate(arrows)
    found["scales"] = page.inner_text("#scales")
    found["metres"] = page.evaluate("() => mozzi.app.stage.lengthOf([1])")
    found["groups"] = page.eval_on_selector_all("#toggles .group > span", "(all) => all.map(({ textContent }) => textContent)")
    # pixels of the scene's picture: sky at the top, floor at the bottom
    found["pixels"] = page.evaluate("""() => {
      const { scene } = mozzi.app.stage;
      scene.camera.position.z = scene.controls.target.z + 0.1;
      scene.controls.update();
      scene.drawNow();
      const { domElement } = scene.renderer;
      const copy = Object.assign(document.createElement("canvas"), { width: domElement.width, height: domElement.height });
      const draw = copy.getContext("2d", { willReadFrequently: true });
      draw.drawImage(domElement, 0, 0);
      return [3, copy.height - 3].map((y) => draw.getImageData(5, y, 1, 1).data[3]);
    }""")
    return found


def settings(page):
    """On a phone motors and ground are in a sheet."""
    if not page.is_visible("#settings"):
        page.click("#sheet")


def press(page, kind):
    page.evaluate("(kind) => mozzi.app.stage.buttons[kind].click()", kind)


def ellipsoids(page, job):
    """An arm stretched out, whose Jacobian is singular: no ellipsoid is longer than the robot."""
    page.evaluate("(theta) => mozzi.app.setTheta(theta)", job["theta"])
    for kind in ("manipulability", "torque", "inertia", "twists"):
        press(page, kind)
    page.evaluate("(rates) => mozzi.app.setRates(rates)", [0.5] * len(job["theta"]))
    return {
        "reach": page.evaluate("() => mozzi.app.stage.reach"),
        "axes": page.evaluate("() => ['manipulability', 'forceEllipsoid'].flatMap((one) => mozzi.app.stage.overlays[one].scale.toArray())"),
        "sigma": page.evaluate("() => mozzi.app.stage.overlays.singularValues(mozzi.state().theta).map(({ sigma }) => sigma)"),
        "scales": page.inner_text("#scales"),
        "buttons": page.evaluate(SHOWN)["buttons"],
    }


def controls(page, job):
    """The row of controls, the stiffness of the motors, the search, units, the help."""
    found = {"about": page.inner_text("#about"), "stiffness": []}
    found["sheet"] = [page.is_visible("#settings")]
    for motors in ("off", "gravity", "pd"):
        settings(page)
        page.select_option("#motors", motors)
        found["stiffness"].append(page.inner_text("#stiffness").replace("\n", " ") if page.is_visible("#stiffness") else "")
    page.focus("#omega")
    page.keyboard.press("ArrowRight")
    found["stiffness"].append(page.inner_text("#stiffness").replace("\n", " "))
    found["sheet"].append(page.is_visible("#settings"))
    page.evaluate("document.activeElement.blur()")
    page.keyboard.press("Escape")
    found["sheet"].append(page.is_visible("#settings"))
    # middles of all that stands in the row
    found["row"] = page.eval_on_selector_all("#transport > *, #settings > *", """(all) => all.filter((one) => one.checkVisibility() && one.id !== "settings").map((one) => {
      const { top, bottom } = one.getBoundingClientRect();
      return (top + bottom) / 2;
    })""")
    found["nudges"] = page.inner_text(".nudges")
    page.click("#tab-numbers")
    shown = "() => [...document.querySelectorAll('#page-numbers details')].filter((one) => !one.hidden && one.dataset.name).map(({ dataset }) => dataset.name)"
    for word in ("torque", "zebra"):
        page.fill("#page-numbers input", word)
        found[word] = page.evaluate(shown)
        found[word + " said"] = page.inner_text("#page-numbers .note") if page.is_visible("#page-numbers .note") else ""
    page.fill("#page-numbers input", "")
    page.eval_on_selector_all("#page-numbers details", "(all) => all.forEach((one) => (one.open = true))")
    page.wait_for_function("() => document.querySelector('[data-name=body_jacobian] caption')")
    of = lambda name, what: page.eval_on_selector_all(f"[data-name={name}] {what}", "(all) => all.map(({ textContent }) => textContent)")
    found["units"] = {name: of(name, "caption") for name in ("mass_matrix", "gravity_forces", "body_jacobian", "momentum")}
    found["rows"] = of("body_jacobian", "th")
    page.evaluate("scrollTo(0, 500)")
    found["stage"] = page.evaluate("() => { const { top, bottom } = document.getElementById('stage').getBoundingClientRect(); return [top, bottom]; }")
    page.evaluate("scrollTo(0, 0)")
    page.click("#help")
    found["help"] = page.evaluate("() => [document.getElementById('about-page').scrollTop, document.querySelector('#about-page h2').getBoundingClientRect().top - document.getElementById('about-page').getBoundingClientRect().top]")
    page.keyboard.press("Escape")
    return found


def plots(page, job):
    """What every plot of a motion shows: ticks, cut spikes, curves on one another, colours."""
    found = {"plots": page.evaluate("""() => mozzi.plots.map(({ figure, ticks, cut, merged, curves }) => ({
      title: figure.querySelector("b").textContent, unit: figure.querySelector("small").textContent, ticks, cut,
      on: merged.map(({ on }) => on), colours: curves.map(({ colour }) => colour),
    }))""")}
    ink = """(k) => {
      const { canvas } = mozzi.plots[k];
      const copy = Object.assign(document.createElement("canvas"), { width: canvas.width, height: canvas.height });
      const draw = copy.getContext("2d", { willReadFrequently: true });
      draw.drawImage(canvas, 0, 0);
      return draw.getImageData(0, 0, copy.width, copy.height).data.reduce((sum, x) => sum + x, 0);
    }"""
    before = page.evaluate(ink, 0)
    page.evaluate("document.querySelector('.patterns').click()")
    return found | {"patterned": before != page.evaluate(ink, 0)}


def lesson(page, job):
    """Every question wrong, then right; the ellipse at another pose; a link with the answers."""
    found = {"tab": page.inner_text("#tabs [aria-selected=true]"), "title": page.inner_text("#page-lesson h2"), "said": []}
    found["robot"] = page.evaluate("() => mozzi.app.robot.name")
    parts = page.evaluate("() => mozzi.app.lesson.lesson.parts")
    found["answers"] = [page.evaluate("(answer) => mozzi.app.lesson.expected(answer)", part["answer"]) for part in parts if "ask" in part]
    before = page.evaluate("() => [...mozzi.state().theta]")
    boxes = page.query_selector_all(".question")
    questions = [part for part in parts if "ask" in part or "choose" in part]
    numbers = iter(found["answers"])
    for box, part in zip(boxes, questions):
        said = []
        if "ask" in part:
            right = next(numbers)
            for answer in (1.3 * right + 1, right):
                box.query_selector("input").fill(f"{answer:.6g}")
                box.query_selector("button").click()
                said.append(box.query_selector("p").inner_text())
        else:
            for k in ((part["right"] + 1) % len(part["options"]), part["right"]):
                box.query_selector_all("input")[k].check()
                said.append(box.query_selector("p").inner_text())
        found["said"].append(said)
    found["score"] = page.inner_text("#page-lesson > .note")
    found["stays"] = before == page.evaluate("() => [...mozzi.state().theta]")
    if job.get("theta"):
        page.evaluate("(theta) => mozzi.app.setTheta(theta)", job["theta"])
        found["ellipse"] = page.evaluate("() => mozzi.app.lesson.ellipses[0].ellipse")
        found["caption"] = page.inner_text("#page-lesson .torque figcaption")
        link = page.evaluate("() => mozzi.app.share()")
        other = empty(page.context.browser, job)
        other.goto(link)
        other.evaluate("mozzi.ready.then(() => true)")
        found["linked"] = [other.inner_text("#page-lesson > .note"), other.evaluate("() => [...mozzi.state().theta]")]
        other.close()
    return found


def fit(page, job):
    """The report of an identification: its order, its colours in light and dark, its figures, its pages on paper."""
    found = {"headings": page.eval_on_selector_all("h2", "(all) => all.map(({ textContent }) => textContent)")}
    found["answer"] = page.inner_text(".answer")
    found["first"] = page.evaluate("() => document.querySelector('main').firstElementChild.className")
    found["open"] = page.eval_on_selector_all("details", "(all) => all.filter(({ open }) => open).length")
    found["folded"] = page.eval_on_selector_all("details table", "(all) => all.length")
    found["dots"] = page.evaluate("() => document.querySelectorAll('.forces svg g circle').length")
    found["bars"] = page.evaluate("() => document.querySelectorAll('rect[fill=\"var(--c0)\"]').length")
    ground = "() => [getComputedStyle(document.body).backgroundColor, getComputedStyle(document.querySelector('.forces svg > rect')).fill, getComputedStyle(document.querySelector('.forces svg text')).fill]"
    found["grounds"], found["contrast"] = [], []
    for scheme in ("light", "dark"):
        page.emulate_media(color_scheme=scheme)
        found["grounds"].append(page.evaluate(ground))
        found["contrast"].append(least(page))
    found["paper"] = page.evaluate("() => 0")
    paper = page.pdf(format="A4")
    found["paper"] = paper.count(b"/Type /Page") - paper.count(b"/Type /Pages")
    page.emulate_media(media="print")
    found["printed"] = page.eval_on_selector_all("h2", "(all) => all.filter((one) => one.checkVisibility()).map(({ textContent }) => textContent)")
    page.emulate_media(media="screen")
    return found


serve({f.__name__: f for f in (first, missing, kept, loads, forces, ellipsoids, controls, plots, fit, lesson)})
