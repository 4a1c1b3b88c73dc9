"""Opens reports in headless Chromium, from disk, and fails where one is not what it should be.

usage: check_reports.py CHROMIUM SCREENSHOTS REPORT...

A report asks nothing of any network and leaves no error in the console; its figures have a size and
something drawn in them; pointing at a value shows it; it turns dark where the reader wants that, and
prints; its figures and tables can be downloaded. On a telephone and on a desk, in light and dark, axe finds
no barrier, nothing is wider than the window, and no text is smaller than 11 pixels. A picture of each is left
in the folder SCREENSHOTS, to be looked at.
"""

import sys
from pathlib import Path

from axe_playwright_python.sync_playwright import Axe
from playwright.sync_api import sync_playwright

# A figure without curves still has a frame, ticks and labels: fewer shapes than these are none. A path that moves
# without drawing is several, such as the grains of a bed.
FEWEST_SHAPES = 12

# A figure of nothing but rectangles has bars on its background: a single one compares nothing.
FEWEST_BARS = 2

# Widths of a telephone and of a desk (px).
WIDTHS = [420, 1400]

# Text that is drawn smaller than 11 pixels, in figures that are scaled too; a hundredth is for rounding.
SMALL = """() => [...document.querySelectorAll("body *")].filter((element) => {
  const own = [...element.childNodes].some((node) => node.nodeType === 3 && node.textContent.trim());
  const { width, height } = element.getBoundingClientRect();
  const drawn = element.getScreenCTM?.(), scale = drawn ? Math.hypot(drawn.a, drawn.b) : 1;
  return own && width && height && scale * parseFloat(getComputedStyle(element).fontSize) < 10.99;
}).map((element) => element.textContent.trim())"""

FIGURES = """() => [...document.querySelectorAll("figure svg")].map((svg) => {
  const box = svg.getBoundingClientRect();
  const shapes = [...svg.querySelectorAll("path, polyline, polygon, line, rect, circle")]
    .filter((shape) => !shape.closest(".hover"));
  const broken = shapes.filter((shape) => [...shape.attributes].some((a) => /NaN|inf/i.test(a.value)));
  const moves = (shape) => (shape.getAttribute("d") || "m").match(/m/gi).length;
  const drawn = shapes.reduce((sum, shape) => sum + moves(shape), 0);
  const bars = shapes.every((shape) => shape.tagName === "rect") ? shapes.length - 1 : 0;
  return { width: box.width, height: box.height, shapes: drawn, bars, broken: broken.length };
})"""


# The greatest speed of the velocity field in the frames of a view, as the player says it, and that of the body (m/s).
FIELD = """([look]) => {
  const part = (name) => document.querySelector("#player [name=" + name + "]");
  const set = (name, key, value, event) => { part(name)[key] = value; part(name).dispatchEvent(new Event(event)); };
  set("look", "selectedIndex", look, "change");
  set("flow", "checked", true, "change");
  const speeds = [];
  for (let frame = 0; frame <= Number(part("time").max); frame++) {
    set("time", "value", frame, "input");
    speeds.push(Number(/move at up to ([0-9.]+) m/.exec(document.querySelector("#player output").textContent)?.[1]));
  }
  set("flow", "checked", false, "change");
  const { speed } = JSON.parse(document.getElementById("scenes").textContent);
  return { grains: Math.max(...speeds), body: Math.max(...speed) };
}"""


def require(condition, what):
    if not condition:
        raise AssertionError(what)


