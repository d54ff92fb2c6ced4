// A flick of the top by hand: a drag that begins on it, and is let go while it moves, spins its stem between the fingers.

import * as THREE from "three";

// Radius of the stem that the fingers turn, in radii of the body; the time over which its speed is taken, ms.
const STEM = 0.2;
const LATELY = 90;
// Spins that a hand does not exceed, rad/s, and below which nothing is launched.
const FASTEST = 250;
const SLOWEST = 5;
// Tilts at which a hand lets go, rad, and the tilt per radius that it is dragged up or down.
const TILTS = [0.03, 0.6];
const TILT_PER_RADIUS = 0.15;

export class Flick {
  // Calls `launch` with a spin, rad/s, and a tilt, rad.
  constructor(canvas, scene, launch) {
    this.canvas = canvas;
    this.scene = scene;
    this.launch = launch;
    this.places = null;
    canvas.addEventListener("pointerdown", (event) => this.begin(event), { capture: true });
    canvas.addEventListener("pointermove", (event) => this.move(event));
    canvas.addEventListener("pointerup", (event) => this.end(event));
    canvas.addEventListener("pointercancel", () => this.leave());
  }

  // Where the top is seen, pixels: its middle and its radius.
  get seen() {
    const { camera, toy } = this.scene;
    const { clientWidth, clientHeight } = this.canvas;
    const middle = toy.position.clone();
    const beside = new THREE.Vector3(1, 0, 0).applyQuaternion(camera.quaternion).add(middle);
    const [x, y, edge] = [middle.project(camera), beside.project(camera)].flatMap((at, k) => {
      const across = ((at.x + 1) / 2) * clientWidth;
      return k ? [across] : [across, ((1 - at.y) / 2) * clientHeight];
    });
    return { x, y, radius: Math.abs(edge - x) };
  }

  begin(event) {
    if (!this.scene.toy || !event.isPrimary) return;
    const { x, y, radius } = this.seen;
    if (Math.hypot(event.offsetX - x, event.offsetY - y) > radius) return;
    this.places = [placeOf(event)];
    this.scene.controls.enabled = false;
  }

  move(event) {
    if (!this.places || !event.isPrimary) return;
    // Where pictures come slowly, an event stands for several moves.
    const moves = event.getCoalescedEvents?.() ?? [];
    this.places.push(...(moves.length ? moves : [event]).map(placeOf));
  }

  end(event) {
    const { places } = this;
    this.leave();
    if (!places) return;
    places.push(placeOf(event));
    const last = places.at(-1);
    const from = places.find(({ time }) => last.time - time <= LATELY) ?? last;
    const passed = (last.time - from.time) / 1000;
    const { radius } = this.seen;
    const speed = passed > 0 ? (last.x - from.x) / radius / passed : 0;
    const spin = Math.min(Math.abs(speed) / STEM, FASTEST);
    if (spin < SLOWEST) return;
    const lifted = Math.abs(last.y - places[0].y) / radius;
    const tilt = Math.min(TILTS[0] + TILT_PER_RADIUS * lifted, TILTS[1]);
    // To the right, the near side of the top goes to the right: it turns to the left, seen from above.
    this.launch(Math.sign(speed) * spin, tilt);
  }

  leave() {
    this.places = null;
    if (this.scene.controls) this.scene.controls.enabled = true;
  }
}

const placeOf = ({ clientX, clientY, timeStamp }) => ({ x: clientX, y: clientY, time: timeStamp });
