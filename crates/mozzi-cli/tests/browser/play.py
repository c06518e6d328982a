"""Opens the playground and does to it what a visitor does: python play.py BROWSER < jobs.json > found.json

A job: {"do": name of a function below, "url", "width", "height", …}. Every answer has "errors" of the console, "requests" and the page's width.
"""

from visit import contrast, empty, serve

DROP = """async (texts) => {
  const transfer = new DataTransfer();
  for (const [name, text] of Object.entries(texts)) transfer.items.add(new File([text], name));
  for (const kind of ["dragenter", "dragover", "drop"])
    window.dispatchEvent(new DragEvent(kind, { dataTransfer: transfer, bubbles: true, cancelable: true }));
}"""

STATE = "() => ({ name: mozzi.app.robot.name, theta: [...mozzi.state().theta], dtheta: [...mozzi.state().dtheta], time: mozzi.state().time })"

COMPUTED = """(all) => all.map(({ request, inputs }) => {
  try {
    return mozzi.compute(request, inputs);
  } catch (error) {
    return { error: error.message };
  }
})"""

# Where a body's middle is on the screen.
POINT = """(body) => {
  const { scene, robot, shapes, skeleton, shown } = mozzi.app.stage;
  scene.drawNow();
  const frame = scene.frames[robot.bodies[body].frame];
  const at = frame.position.clone().setFromMatrixPosition(frame.matrixWorld);
  const end = robot.bodies.findIndex(({ parent }) => parent === body);
  if (end > 0) {
    const next = scene.frames[robot.bodies[end].frame];
    at.lerp(next.position.clone().setFromMatrixPosition(next.matrixWorld), 0.5);
  }
  at.project(scene.camera);
  const { left, top, width, height } = scene.renderer.domElement.getBoundingClientRect();
  return [left + ((at.x + 1) / 2) * width, top + ((1 - at.y) / 2) * height];
}"""


def numbers(page, job):
    return {"computed": page.evaluate(COMPUTED, job["requests"])}


def drop_and_play(page, job):
    """A file is dropped, play is pressed: two actions."""
    page.evaluate(DROP, job["texts"])
    page.wait_for_function("(name) => mozzi.app.robot.name === name", arg=job["name"])
    before = page.evaluate(STATE)
    page.click("#play")
    page.wait_for_function("() => mozzi.state().time > 0.2")
    page.click("#play")
    return {"before": before, "after": page.evaluate(STATE), "row": page.evaluate("() => mozzi.app.record.rows.at(-1)"), "menu": page.eval_on_selector_all("#robot option", "(all) => all.map(({ textContent }) => textContent)")}


def argument(page, job):
    """A xacro file is dropped with its include; another value of its argument, undo, a wrong value."""
    page.evaluate(DROP, job["texts"])
    page.wait_for_function("(name) => mozzi.app.robot.name === name", arg=job["name"])
    n = ["() => mozzi.app.robot.n", "() => mozzi.app.robot.n === 3"]
    found = {"n": [page.evaluate(n[0])]}
    page.click("#tab-edit")
    field = page.locator('#page-edit input[data-argument="joints"]')
    found["value"] = field.input_value()
    field.fill("3")
    field.press("Enter")
    page.wait_for_function(n[1])
    page.click("#undo")
    page.wait_for_function("() => mozzi.app.robot.n === 1")
    page.click("#redo")
    page.wait_for_function(n[1])
    field.fill("many")
    field.press("Enter")
    page.wait_for_selector("#trouble:not([hidden])")
    return found | {"said": page.inner_text("#trouble pre"), "after": page.evaluate(n[0])}


def wrong_file(page, job):
    before = page.evaluate(STATE)
    page.evaluate(DROP, job["texts"])
    page.wait_for_selector("#trouble:not([hidden])")
    said = page.inner_text("#trouble pre")
    page.keyboard.press("Escape")
    return {"before": before, "after": page.evaluate(STATE), "said": said, "hidden": page.is_hidden("#trouble")}