def check(browser, report):
    faults, requests = [], []
    page = browser.new_page(viewport={"width": 1100, "height": 900}, color_scheme="light")
    page.on("console", lambda m: faults.append(m.text) if m.type in ("error", "warning") else None)
    page.on("pageerror", lambda error: faults.append(str(error)))
    page.on("request", lambda request: requests.append(request.url))
    page.goto(report.resolve().as_uri())
    require(page.locator("h1").inner_text().strip(), "no title")

    figures = page.evaluate(FIGURES)
    require(figures, "no figure")
    for number, figure in enumerate(figures, 1):
        require(figure["width"] > 200 and figure["height"] > 100, f"figure {number} has no size: {figure}")
        is_drawn = figure["shapes"] >= FEWEST_SHAPES or figure["bars"] >= FEWEST_BARS
        require(is_drawn, f"figure {number} is empty: {figure}")
        require(figure["broken"] == 0, f"figure {number} has numbers that are none: {figure}")
    width = page.evaluate("document.documentElement.scrollWidth")
    require(width <= 1100, f"the page is {width} pixels wide and the window 1100")

    said = [text.strip() for text in page.locator("figure .hover title").all_text_contents()]
    require(said and all(said), "nothing says its value")
    mark = page.locator("figure .hover > *").nth(len(said) // 2)
    mark.scroll_into_view_if_needed()
    box = mark.bounding_box()
    # Marks may lie over each other: then the uppermost speaks.
    page.mouse.move(box["x"] + box["width"] / 2, box["y"] + box["height"] / 2)
    tip = page.locator("#tip")
    require(tip.is_visible() and tip.inner_text().strip() in said, "the tip says no value")
    page.mouse.move(2, 2)
    require(tip.is_hidden(), "the tip stays")

    for view in range(page.locator("#player [name=look] option").count()):
        greatest = page.evaluate(FIELD, [view])
        # Next to the body, grains move about as fast as it does.
        share = greatest["grains"] / greatest["body"]
        require(0.02 < share < 2, f"view {view}: a velocity field of grains and a body of {greatest}")

    background = "getComputedStyle(document.body).backgroundColor"
    light = page.evaluate(background)
    page.emulate_media(color_scheme="dark")
    require(page.evaluate(background) != light, "it does not turn dark")
    page.emulate_media(media="print", color_scheme="dark")
    require(page.evaluate(background) == "rgb(255, 255, 255)", "paper is not white")
    require(len(page.pdf()) > 10_000, "nothing is printed")

    require(not faults, f"console: {faults}")
    require(requests == [report.resolve().as_uri()], f"it asked for {requests[1:]}")
    page.close()
    return len(figures), len(said)


def look(browser, report, width, scheme, screenshots):
    page = browser.new_page(viewport={"width": width, "height": 900}, color_scheme=scheme)
    page.goto(report.resolve().as_uri())
    where = f"at {width} pixels, {scheme}"
    wide = page.evaluate("document.documentElement.scrollWidth")
    require(wide <= width, f"{where}: the page is {wide} pixels wide")
    small = page.evaluate(SMALL)
    require(not small, f"{where}: too small to read: {small[:3]}")
    found = Axe().run(page).response["violations"]
    barriers = [f"{one['id']}: {one['nodes'][0]['html'][:120]}" for one in found]
    require(not barriers, f"{where}: {barriers}")
    page.screenshot(path=str(screenshots / f"{report.parent.name}-{width}-{scheme}.png"), full_page=True)
    page.close()


def download(browser, report):
    """Figures and tables come as files of what they are called."""
    page = browser.new_page()
    page.goto(report.resolve().as_uri())
    begins = {"Figure as SVG": b"<svg", "as PNG": b"\x89PNG", "Table as CSV": b""}
    for name, magic in begins.items():
        button = page.get_by_role("button", name=name).first
        if name == "Table as CSV" and not button.count():
            continue
        with page.expect_download() as waited:
            button.click()
        content = Path(waited.value.path()).read_bytes()
        require(content.startswith(magic) and len(content) > 20, f"{name}: no such file")
        if name == "as PNG":
            width = int.from_bytes(content[16:20], "big")
            drawn = page.evaluate("document.querySelector('figure svg').viewBox.baseVal.width")
            require(width == round(3 * drawn), f"{name}: {width} pixels of {drawn}")
            require(len(content) > 2_000, f"{name}: nothing is drawn")
    page.close()


def main():
    chromium, screenshots, *reports = sys.argv[1:]
    screenshots = Path(screenshots)
    screenshots.mkdir(parents=True, exist_ok=True)
    with sync_playwright() as playwright:
        # Without a sandbox of its own: a container gives it none, and it opens nothing but our pages.
        browser = playwright.chromium.launch(executable_path=chromium, args=["--no-sandbox", "--disable-gpu"])
        for report in map(Path, reports):
            try:
                figures, values = check(browser, report)
                download(browser, report)
                for width in WIDTHS:
                    for scheme in ["light", "dark"]:
                        look(browser, report, width, scheme, screenshots)
            except AssertionError as fault:
                sys.exit(f"{report}: {fault}")
            print(f"{report}: {figures} figures, {values} values")
        browser.close()


main()
