"""The live page in a real browser: units, up and down, what is pale meanwhile, a phone, a click on a dot."""

import contextlib

import pytest
from support import ROOT
from support.explorers import explorer

import vibro_sweep as vs

pytestmark = pytest.mark.slow
MOST = 120_000  # ms, for kernels that are to be compiled
UP, DOWN = (31, 111, 180), (225, 87, 15)  # as plotting/style.py has them
LEGEND = (0.72, 0.07)  # the part of the canvas from which, and to which, the legend is

TEXTS = """
window.texts = [];
const write = CanvasRenderingContext2D.prototype.fillText;
CanvasRenderingContext2D.prototype.fillText = function (text, ...place) {
  window.texts.push(text);
  return write.call(this, text, ...place);
};
"""
PIXELS = """([[r, g, b], [right, top]]) => {
  const canvas = document.getElementById("diagram"), { width, height } = canvas, ratio = window.devicePixelRatio;
  const { data } = canvas.getContext("2d").getImageData(0, 0, width, height), found = [];
  for (let i = 0; i < width * height; i++) {
    const x = i % width, y = Math.floor(i / width);
    if (x > right * width && y < top * height) continue;
    const away = [r, g, b].map((colour, k) => Math.abs(data[4 * i + k] - colour));
    if (Math.max(...away) < 12) found.push([x / ratio, y / ratio]);
  }
  return found;
}"""
NEAREST = """async ([x, y]) => {
  const { orbitNear } = await import("/nearest.js"), { DiagramData } = await import("/diagram_data.js");
  const data = new DiagramData({ columns: 3, starts: 3, middle: 1, record: 1 });
  data.axis = Float64Array.of(0, 1, 2);
  for (let column = 0; column < 3; column++) {
    for (let start = 0; start < 3; start++) data.dots[3 * column + start] = Float32Array.of(start + column / 10 - 1);
  }
  const dots = { x: 0, y: 0, w: 300, h: 300 }, exponents = { x: 0, y: 320, w: 300, h: 100 };
  const state = { view: { low: -0.5, high: 2.5 }, range: [0, 3], start: 0 };
  [data.K, data.exponents] = [1, Float32Array.from({ length: 9 }, (_, n) => n % 3)];
  const found = orbitNear(data, { place: { dots, exponents }, exponentRange: [0, 2] }, state, x, y);
  return [found.column, found.start];
}"""
LATE = """async () => {
  const { DiagramData } = await import("/diagram_data.js");
  const data = new DiagramData({ columns: 4, starts: 1, middle: 0, record: 1 });
  const frame = (kind, first, step, ...y) => {
    const [count, status, period] = [Uint32Array, Int8Array, Int32Array].map((Type) => new Type(y.length).fill(1));
    data.take({ kind, first, step, length: y.length, arrays: { count, status, period, y: Float32Array.from(y) } });
  };
  frame("piece", 1, 2, 10, 30);
  frame("preview", 0, 1, 1, 2, 3, 4);
  frame("piece", 0, 4, 50);
  return data.dots.map(([y]) => y);
}"""


@pytest.fixture(scope="module")
def program():
    with explorer(ROOT / "configs" / "lever" / "lever.yaml") as running:
        yield running


@contextlib.contextmanager
def opened(browser, program, prepare=lambda tab: None, **options):
    """A page with its first final picture; errors of its scripts fail the test."""
    tab, wrong = browser.new_page(**{"viewport": {"width": 1280, "height": 900}} | options), []
    tab.on("pageerror", lambda error: wrong.append(str(error)))
    tab.on("console", lambda one: wrong.append(one.text) if one.type == "error" else None)
    prepare(tab)
    tab.goto(program.address)
    settle(tab)
    yield tab
    tab.close()
    assert not wrong


def settle(tab):
    tab.wait_for_selector("html[data-state=final]", timeout=MOST)
    tab.wait_for_timeout(200)


def click(tab, x, y):
    box = tab.locator("#diagram").bounding_box()
    tab.mouse.click(box["x"] + x, box["y"] + y)


def test_units_stand_beside_numbers_and_on_axes(browser, program, tmp_path):
    """What is typed is in the unit that is shown; requests, links and scenes are in those of the system."""
    with opened(browser, program, lambda tab: tab.add_init_script(TEXTS)) as tab:
        units = dict(tab.locator(".number").evaluate_all(
            "rows => rows.map((row) => [row.querySelector('input').id, row.querySelector('.unit').textContent])"
        ))  # fmt: skip
        assert units["field-b"] == "mm" and units["field-k1"] == "N/mm" and units["field-frequency"] == "Hz"
        assert tab.input_value("#field-b") == "1.5" and tab.input_value("#field-k1") == "9.5"
        assert tab.locator(".of-axis").all_inner_texts() == ["Hz", "Hz"]
        assert {"displacement x1 [mm]", "forcing frequency f [Hz]", "λ [1/s]", "-10"} <= {*tab.evaluate("texts")}
        tab.fill("#field-b", "1.2")
        tab.press("#field-b", "Enter")
        tab.fill("#low", "6")
        tab.press("#low", "Enter")
        tab.wait_for_timeout(700)
        settle(tab)
        assert tab.input_value("#field-b") == "1.2" and '"b":0.0012' in tab.evaluate(
            "decodeURIComponent(location.hash)"
        )
        click(tab, 600, 200)
        tab.locator("#facts", has_text="Hz").wait_for(timeout=MOST)
        assert "λ [1/s]" in tab.inner_text("#facts")
        assert {"x1 [mm]", "v1 [mm/s]", "t/T"} <= {*tab.evaluate("texts")}
        tab.locator("#field-b").press("ArrowUp")
        assert float(tab.input_value("#field-b")) > 1.2
        tab.fill("#field-b", "1.2")
        tab.press("#field-b", "Enter")
        tab.click("#save summary")
        with tab.expect_download() as download:
            tab.click("#save [data-form=yaml]")
        download.value.save_as(tmp_path / "explored.yaml")
        other = program.address + tab.evaluate("location.hash")
    scene = vs.load_scene(tmp_path / "explored.yaml")
    assert scene.system.b == 0.0012 and scene.picture_units == ("mm", "Hz")
    assert scene.sweep["frequency"][[0, -1]].tolist() == [6, 25]
    with opened(browser, program) as tab:
        tab.fill("#low", "30")  # above the other end, which is moved next
        tab.press("#low", "Enter")
        tab.locator("#status", has_text="The range must rise").wait_for()
        tab.fill("#high", "40")
        tab.press("#high", "Enter")
        settle(tab)
        assert (tab.input_value("#low"), tab.input_value("#high")) == ("30", "40")
        tab.goto(other)
        tab.reload()
        settle(tab)
        assert tab.input_value("#field-b") == "1.2" and tab.input_value("#low") == "6"