def drag(page, job):
    """Paused: a joint, with Shift the end effector; undo; playing: a push."""
    states = [page.evaluate(STATE)]
    x, y = page.evaluate(POINT, job["body"])
    for modifier in (None, "Shift"):
        x, y = page.evaluate(POINT, job["body"])
        if modifier:
            page.keyboard.down(modifier)
        page.mouse.move(x, y)
        page.mouse.down()
        page.mouse.move(x + 25, y + 18, steps=4)
        page.mouse.up()
        if modifier:
            page.keyboard.up(modifier)
        states.append(page.evaluate(STATE))
    page.keyboard.press("Control+z")
    page.wait_for_function("(theta) => mozzi.state().theta.every((angle, k) => angle === theta[k])", arg=states[1]["theta"])
    states.append(page.evaluate(STATE))
    page.select_option("#motors", "gravity")
    page.click("#play")
    x, y = page.evaluate(POINT, job["body"])
    page.mouse.move(x, y)
    page.mouse.down()
    page.mouse.move(x + 60, y + 10, steps=4)
    # the arrow comes with the next picture
    page.wait_for_function("() => mozzi.state().push !== null && mozzi.app.stage.push.visible")
    pushed = page.evaluate("() => ({ push: mozzi.state().push, shown: mozzi.app.stage.push.visible })")
    page.mouse.up()
    page.click("#play")
    return {"states": states, "pushed": pushed}


def share(page, job):
    """The link opens the same robot in the same state, in another page."""
    page.evaluate("(theta) => mozzi.app.setTheta(theta)", job["theta"])
    if "edit" in job:
        page.evaluate("(change) => mozzi.app.edit(change)", job["edit"])
    link = page.evaluate("() => mozzi.app.share()")
    before = page.evaluate(STATE)
    masses = "() => mozzi.compute({ quantity: 'mass_matrix' }).M"
    found = {"link": len(link), "before": before, "M": [page.evaluate(masses)]}
    other = empty(page.context.browser, job)
    other.goto(link)
    other.evaluate("mozzi.ready.then(() => true)")
    found["after"] = other.evaluate(STATE)
    found["M"].append(other.evaluate(masses))
    other.close()
    return found


def edit(page, job):
    """A mass by its field, undo, redo."""
    M = "() => mozzi.compute({ quantity: 'mass_matrix' }).M"
    found = {"M": [page.evaluate(M)]}
    page.click("#tab-edit")
    field = page.locator('#page-edit input[data-entry="mass"]')
    field.fill("7.5")
    field.press("Enter")
    page.wait_for_function("() => mozzi.app.isEdited")
    found["M"].append(page.evaluate(M))
    found["link"] = page.evaluate("() => mozzi.app.panels && document.querySelector('#page-edit select').value")
    page.click("#undo")
    page.wait_for_function("() => !mozzi.app.isEdited")
    found["M"].append(page.evaluate(M))
    page.click("#redo")
    page.wait_for_function("() => mozzi.app.isEdited")
    found["M"].append(page.evaluate(M))
    page.click("#tab-code")
    for text in ("Motion as CSV", "Robot as URDF", "Robot as JSON"):
        page.get_by_text(text).click()
        found[text] = page.evaluate("() => mozzi.app.saved.text")
    return found


def panels(page, job):
    """Every quantity opens; an entry says its joints; the lines of each language."""
    page.click("#tab-numbers")
    page.eval_on_selector_all("#page-numbers details", "(all) => all.forEach((part) => (part.open = true))")
    page.wait_for_timeout(300)
    found = {"empty": page.eval_on_selector_all("#page-numbers details", "(all) => all.filter((part) => part.querySelector('div').childElementCount < 1).map(({ dataset }) => dataset.name)")}
    cell = page.locator('[data-name="mass_matrix"] td').nth(1)
    cell.scroll_into_view_if_needed()
    cell.hover()
    found["entry"] = page.inner_text("#entry")
    found["axes"] = page.evaluate("() => mozzi.app.stage.overlays.axes.length")
    found["value"] = float(cell.get_attribute("data-value"))
    page.evaluate("(theta) => mozzi.app.setTheta(theta)", job["theta"])
    page.click("#tab-code")
    found["code"] = {}
    for language in ("python", "rust", "cpp", "shell"):
        page.select_option("#page-code select >> nth=0", language)
        page.select_option("#page-code select >> nth=1", job["quantity"])
        found["code"][language] = page.inner_text("#page-code .code")
    # of every quantity the line of the command line, with what the page shows
    page.select_option("#page-code select >> nth=0", "shell")
    found["lines"] = []
    for name in page.eval_on_selector_all("#page-code select >> nth=1 >> option", "(all) => all.map(({ value }) => value)"):
        page.select_option("#page-code select >> nth=1", name)
        request = page.evaluate("(name) => mozzi.app.quantities.request(mozzi.app.robot.quantities.find((one) => one.name === name))", name)
        shown = page.evaluate(COMPUTED, [{"request": request}])
        found["lines"].append({"name": name, "line": page.inner_text("#page-code .code"), "shown": shown[0]})
    found["expected"] = page.evaluate("(quantity) => mozzi.compute({ quantity, frame: mozzi.app.frameName })", job["quantity"])
    return found


