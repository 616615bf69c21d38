"""The live page in a real browser: it follows a slider, zooms and comes back, shows orbits and why a window ends."""

import io

import numpy as np
import pytest
from PIL import Image
from support import ROOT
from support.explorers import explorer

import vibro_sweep as vs

pytestmark = pytest.mark.slow
MOST = 120_000  # ms, for kernels that are to be compiled
FEW = 40  # pixels: dots on the border between two are drawn in either


@pytest.fixture(scope="module")
def program():
    with explorer(ROOT / "configs" / "quickstart.yaml") as running:
        yield running


@pytest.fixture
def page(browser, program):
    """A page with its first final picture; errors of its scripts fail the test."""
    tab, wrong = browser.new_page(viewport={"width": 1280, "height": 900}), []
    tab.on("pageerror", lambda error: wrong.append(str(error)))
    tab.on("console", lambda one: wrong.append(one.text) if one.type == "error" else None)
    tab.goto(program.address)
    settle(tab)
    yield tab
    tab.close()
    assert not wrong


def settle(tab):
    tab.wait_for_selector("html[data-state=final]", timeout=MOST)


def colours(tab):
    """The pixels of the diagram."""
    return np.array(Image.open(io.BytesIO(tab.locator("#diagram").screenshot())).convert("RGB"))


def unlike(one, other):
    """How many pixels of two diagrams differ."""
    return int((one != other).any(-1).sum())


def click(tab, across, down=0.5):
    """Click into the diagram at parts of its width and height."""
    box = tab.locator("#diagram").bounding_box()
    tab.mouse.click(box["x"] + across * box["width"], box["y"] + down * box["height"])


def test_the_diagram_follows_a_number_and_comes_back(page):
    before, frame = colours(page), int(page.get_attribute("html", "data-frame"))
    old = page.input_value("#field-R")
    page.fill("#field-R", "0.6")
    page.press("#field-R", "Enter")
    page.wait_for_timeout(200)
    settle(page)
    assert int(page.get_attribute("html", "data-frame")) > frame
    changed = colours(page)
    assert unlike(changed, before) > FEW
    page.fill("#field-R", old)
    page.press("#field-R", "Enter")
    page.wait_for_timeout(200)
    settle(page)
    page.mouse.move(0, 0)
    assert unlike(colours(page), before) <= FEW


def test_zoom_and_back(page):
    page.mouse.move(0, 0)
    before = colours(page)
    box = page.locator("#diagram").bounding_box()
    page.mouse.move(box["x"] + 0.55 * box["width"], box["y"] + 0.1 * box["height"])
    page.mouse.down()
    page.mouse.move(box["x"] + 0.75 * box["width"], box["y"] + 0.4 * box["height"], steps=5)
    page.mouse.up()
    page.wait_for_timeout(200)
    settle(page)
    low, high = float(page.input_value("#low")), float(page.input_value("#high"))
    assert 4.2 < low < high < 7
    page.click("#back")
    page.wait_for_timeout(200)
    settle(page)
    page.mouse.move(0, 0)
    assert (page.input_value("#low"), page.input_value("#high")) == ("4.2", "7")
    page.wait_for_timeout(200)
    assert unlike(colours(page), before) <= FEW


def test_turning_the_wheel_is_one_step_back(page):
    box = page.locator("#diagram").bounding_box()
    page.mouse.move(box["x"] + 0.5 * box["width"], box["y"] + 0.3 * box["height"])
    for _ in range(4):
        page.mouse.wheel(0, -200)
    page.wait_for_timeout(200)
    settle(page)
    assert float(page.input_value("#high")) - float(page.input_value("#low")) < 2
    page.click("#back")
    assert (page.input_value("#low"), page.input_value("#high")) == ("4.2", "7")


