// The page's side of its workers: the newest launch wanted is followed next, and what is no longer wanted is ended.

import packed from "worker-code";
import { Track } from "../player/track.js";

// How long a run that nobody waits for any more may go on before its worker is ended, ms.
const PATIENCE = 400;

// Where the workers' program is, which the page holds packed.
const PROGRAM = await unpacked(packed).then((program) => URL.createObjectURL(program));

function unpacked(text) {
  const bytes = Uint8Array.from(atob(text), (letter) => letter.charCodeAt(0));
  const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream("deflate-raw"));
  return new Response(stream, { headers: { "Content-Type": "text/javascript" } }).blob();
}

class Helper {
  constructor() {
    this.jobs = new Map();
    this.count = 0;
    this.begin();
  }

  begin() {
    this.worker = new Worker(PROGRAM);
    this.worker.onmessage = ({ data: { id, share, answer, error } }) => {
      const job = this.jobs.get(id);
      if (!job) return;
      if (share !== undefined) return job.onProgress?.(share);
      this.jobs.delete(id);
      if (error) job.reject(error);
      else job.resolve(answer);
    };
    this.worker.onerror = (event) => this.end({ message: event.message });
  }

  ask(job, details, onProgress) {
    const id = ++this.count;
    return new Promise((resolve, reject) => {
      this.jobs.set(id, { resolve, reject, onProgress });
      this.worker.postMessage({ id, job, ...details });
    });
  }

  // End what is under way; who waits for it is told why.
  end(reason) {
    this.worker.terminate();
    for (const { reject } of this.jobs.values()) reject(reason);
    this.jobs.clear();
    this.begin();
  }
}

export class Engine {
  constructor() {
    this.runner = new Helper();
    this.asides = new Helper();
  }

  // Follow a launch; one that is wanted later takes its place. Gives null for a run that was overtaken.
  run(setup, onProgress) {
    this.wanted?.resolve(null);
    return new Promise((resolve, reject) => {
      this.wanted = { setup, onProgress, resolve, reject };
      if (!this.busy) this.work();
      else if (performance.now() - this.began > PATIENCE) this.runner.end(null);
      else this.late ??= setTimeout(() => this.wanted && this.runner.end(null), PATIENCE);
    });
  }

  async work() {
    this.busy = true;
    while (this.wanted) {
      const { setup, onProgress, resolve, reject } = this.wanted;
      this.wanted = null;
      this.began = performance.now();
      try {
        const { track } = await this.runner.ask("run", setup, onProgress);
        resolve(new Track(track));
      } catch (error) {
        if (error) reject(error);
        else resolve(null);
      }
      clearTimeout(this.late);
      this.late = null;
    }
    this.busy = false;
  }

  // Give up the run that is under way.
  stop() {
    this.wanted?.resolve(null);
    this.wanted = null;
    this.runner.end(null);
  }

  // A single run beside the one that is shown.
  async aside(setup) {
    return new Track((await this.asides.ask("run", setup)).track);
  }

  // What a body is good for, without a run.
  prospects(body, problem) {
    return this.asides.ask("body", { body, problem });
  }

  // What to change in a top so that it stands at spins up to a reach, rad/s; what was asked before is given up.
  async advice(top, reach, { gravity, launch: { tilt } }) {
    this.adviser?.end(null);
    this.adviser ??= new Helper();
    return this.adviser.ask("advice", { top, reach, gravity, tilt });
  }

  // What a workpiece, points or a drawing is; what was asked before is given up.
  brought(job) {
    this.forget();
    this.reader ??= new Helper();
    return this.reader.ask("brought", job);
  }

  // Give up what is being read.
  forget() {
    if (this.reader?.jobs.size) this.reader.end(null);
  }

  // The density of the uniform solid that a body is, null if it is none.
  solid(body) {
    return this.asides.ask("solid", { body });
  }

  // How many digits of its times a run has; what was asked before is given up.
  digits(setup) {
    this.measurer?.end(null);
    this.measurer ??= new Helper();
    return this.measurer.ask("digits", setup);
  }

  // All numbers of a launch over time, as a text.
  async csv(setup, point) {
    return (await this.asides.ask("numbers", { ...setup, point })).csv;
  }
}

// Follow many launches in as many workers as there are cores to spare.
export class Crew {
  constructor() {
    this.helpers = Array.from(
      { length: Math.max(1, Math.min(4, navigator.hardwareConcurrency - 1)) },
      () => new Helper(),
    );
  }

  async follow(jobs, tell) {
    const left = jobs[Symbol.iterator]();
    await Promise.all(
      this.helpers.map(async (helper) => {
        for (const { key, setup } of left) {
          const answer = await helper.ask("cell", setup).catch((error) => ({ error }));
          if (this.over) return;
          tell(key, answer);
        }
      }),
    );
  }

  stop() {
    this.over = true;
    for (const helper of this.helpers) helper.worker.terminate();
  }
}