def programs(page, job):
    """The programs of a robot that is no file of the visitor's, and the file that they open."""
    if "robot" in job:
        page.select_option("#robot", label=job["robot"])
        page.wait_for_function("(name) => mozzi.app.entry.name === name", arg=job["robot"])
    if "edit" in job:
        page.evaluate("(change) => mozzi.app.edit(change)", job["edit"])
    page.click("#tab-code")
    found = {"code": {}}
    for language in ("python", "shell"):
        page.select_option("#page-code select >> nth=0", language)
        page.select_option("#page-code select >> nth=1", job["quantity"])
        found["code"][language] = page.inner_text("#page-code .code")
    page.get_by_text("Robot as JSON").click()
    found["saved"] = page.evaluate("() => mozzi.app.saved")
    found["shown"] = page.evaluate("(quantity) => mozzi.compute({ quantity })", job["quantity"])
    page.evaluate("() => mozzi.app.stage.toggle('constraints', true)")
    found["carried"] = page.evaluate("() => mozzi.app.stage.overlays.carried.map(({ visible }) => visible)")
    return found


def fields(page, job):
    """What is typed into fields: a number, nothing, a mass below 0."""
    state = lambda: [angle.input_value(), page.evaluate("() => mozzi.state().theta[1]")]
    angle = page.locator("#page-joints input[type=number]").nth(1)
    angle.fill("")
    angle.press_sequentially("-1.25")
    found = {"typed": state()}
    angle.fill("")
    angle.blur()
    found["emptied"] = state()
    page.click("#tab-edit")
    mass = page.locator('#page-edit input[data-entry="mass"]')
    before = mass.input_value()
    mass.fill("-3")
    mass.press("Enter")
    page.wait_for_selector("#trouble:not([hidden])")
    mass.blur()
    found["refused"] = [before, mass.input_value()]
    return found


def keyboard(page, job):
    """Everything is reached by Tab; every control has a name; the tabs follow arrows; sliders move joints."""
    names = page.evaluate("""() => [...document.querySelectorAll("button, input, select, canvas, summary")]
      .filter((one) => one.checkVisibility())
      .filter((one) => !(one.getAttribute("aria-label") || one.textContent.trim() || one.title || one.labels?.length))
      .map((one) => one.outerHTML.slice(0, 120))""")
    seen = []
    page.click("#sheet")  # of a phone
    page.evaluate("document.activeElement.blur()")
    for _ in range(120):
        page.keyboard.press("Tab")
        seen.append(page.evaluate("() => document.activeElement.id || document.activeElement.dataset.kind || document.activeElement.textContent.slice(0, 20)"))
    page.keyboard.press("Escape")
    page.focus("#tab-joints")
    page.keyboard.press("ArrowRight")
    tab = page.evaluate("() => document.activeElement.id")
    page.click("#tab-joints")
    before = page.evaluate(STATE)
    page.focus("#page-joints input[type=range]")
    page.keyboard.press("ArrowRight")
    moved = page.evaluate(STATE)
    page.get_by_text("+z").click()
    nudged = page.evaluate(STATE)
    page.evaluate("document.activeElement.blur()")
    page.keyboard.press(" ")
    page.wait_for_function("() => mozzi.app.isPlaying")
    page.keyboard.press(" ")
    theme = "() => document.documentElement.dataset.theme"
    themes = [page.evaluate(theme)]
    page.keyboard.press("d")
    themes.append(page.evaluate(theme))
    page.evaluate("window.scrollTo(0, 150)")
    page.wait_for_timeout(200)
    tabs = page.evaluate("() => [document.getElementById('transport').getBoundingClientRect().bottom, document.getElementById('tabs').getBoundingClientRect().top]")
    return {"nameless": names, "seen": seen, "tab": tab, "tabs": tabs, "states": [before, moved, nudged], "themes": themes, "contrast": contrast(page)}


