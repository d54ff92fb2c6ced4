// Where the scene is seen from: views, turns, and how the camera sinks to the table by itself.

import * as THREE from "three";

// How far down the camera goes, rad from above: nearly to the table.
const LOWEST = 1.53;

const VIEWS = { orbit: [3.6, -5.6, 3.1], side: [0, -6.6, 0.7], above: [0, -0.05, 7.5] };

// The camera and its controls.
export class Eye {
  constructor(camera, controls) {
    this.camera = camera;
    this.controls = controls;
    // Whether the visitor holds the camera, and by which share of its way it has sunk.
    this.held = false;
    this.sunk = 0;
    // Turns the table's normal to the vertical, and all that is looked from with it.
    this.ground = new THREE.Quaternion();
    controls.maxPolarAngle = LOWEST;
    controls.minDistance = 2;
    controls.maxDistance = 30;
    controls.addEventListener("start", () => {
      this.held = true;
    });
  }

  // Stand on level ground beside a table of some slope, rad, that falls in the direction of its azimuth.
  standBeside({ slope, azimuth }) {
    const across = new THREE.Vector3(-Math.sin(azimuth), Math.cos(azimuth), 0);
    this.ground.setFromAxisAngle(across, -slope);
  }

  // Draw with the camera where it is seen from on the ground.
  drawFrom(draw) {
    const { camera, ground } = this;
    const { target } = this.controls;
    const place = camera.position.clone();
    const turn = camera.quaternion.clone();
    camera.position.sub(target).applyQuaternion(ground).add(target);
    camera.quaternion.premultiply(ground);
    draw();
    camera.position.copy(place);
    camera.quaternion.copy(turn);
  }

  // Put the camera at one of the `VIEWS`.
  look(name) {
    const centre = this.controls.target;
    const [x, y, z] = VIEWS[name] ?? VIEWS.orbit;
    if (name === "orbit" || centre.lengthSq() === 0) centre.z = 1.05;
    this.camera.position.set(centre.x + x, centre.y + y, centre.z + z);
    this.release();
    this.controls.update();
  }

  // Where the camera is from what it looks at: distance, angle from above and angle around, rad.
  get place() {
    const { x, y, z } = this.camera.position.clone().sub(this.controls.target);
    const distance = Math.hypot(x, y, z);
    return [distance, Math.acos(z / distance), Math.atan2(y, x)];
  }

  set place([distance, down, around]) {
    const flat = distance * Math.sin(down);
    const offset = [flat * Math.cos(around), flat * Math.sin(around), distance * Math.cos(down)];
    this.camera.position.set(...offset).add(this.controls.target);
  }

  turn(across, up) {
    const [distance, down, around] = this.place;
    this.held = true;
    this.place = [distance, Math.min(Math.max(down - up, 0.02), LOWEST), around + across];
    this.controls.update();
  }

  zoom(factor) {
    const [distance, down, around] = this.place;
    this.place = [Math.min(Math.max(distance * factor, 2), 30), down, around];
    this.controls.update();
  }

  // Let the camera sink and rise by itself again.
  release() {
    this.held = false;
    this.sunk = 0;
  }

  // Let the camera down to the table by a share of the way, unless the visitor holds it.
  sink(share) {
    if (this.held) {
      this.sunk = 0;
      return;
    }
    if (!share && !this.sunk) return;
    const [distance, down, around] = this.place;
    if (!this.sunk) this.high = [distance, down];
    const [far, above] = this.high;
    this.sunk = share;
    this.place = [far * (1 - 0.22 * share), above + Math.max(LOWEST - above, 0) * share, around];
  }
}
