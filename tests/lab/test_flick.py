"""A flick has the spin of the hand, however slowly pictures come."""

import pytest

from bundled import found_in_the_page

# The hand rests for half a second, goes 8 pixels in each 10 ms, and lets go where it is; where
# pictures come slowly, the browser tells of all moves at once.
FLICKED = """
import { Flick } from "../player/flick.js";
const moves = [1, 2, 3, 4, 5, 6].map((k) =>
  ({ clientX: 8 * k, clientY: 0, timeStamp: 500 + 10 * k, isPrimary: true }));
const slowly = [{ ...moves.at(-1), getCoalescedEvents: () => moves }];
const one_by_one = moves.map((move) => ({ ...move, getCoalescedEvents: () => [move] }));
const of_old_browsers = moves;

class Hand extends Flick {
  get seen() { return { x: 0, y: 0, radius: 40 }; }
}

function spins(told) {
  const listeners = {};
  const launched = [];
  const canvas = { addEventListener: (kind, call) => { listeners[kind] = call; } };
  const scene = { toy: {}, controls: { enabled: true } };
  new Hand(canvas, scene, (spin) => launched.push(spin));
  const begin = { offsetX: 0, offsetY: 0, clientX: 0, clientY: 0, timeStamp: 0, isPrimary: true };
  listeners.pointerdown(begin);
  for (const move of told) listeners.pointermove(move);
  listeners.pointerup({ ...moves.at(-1), timeStamp: 565 });
  return [launched, scene.controls.enabled];
}
export const found = [spins(one_by_one), spins(slowly), spins(of_old_browsers), spins([])];
"""


def test_a_flick_on_slow_frames_is_as_fast_as_on_quick_ones() -> None:
    quickly, slowly, in_old_browsers, not_told = found_in_the_page(FLICKED)
    assert quickly[0] == slowly[0] == in_old_browsers[0]
    # From the first move, 510 ms, to the end, 565 ms: 40 pixels are a radius, the stem a fifth.
    assert quickly[0] == [pytest.approx(1.0 / 0.055 / 0.2)]
    assert quickly[1], "the camera can be turned again"
    assert not_told[0] == [], "without moves nothing is known of the last 90 ms"
