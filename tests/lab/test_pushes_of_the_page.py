"""A push while the top spins: the run goes on from there, can be taken back and sent."""

from collections.abc import Callable

from browsing import Visit

Lab = Callable[..., Visit]

PUSHED = "() => tippetopLab.track.header.pushes?.length"
TILTS = "() => [1, 1.9, 2.5, 4].map((time) => tippetopLab.track.value('tilt', time))"


def test_a_push_goes_on_from_the_moment_that_is_shown(lab: Lab) -> None:
    visitor = lab("tab=launch&duration=6")
    page = visitor.page
    visitor.pause(2.0)
    before = visitor.ask(TILTS)
    page.get_by_text("while it spins").click()
    visitor.pause(6.0)
    page.get_by_text("go back before its end").wait_for()
    assert page.get_by_role("button", name="Do it at 6 s").is_disabled(), "and it says why"
    visitor.pause(2.0)
    page.get_by_label("Strength of the push").fill("50")
    page.get_by_role("button", name="Do it at 2 s").click()
    visitor.wait(PUSHED)
    assert visitor.ask("() => tippetopLab.player.time") >= 2.0
    assert visitor.ask("() => tippetopLab.player.playing"), "it goes on playing"
    pushed = visitor.ask(TILTS)
    assert [round(one, 6) for one in pushed[:2]] == [round(one, 6) for one in before[:2]]
    assert abs(pushed[2] - before[2]) > 1e-3
    visitor.wait("() => /is pushed at 2 s/i.test(document.querySelector('.tt-words').textContent)")

    link = visitor.ask("() => tippetopLab.link()")
    other = lab(link.partition("#")[2])
    assert other.ask(TILTS) == pushed

    page.get_by_role("button", name="Undo").click()
    visitor.wait("() => !tippetopLab.track.header.pushes")
    assert visitor.ask(TILTS) == before


def test_friction_changes_from_a_moment_on_and_pushes_are_removed(lab: Lab) -> None:
    visitor = lab("tab=launch&duration=6&push=2+0+0+10&push=9+0.001+0+-")
    page = visitor.page
    items = page.get_by_role("list", name="Pushes").get_by_role("listitem")
    assert items.count() == 2
    assert "μ = 10 s/m" in items.nth(0).inner_text()
    assert "not reached" in items.nth(1).inner_text()
    without = lab("tab=launch&duration=6").ask(TILTS)
    assert abs(visitor.ask(TILTS)[3] - without[3]) > 0.1
    for _ in range(2):
        items.nth(0).get_by_role("button", name="Remove").click()
    visitor.wait("() => !tippetopLab.track.header.pushes")
    assert visitor.ask(TILTS) == without


def test_the_table_is_lifted_while_the_top_spins(lab: Lab) -> None:
    visitor = lab("tab=launch&duration=4&units=rad/s+deg")
    page = visitor.page
    visitor.pause(1.0)
    page.get_by_text("while it spins").click()
    page.get_by_label("Slope of the table from then on").fill("0.2")
    page.get_by_role("button", name="Do it at 1 s").click()
    visitor.wait(PUSHED)
    (push,) = visitor.ask("() => tippetopLab.track.header.pushes")
    assert push["slope"] == 0.2
    assert push["impulse"] == 0, "who lifts the table does not push the top"
    visitor.wait(
        "() => /slope of 11.5° from 1 s/.test(document.querySelector('.tt-words').textContent)"
    )
    slopes = "() => [0.9, 1.1].map((time) => tippetopLab.track.table(time).slope)"
    assert visitor.ask(slopes) == [0, 0.2]
    downhill = "() => tippetopLab.track.at(4).position[0]"
    there = visitor.ask(downhill)
    # Friction that grows with slip cannot hold it: it slides down the slope of 11 degrees.
    assert there > 0.1
    # The table is drawn as it then slopes.
    turned = """(time) => {
      const { scene } = tippetopLab.player;
      scene.draw(time);
      return 2 * Math.asin(scene.eye.ground.y);
    }"""
    assert visitor.ask(turned, 0.9) == 0
    assert abs(visitor.ask(turned, 1.1) + 0.2) < 1e-9

    other = lab(visitor.ask("() => tippetopLab.link()").partition("#")[2])
    assert other.ask(downhill) == there
    page.get_by_role("button", name="Remove").click()
    visitor.wait("() => !tippetopLab.track.header.pushes")


def test_links_with_pushes_that_are_none_say_so(lab: Lab) -> None:
    visitor = lab("tab=launch&push=2+0+0&push=-1+0+0+-&push=2+NaN+0+-&push=2+0+0+-+2")
    visitor.wait("() => document.querySelector('.refused')?.textContent.includes('push')")
    assert not visitor.ask("() => tippetopLab.track.header.pushes")
