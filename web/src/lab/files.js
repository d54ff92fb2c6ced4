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

// The run from its start as the scene plays it.
export async function film(player) {
  const kind = ["video/webm;codecs=vp9", "video/webm;codecs=vp8", "video/webm"].find((one) =>
    MediaRecorder.isTypeSupported(one),
  );
  const recorder = new MediaRecorder(player.canvas.captureStream(FRAMES), { mimeType: kind });
  const parts = [];
  recorder.ondataavailable = ({ data }) => parts.push(data);
  const ended = new Promise((done) => {
    recorder.onstop = done;
  });
  const { loop } = player;
  player.loop = false;
  player.seek(0);
  player.toggle(true);
  recorder.start();
  await new Promise((done) => {
    const look = setInterval(() => {
      if (player.playing) return;
      clearInterval(look);
      done();
    }, 50);
  });
  recorder.stop();
  await ended;
  player.loop = loop;
  return new Blob(parts, { type: "video/webm" });
}
