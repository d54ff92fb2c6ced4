// The spin as a tone: turns per second, four octaves up, so that it is heard.

const OCTAVES = 4;
const LOUDNESS = 0.06;

export class Tone {
  constructor() {
    this.context = new AudioContext();
    this.voice = this.context.createOscillator();
    this.voice.type = "triangle";
    this.gain = this.context.createGain();
    this.gain.gain.value = 0;
    this.voice.connect(this.gain).connect(this.context.destination);
    this.voice.start();
  }

  // Sound as a top of this spin, rad/s; silent where it is slow, flies or does not move.
  sound(spin, speed, audible) {
    const frequency = (Math.abs(spin) / (2 * Math.PI)) * 2 ** OCTAVES * Math.sqrt(speed);
    const now = this.context.currentTime;
    const heard = audible && frequency > 30;
    if (heard) this.voice.frequency.setTargetAtTime(Math.min(frequency, 4000), now, 0.02);
    this.gain.gain.setTargetAtTime(heard ? LOUDNESS : 0, now, 0.03);
  }

  close() {
    this.context.close();
  }
}