def test_home_is_the_first_range_after_another_was_typed(page):
    page.fill("#low", "5.5")
    page.press("#low", "Enter")
    page.wait_for_timeout(200)
    settle(page)
    assert page.get_attribute("#diagram", "aria-label") == "displacement x1 over clearance b from 5.5 to 7"
    page.click("#home")
    assert (page.input_value("#low"), page.input_value("#high")) == ("4.2", "7")


def test_an_orbit_and_why_its_window_ends(page):
    click(page, 0.5, 0.3)  # near b = 5.5, in the window of period 8
    page.wait_for_selector("#orbit:not([hidden])", timeout=MOST)
    page.locator("#facts", has_text="period 8").wait_for(timeout=MOST)
    page.click("#why")
    system = vs.load_scene(ROOT / "configs" / "quickstart.yaml").system.replace(b=5.5)
    settled = vs.simulate(system, (0, 0, 0, 0), 2000).section[-1]
    branch = vs.continue_orbit(vs.periodic_orbit(system, settled, periods=8), "b", (5.3, 6))
    for special in (branch.begins, branch.ends):
        assert special.type == "graze"
        page.locator("#window", has_text=f"{special.parameters['b']:.8f}"[:9]).wait_for(timeout=MOST)


def test_the_address_holds_the_view(page, browser, program):
    page.fill("#field-omega", "0.7")
    page.press("#field-omega", "Enter")
    page.wait_for_timeout(200)
    settle(page)
    page.mouse.move(0, 0)
    page.wait_for_timeout(600)  # the address is changed after a pause
    other = browser.new_page(viewport={"width": 1280, "height": 900})
    other.goto(program.address + page.evaluate("location.hash"))
    settle(other)
    other.wait_for_timeout(300)
    assert other.input_value("#field-omega") == "0.7"
    assert unlike(colours(other), colours(page)) <= FEW
    page.locator("#status", has_text="Another tab or window shows this page now. Reload this one").wait_for()
    page.reload()
    settle(page)
    other.locator("#status", has_text="Another tab").wait_for()
    other.close()


def test_a_number_of_a_list(page, tmp_path):
    page.select_option("#presets", "chain")
    page.locator("#field-m2").wait_for()
    page.wait_for_timeout(200)
    settle(page)
    before = colours(page)
    page.fill("#field-m2", "1.3")
    page.press("#field-m2", "Enter")
    page.wait_for_timeout(200)
    settle(page)
    assert unlike(colours(page), before) > FEW and page.locator("#status.bad").count() == 0
    page.click("#save summary")
    with page.expect_download() as download:
        page.click("#save [data-form=yaml]")
    download.value.save_as(tmp_path / "explored.yaml")
    assert vs.load_scene(tmp_path / "explored.yaml").system.m == (1, 1.3, 1)


def test_shift_and_drag_moves_the_view(page):
    box = page.locator("#diagram").bounding_box()
    page.keyboard.down("Shift")
    page.mouse.move(box["x"] + 0.5 * box["width"], box["y"] + 0.3 * box["height"])
    page.mouse.down()
    page.mouse.move(box["x"] + 0.7 * box["width"], box["y"] + 0.3 * box["height"], steps=5)
    page.mouse.up()
    page.keyboard.up("Shift")
    settle(page)
    low, high = float(page.input_value("#low")), float(page.input_value("#high"))
    assert low < 3.9 and high - low == pytest.approx(2.8)
    page.click("#back")
    assert (page.input_value("#low"), page.input_value("#high")) == ("4.2", "7")


def test_a_scene_and_a_picture_are_saved(page, tmp_path):
    for form, name in (("yaml", "explored.yaml"), ("png", "explored.png")):
        page.click("#save summary")
        with page.expect_download() as download:
            page.click(f"#save [data-form={form}]")
        download.value.save_as(tmp_path / name)
    assert vs.load_scene(tmp_path / "explored.yaml").sweep["b"][[0, -1]].tolist() == [4.2, 7]
    assert (tmp_path / "explored.png").read_bytes()[:4] == b"\x89PNG"


