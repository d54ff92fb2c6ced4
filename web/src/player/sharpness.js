// How many pixels are drawn: fewer where frames come late, all of them when nothing moves.

// Mean time between frames from which they are late, s; frames that are looked at before the next change; and how
// long nothing has moved when the moment is drawn once more, ms.
const LATE = 0.024;
const LOOKS = 12;
const STILL = 600;

export class Sharpness {
  constructor(scene) {
    this.scene = scene;
    this.forget();
  }

  // Forget how late frames came.
  forget() {
    this.mean = 0;
    this.seen = 0;
  }

  // What kept frames late the last time may be over.
  begin() {
    const { scene } = this;
    this.forget();
    if (scene.quality < scene.usual) scene.setQuality(scene.usual);
  }

  // Take note of a frame that came so long after the last, s.
  pace(passed) {
    const { scene } = this;
    if (!passed) return;
    this.mean = 0.9 * this.mean + 0.1 * passed;
    this.seen += 1;
    if (this.seen > LOOKS && this.mean > LATE && scene.quality > scene.least) {
      scene.setQuality(Math.max(scene.least, 0.75 * scene.quality));
      this.seen = 0;
    }
  }

  // Nothing has moved for so long, ms, since a moment: draw that as sharp as can be, once.
  rest(long, since, draw) {
    const { scene } = this;
    if (this.sharp === since || long < STILL) return;
    this.sharp = since;
    const { quality, best } = scene;
    if (quality >= best) return;
    scene.setQuality(best);
    draw();
    scene.setQuality(quality, false);
  }
}
