// Files of a run, made in the page.

import * as THREE from "three";
import { GLTFExporter } from "three/addons/exporters/GLTFExporter.js";

import { makeToy } from "../player/toy.js";
import { differences, FIRST } from "./setup.js";

// Poses of a film per second, and the film's frames per second.
const KEYS = 60;
const FRAMES = 30;
// Pixels of a picture for each of the screen's.
const FINE = 2;

export function save(name, content) {
  const link = document.createElement("a");
  link.href = URL.createObjectURL(content instanceof Blob ? content : new Blob([content]));
  link.download = name;
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 10_000);
}

// The command that repeats a run.
export function commandLine({ header: { problem, asked } }) {
  const words = Array.isArray(problem.body.shape) ? ["tippetop.toml"] : settings(problem);
  return ["tippetop simulate", ...words, `--duration ${asked}`].join(" \\\n  ");
}

// Options of the command that change the first launch into another one.
function settings(problem) {
  const text = (value) => (typeof value === "string" ? value : JSON.stringify(value));
  return differences(FIRST, { problem, duration: FIRST.duration })
    .filter(([, , value]) => value !== undefined)
    .map(([field, , value]) => `--set '${field}=${text(value)}'`);
}

// The moving top as a .glb, y up as the format wants it.
export async function glb(track) {
  const size = track.header.body.size;
  const toy = makeToy(track.header.body.parts);
  toy.name = "top";
  toy.scale.setScalar(size);
  const scene = new THREE.Scene();
  scene.rotation.x = -Math.PI / 2;
  scene.add(toy);
  const count = Math.max(2, Math.min(Math.ceil(track.duration * KEYS) + 1, 20_000));
  const times = Float32Array.from({ length: count }, (_, k) => (track.duration * k) / (count - 1));
  const positions = new Float32Array(3 * count);
  const turns = new Float32Array(4 * count);
  times.forEach((time, k) => {
    const {
      position,
      orientation: [w, x, y, z],
    } = track.at(time);
    positions.set(position, 3 * k);
    turns.set([x, y, z, w], 4 * k);
  });
  const clip = new THREE.AnimationClip("run", track.duration, [
    new THREE.VectorKeyframeTrack("top.position", times, positions),
    new THREE.QuaternionKeyframeTrack("top.quaternion", times, turns),
  ]);
  return new GLTFExporter().parseAsync(scene, { binary: true, animations: [clip] });
}

// The scene as it is drawn now.
export function picture(player) {
  return player.finely(FINE, () => new Promise((done) => player.canvas.toBlob(done, "image/png")));
}

/** A film of a run from its start as the scene plays it, with its time and its speed written below. */
export class Film {
  // Begin to film; the caption says at what share of its speed the run is played.
  constructor(player, caption) {
    this.player = player;
    this.caption = caption;
    const { clientWidth, clientHeight } = player.canvas;
    this.copy = Object.assign(document.createElement("canvas"), {
      width: 2 * Math.round(clientWidth / 2),
      height: 2 * Math.round(clientHeight / 2),
    });
    this.pen = this.copy.getContext("2d");
    this.before = { loop: player.loop, picture: player.picture };
    this.parts = [];
    const kind = ["video/webm;codecs=vp9", "video/webm;codecs=vp8", "video/webm"].find((one) =>
      MediaRecorder.isTypeSupported(one),
    );
    this.recorder = new MediaRecorder(this.copy.captureStream(FRAMES), { mimeType: kind });
    this.recorder.ondataavailable = ({ data }) => this.parts.push(data);
    this.content = new Promise((done) => {
      this.recorder.onstop = () => done(new Blob(this.parts, { type: "video/webm" }));
    });
    this.draw = this.draw.bind(this);
    this.wait = this.wait.bind(this);
    this.end = this.end.bind(this);
    player.addEventListener("time", this.draw);
    player.addEventListener("view", this.wait);
    player.addEventListener("run", this.end);
    player.loop = false;
    player.picture = 1 / FRAMES;
    player.seek(0);
    player.toggle(true);
    this.recorder.start();
  }

  draw() {
    const { player, pen, copy } = this;
    const { width, height } = copy;
    pen.drawImage(player.canvas, 0, 0, width, height);
    pen.font = "600 14px system-ui, sans-serif";
    pen.fillStyle = player.dark ? "#e6ebf0" : "#1e252d";
    pen.fillText(this.caption(player.time, player.paceAt(player.time)), 12, height - 12);
    if (player.time >= player.duration) this.end();
  }

  // While the run is not played nothing is filmed.
  wait() {
    const { player, recorder } = this;
    if (player.time >= player.duration) return;
    if (player.playing && recorder.state === "paused") recorder.resume();
    if (!player.playing && recorder.state === "recording") recorder.pause();
  }

  // End the film, here or where the run does: `content` then has it.
  end() {
    const { player, recorder } = this;
    if (recorder.state === "inactive") return;
    player.removeEventListener("time", this.draw);
    player.removeEventListener("view", this.wait);
    player.removeEventListener("run", this.end);
    Object.assign(player, this.before);
    player.toggle(false);
    recorder.stop();
  }
}