def test_up_and_down_have_their_colours(browser, program):
    with opened(browser, program, lambda tab: tab.add_init_script(TEXTS)) as tab:
        assert {"up →", "← down", "both"} <= {*tab.evaluate("texts")}
        place = tab.locator("#diagram").bounding_box()
        for colour in (UP, DOWN):
            found = tab.evaluate(PIXELS, [colour, LEGEND])
            assert any(y < 0.5 * place["height"] for _, y in found), "dots"
            assert any(y > 0.7 * place["height"] for _, y in found), "exponents"
        tab.select_option("#start", "up")
        tab.wait_for_timeout(300)
        settle(tab)
        assert not tab.evaluate(PIXELS, [DOWN, LEGEND])


def test_a_preview_that_is_late_replaces_no_numbers(browser, program):
    """Workers of a page end their parts in any order."""
    with opened(browser, program) as tab:
        assert tab.evaluate(LATE) == [50, 10, 3, 30]


def test_a_click_shows_the_orbit_of_the_nearest_dot(browser, program):
    with opened(browser, program) as tab:
        for colour, way in ((UP, "up"), (DOWN, "down")):
            dots = [place for place in tab.evaluate(PIXELS, [colour, LEGEND]) if place[1] < 400]
            click(tab, *dots[len(dots) // 2])
            tab.locator("#facts b", has_text=f"Hz, {way}:").wait_for(timeout=MOST)
            tab.locator("#diagram").press("ArrowRight")  # the line moves, the start stays
            tab.wait_for_timeout(300)
            assert f"Hz, {way}:" in tab.inner_text("#facts b") and "alone" not in tab.inner_text("#facts")
        for column in range(3):
            for start in range(3):
                x, y = 100 * column + 50, 300 - 100 * (start + column / 10)
                assert tab.evaluate(NEAREST, [x, y - 20]) == [column, start]
        assert tab.evaluate(NEAREST, [102, 195]) == [1, 1] and tab.evaluate(NEAREST, [102, 200]) == [0, 1]
        assert tab.evaluate(NEAREST, [150, 321]) == [1, 2]  # of exponents


def test_the_largest_contact_force_over_the_frequency(browser, program):
    with opened(browser, program) as tab:
        tab.select_option("#height", label="largest contact force [N]")
        tab.wait_for_timeout(300)
        settle(tab)
        name = tab.get_attribute("#diagram", "aria-label")
        assert name == "largest contact force [N] over forcing frequency f from 5 to 25 Hz"
        assert tab.evaluate(PIXELS, [DOWN, LEGEND])


def test_what_is_computed_anew_is_pale(browser, program):
    """The answers of the program are kept back."""
    kept = []

    def keep(route):
        server = route.connect_to_server()
        server.on_message(lambda message: kept.append((route, message)) if kept else route.send(message))

    with opened(browser, program, lambda tab: tab.route_web_socket("**/socket*", keep)) as tab:
        click(tab, 600, 200)
        tab.wait_for_selector("#facts b")
        tab.wait_for_timeout(300)
        assert tab.locator(".stale").count() == 0
        before = len(tab.evaluate(PIXELS, [DOWN, LEGEND]))
        kept.append(None)
        tab.fill("#field-b", "1.4")
        tab.press("#field-b", "Enter")
        tab.wait_for_timeout(600)
        assert before > 20 and not tab.evaluate(PIXELS, [DOWN, LEGEND])
        assert {"status", "orbit"} <= {*tab.locator(".stale").evaluate_all("all => all.map((one) => one.id)")}
        assert float(tab.locator("#facts").evaluate("one => getComputedStyle(one).opacity")) < 0.5
        waiting, kept[:] = kept[1:], []
        for route, message in waiting:
            route.send(message)
        settle(tab)
        tab.wait_for_timeout(300)
        assert len(tab.evaluate(PIXELS, [DOWN, LEGEND])) > 20 and tab.locator(".stale").count() == 0


def test_on_a_phone_the_diagram_stays_beside_the_sliders(browser, program):
    with opened(browser, program, viewport={"width": 360, "height": 740}) as tab:
        for name in ("m1", "k_stop", "offset"):
            slider = tab.locator(f"#slider-{name}")
            slider.evaluate("one => one.scrollIntoView({ block: 'center' })")
            slider.focus()
            diagram, place = tab.locator("#diagram").bounding_box(), slider.bounding_box()
            assert diagram["y"] >= 0 and 0.35 * 740 < diagram["height"] < 0.55 * 740
            assert diagram["y"] + diagram["height"] < place["y"] < 740
        before = tab.input_value("#field-offset")
        tab.keyboard.press("ArrowRight")
        assert tab.input_value("#field-offset") != before
        settle(tab)