def stand(page, job):
    """A floating quadruped on the ground under PD control, then on pinned feet; a closed loop that swings."""
    page.click("#floating")
    page.wait_for_function("() => mozzi.app.robot.isFloating")
    page.evaluate("(legs) => mozzi.app.setTheta([...mozzi.state().theta.slice(0, 7), ...legs])", job["legs"])
    page.click("#ground")
    page.select_option("#motors", "pd")
    height = "() => mozzi.state().theta[6]"
    found = {"height": [page.evaluate(height)]}
    page.click("#play")
    page.wait_for_function("() => mozzi.state().time > 0.6")
    found["touches"] = page.evaluate("() => mozzi.state().touches.length")
    page.click("#play")
    found["height"].append(page.evaluate(height))
    page.click("#reset")
    page.click("#tab-edit")
    page.get_by_text("Pin all tips").click()
    page.wait_for_function("() => mozzi.app.robot.constraints.length === 4")
    page.click("#ground")
    page.click("#play")
    page.wait_for_function("() => mozzi.state().time > 0.3")
    page.click("#play")
    found["pinned"] = [page.evaluate(height), page.evaluate("() => Math.max(...mozzi.state().dtheta.map(Math.abs))")]
    return found


def robots(page, job):
    """Every robot of the menu opens and moves."""
    found = []
    for k in range(page.evaluate("() => mozzi.entries.length")):
        page.select_option("#robot", str(k))
        page.wait_for_function("(k) => mozzi.app.entry === mozzi.entries[k] && !mozzi.app.isPlaying", arg=k)
        page.wait_for_timeout(100)
        # away from an equilibrium
        page.evaluate("() => mozzi.app.setRates(mozzi.state().dtheta.map(() => 0.4))")
        page.click("#play")
        page.wait_for_function("() => mozzi.state().time > 0.1")
        page.click("#play")
        found.append({**page.evaluate(STATE), "trouble": page.is_visible("#trouble"), "drift": page.evaluate("() => mozzi.state().drift"),
                      "residual": page.evaluate("() => mozzi.app.robot.constraints.length ? Math.max(...mozzi.compute({ quantity: 'constraint_residual' }).phi.map(Math.abs)) : 0")})
    return {"robots": found}


def frames(page, job):
    """Pictures a second, and milliseconds of dynamics for each, while it plays."""
    page.click("#play")
    page.wait_for_timeout(6000)
    page.evaluate("() => (mozzi.app.loop.times.length = 0)")
    found = page.evaluate("""() => new Promise((done) => {
      const times = [];
      const next = (now) => {
        times.push(now);
        if (now - times[0] < 4000) return requestAnimationFrame(next);
        const own = [...mozzi.app.loop.times].sort((a, b) => a - b);
        done({ fps: (1000 * (times.length - 1)) / (now - times[0]), dynamics: own[own.length >> 1], triangles: mozzi.app.stage.scene.renderer.info.render.triangles });
      };
      requestAnimationFrame(next);
    })""")
    page.click("#play")
    return found


def picture(page, job):
    for action in job.get("actions", []):
        page.evaluate(action)
        page.wait_for_timeout(400)
    page.wait_for_timeout(job.get("wait", 300))
    page.screenshot(path=job["path"])
    return {}


DO = {f.__name__: f for f in (numbers, drop_and_play, argument, wrong_file, drag, share, edit, panels, programs, fields, keyboard, stand, robots, frames, picture)}


serve(DO)