@pytest.mark.parametrize("scheme", ["light", "dark"])
def test_a_phone(browser, program, scheme):
    context = browser.new_context(viewport={"width": 360, "height": 740}, color_scheme=scheme)
    tab = context.new_page()
    tab.goto(program.address)
    settle(tab)
    assert tab.evaluate("document.documentElement.scrollWidth <= document.documentElement.clientWidth")
    assert np.ptp(np.frombuffer(colours(tab), np.uint8)) > 100
    context.close()


def test_what_lies_under_the_pointer_and_a_number_that_follows_another(page):
    """The pointer tells value and period; asked to, it shows the orbit. An emptied field follows its leader again."""
    click(page, 0.5)
    page.wait_for_selector("#facts b")
    box = page.locator("#diagram").bounding_box()
    page.mouse.move(box["x"] + 0.97 * box["width"], box["y"] + 0.3 * box["height"])
    page.locator("#under", has_text="period 1").wait_for()
    page.locator("#trail").click()
    page.mouse.move(box["x"] + 0.96 * box["width"], box["y"] + 0.3 * box["height"])
    page.locator("#facts", has_text="no impacts").wait_for()
    left = page.locator("#field-R_left")
    for text, value in (("0.5", "0.5"), ("", "0.7")):
        page.locator("#field-R").fill("0.7")
        page.locator("#field-R").press("Enter")
        left.fill(text)
        left.press("Enter")
        assert left.input_value() == value
    settle(page)


@pytest.mark.parametrize("width", [1280, 360])
def test_the_names_of_numbers_are_whole(page, width):
    page.set_viewport_size({"width": width, "height": 900})
    cut = page.locator(".number .name").evaluate_all(
        "all => all.filter(one => one.scrollWidth > one.clientWidth).length"
    )
    assert page.locator(".number .name").count() == 10 and cut == 0


def test_arrows_in_a_field_are_steps_of_its_slider(page):
    page.press("#field-R", "ArrowUp")
    assert 0.8 < float(page.input_value("#field-R")) < 0.81
    settle(page)


def test_another_swept_number_begins_where_the_orbit_is(page):
    click(page, 0.5)
    page.wait_for_selector("#facts b")
    value = page.inner_text("#facts b").split("=")[1].strip(" :")
    page.select_option("#axis", "omega")
    assert page.input_value("#field-b") == value and page.input_value("#low") == "0.441"
    page.wait_for_timeout(200)
    settle(page)


def test_a_mapping(page):
    """It has points, and no motion between them."""
    page.select_option("#dynamics", "map")
    page.wait_for_timeout(500)
    settle(page)
    click(page, 0.5)
    page.locator("#section").wait_for(timeout=MOST)
    assert not page.locator("#history").is_visible()
    page.click("#why")
    page.locator("#window", has_text="this is its mapping").wait_for(timeout=MOST)


def test_contacts_with_a_compliant_stop(page):
    page.select_option("#presets", "one_sided_elastic")
    page.locator("#field-k_stop").wait_for()
    page.wait_for_timeout(200)
    settle(page)
    click(page, 0.5)  # near omega = 0.9
    page.locator("#facts", has_text="period 2; 1 contact;").wait_for(timeout=MOST)
    page.locator("figcaption", has_text="thick where a stop is pressed").wait_for()
    page.click("#why")
    page.locator("#window", has_text="upper end 0.915055848514").wait_for(timeout=MOST)


def test_the_masses_go_on_moving_after_another_example(page):
    click(page, 0.5)
    page.wait_for_selector("#facts b")
    page.click("#play")
    page.select_option("#presets", "hysteresis")
    page.wait_for_timeout(500)
    settle(page)
    click(page, 0.97, 0.1)
    page.wait_for_selector("#facts b")
    before = page.locator("#masses").screenshot()
    page.wait_for_timeout(400)
    assert page.inner_text("#play") == "Pause" and page.locator("#masses").screenshot() != before
