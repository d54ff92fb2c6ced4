// The page's state and what changes it. One launch is shown; what is asked for later overtakes what was asked before.

import { stillness } from "../player/player.js";
import { SHOWN } from "../player/scene.js";
import { jobFor } from "./bring.js";
import { Engine } from "./engine.js";
import { preferred, speak, t } from "./i18n.js";
import { MOST_PINS, readLink, writeLink } from "./link.js";
import { Mapping } from "./mapping.js";
import { refusal } from "./refusal.js";
import { changed, FIRST, flawOf, inSi, LONGEST, same, setupOf, withPushes } from "./setup.js";
import { stepOf } from "./steps.js";
import { digits, shown } from "./units.js";
import { happened, tell } from "./words.js";

// More turns than these are not computed, times in ms: until a run is said to be under way, and a link is kept.
const MOST_TURNS = 10_000;
const PATIENCE = 250;
const SHARE = 300;
// How long a launch is played whose slider was moved, s.
const PREVIEW = 1;

function sameMembers(one, other) {
  return one.length === other.length && one.every((member, k) => member === other[k]);
}

// Bring the stage into view where it is not.
export function showStage() {
  const stage = document.querySelector(".stage");
  const { top, bottom } = stage.getBoundingClientRect();
  if (top < 0 || bottom > innerHeight) stage.scrollIntoView({ block: "start" });
}

/** Show an element: directly under the stage where that stays in view, else by as little scrolling as it takes. */
export function showUnderStage(element) {
  const { position } = getComputedStyle(document.querySelector(".stage"));
  element.scrollIntoView({ block: position === "sticky" ? "start" : "nearest" });
}

export class Lab extends EventTarget {
  constructor() {
    super();
    this.engine = new Engine();
    this.ghosts = new Map();
    // The number of the last request, by which an older one sees that it was overtaken.
    this.latest = 0;
    const link = this.read(location.hash || location.search);
    this.state = {
      ...link,
      busy: null,
      prospect: null,
      guess: null,
      map: null,
    };
    this.state.trouble = this.troubleOf(link);
    // The launch that was shown last: what stays where another is refused.
    this.good = FIRST;
    addEventListener("popstate", () => this.restore());
  }

  read(text) {
    const link = readLink(text);
    const language = link.lang ?? preferred();
    speak(language);
    document.documentElement.lang = language;
    return link;
  }

  // What is not accepted of a link, to be told.
  troubleOf({ flaw, unread, units, setup }) {
    if (flaw) return refusal(flaw, { units, setup });
    if (!unread.length) return null;
    return { field: null, sentence: t("page.unread", { names: unread.join(", ") }) };
  }

  set(changes) {
    const before = this.companions;
    this.state = { ...this.state, ...changes };
    if (changes.lang) {
      speak(changes.lang);
      document.documentElement.lang = changes.lang;
    }
    this.dispatchEvent(new Event("state"));
    this.share();
    if (!sameMembers(this.companions, before)) this.raise();
    if ("tab" in changes) this.say();
  }

  // Change fields of the launch; while a slider is dragged, history waits for its end.
  change(changes, dragged = false) {
    if (dragged && !this.isDragged) {
      // What was before the drag is gone back to, and nothing between.
      this.keep(false);
      this.isDragged = true;
    }
    this.set({ setup: inSi(changed(this.state.setup, changes)), trouble: null });
    if (dragged) this.request(false, true);
    else this.settle();
  }

  // What is set now can be gone back to; it is followed as exactly as can be, and its first second is played on request.
  settle(preview = false) {
    this.isDragged = false;
    this.keep(true);
    this.request(false, false, preview);
  }

  // Launch the top as a hand has flicked it; a story waits for its own launch.
  flick(spin, tilt) {
    if (this.state.tab === "story") return;
    const launch = {
      "launch.spin": Number(spin.toPrecision(3)),
      "launch.tilt": Number(tilt.toFixed(2)),
    };
    this.go(changed(withPushes(this.state.setup, []), launch));
  }

  /** Go on from the moment that is shown with other pushes. */
  push(pushes) {
    const isPlayed = this.player.playing || !stillness();
    this.go(withPushes(this.state.setup, pushes), { play: false });
    this.player.toggle(isPlayed);
  }

  // Launch something else and play it; returns whether it was launched.
  async go(setup, { play = true, ...others } = {}) {
    const flaw = flawOf(setup);
    if (flaw) {
      this.set({ trouble: refusal(flaw, this.state), ...others });
      return false;
    }
    this.set({ setup, trouble: null, ...others });
    if (play) showStage();
    this.keep(true);
    return this.request(play);
  }

  refused({ problem: { launch }, duration }) {
    const turns = (Math.abs(launch.spin) * duration) / (2 * Math.PI);
    const bounds = t("accepted.duration", { most: LONGEST });
    if (!(typeof duration === "number" && duration > 0 && duration <= LONGEST)) {
      return refusal({ field: "duration", value: duration, accepted: bounds }, this.state);
    }
    if (turns <= MOST_TURNS || !Number.isFinite(turns)) return null;
    const value = shown(launch.spin, "spin", this.state.units);
    const name = t("quantities.launch.spin.name");
    return {
      field: "launch.spin",
      sentence: t("controls.tooLong", { name, value, turns: digits(turns, 2) }),
    };
  }

  // Follow the launch that is set: quickly while a slider moves. Returns whether it was accepted.
  async request(play, quick = false, preview = false) {
    const { setup } = this.state;
    this.isAwaited = true;
    this.latest += 1;
    const request = this.latest;
    const isLatest = () => request === this.latest;
    const trouble = this.refused(setup);
    if (trouble) return this.refuse(trouble);
    const late = setTimeout(() => this.set({ busy: this.state.busy ?? 0 }), PATIENCE);
    const onProgress = (share) => {
      if (isLatest() && this.state.busy !== null) this.set({ busy: share });
    };
    try {
      const track = await this.engine.run({ ...setup, quick }, onProgress);
      clearTimeout(late);
      if (!track) return false;
      this.good = setup;
      if (isLatest() || !this.playing) this.show(track, play, isLatest());
      if (preview && isLatest() && !stillness()) this.player.preview(PREVIEW);
      return true;
    } catch (error) {
      clearTimeout(late);
      return isLatest() ? this.refuse(refusal(error, this.state)) : false;
    } finally {
      if (isLatest()) this.isAwaited = false;
      if (isLatest() && this.state.busy !== null) this.set({ busy: null });
    }
  }

  // Keep the launch that was shown last; where none was, show the first.
  refuse(trouble) {
    this.isAwaited = false;
    this.set({ setup: this.good, trouble, busy: null });
    if (!this.track) this.request(false);
    return false;
  }

  // Show a run: the picture first, then what is known without it.
  show(track, play, last) {
    this.track = track;
    this.fresh = true;
    this.player.load(track);
    if (play) {
      this.player.scene?.eye.release();
      // Where no motion is wanted, its end is seen.
      this.player.seek(stillness() ? track.duration : 0);
      this.player.toggle(!stillness());
    }
    if (this.pending) this.look(this.pending);
    this.pending = null;
    this.player.addEventListener("time", () => this.tellOf(track, last), { once: true });
  }

  // What there is of a run beside its picture, once that is drawn.
  tellOf(track, last) {
    if (track !== this.track) return;
    this.dispatchEvent(new Event("run"));
    if (last) this.set({ prospect: track.header.prospect });
    this.say();
  }

  // The headline above the stage: in the story what happened in a step, else the account of the run.
  say() {
    if (!this.track) return;
    const { tab, step, units } = this.state;
    const isOfStory = tab === "story" && same(setupOf(this.track), stepOf(step).setup);
    this.player.say(isOfStory ? happened(step) : tell(this.track, units));
    if (!isOfStory) this.measure();
  }

  // Find out how many digits the times of the run have that is shown, and of those beside it, once they are shown.
  async measure() {
    const tracks = [this.track, ...this.pinned()].filter(
      ({ digits, header }) => !digits && !header.quick,
    );
    if (!tracks.length || sameMembers(tracks, this.measured ?? [])) return;
    this.measured = tracks;
    for (const track of tracks) {
      const known = await this.engine.digits(setupOf(track)).catch(() => null);
      if (tracks !== this.measured) return;
      const before = tell(this.track, this.state.units).headline;
      track.digits = known ?? {};
      if (tell(this.track, this.state.units).headline !== before) this.say();
      this.set({});
    }
  }

  stop() {
    this.engine.stop();
    this.latest += 1;
    this.set({
      setup: this.good,
      busy: null,
      trouble: { field: null, sentence: t("page.stopped") },
    });
  }

  // Compute the map around the launch that is set; what is left of another is given up.
  draw() {
    this.state.map?.stop();
    const map = new Mapping(this.state.setup);
    map.addEventListener("state", () => this.dispatchEvent(new Event("state")));
    this.set({ map });
  }

  // What somebody brings is: its weight, and the body or why it cannot be simulated.
  async whatIs(content, choices) {
    const { problem } = this.state.setup;
    return this.engine.brought({ ...jobFor({ content, ...choices }), problem });
  }

  pin() {
    const { pins, setup } = this.state;
    if (pins.some((one) => same(one, setup))) return;
    this.set({ pins: [...pins, setup].slice(-MOST_PINS) });
    this.keep(true);
  }

  unpin(setup) {
    this.set({ pins: this.state.pins.filter((one) => one !== setup) });
    this.keep(true);
  }

  // The launches whose ghosts are beside the top: those of a step of the story, and the pinned ones.
  get companions() {
    const { tab, step, pins } = this.state;
    const beside = tab === "story" ? stepOf(step).beside : null;
    return beside ? [...beside, ...pins] : pins;
  }

  // Compute the ghosts of the companions that are missing, then show them.
  async raise() {
    const { companions } = this;
    for (const pin of companions) {
      const key = JSON.stringify(pin);
      if (this.ghosts.has(key)) continue;
      const known = this.track && same(pin, setupOf(this.track));
      this.ghosts.set(key, known ? this.track : await this.engine.aside(pin).catch(() => null));
    }
    if (!sameMembers(companions, this.companions)) return;
    this.player.compare(this.pinned());
    this.dispatchEvent(new Event("run"));
    this.set({});
  }

  pinned() {
    return this.companions.map((pin) => this.ghosts.get(JSON.stringify(pin))).filter(Boolean);
  }

  ghostOf(pin) {
    return this.ghosts.get(JSON.stringify(pin));
  }

  // What the player shows, as a link keeps it.
  view() {
    const { player } = this;
    if (!player) return this.state.view;
    const { scene } = player;
    const on = Object.entries(scene?.shown ?? {})
      .filter(([, value]) => value)
      .map(([name]) => name);
    const usual = on.join(" ") === "trace glass";
    return {
      time: player.playing ? 0 : player.time,
      camera: scene?.eye.held ? scene.eye.place : null,
      shown: usual ? null : on,
      speed: player.speed,
    };
  }

  link() {
    return `${location.href.replace(/[#?].*$/, "")}#${writeLink({ ...this.state, view: this.view() })}`;
  }

  share() {
    clearTimeout(this.sharing);
    if (this.isDragged) return;
    this.sharing = setTimeout(() => this.keep(false), SHARE);
  }

  keep(anew) {
    clearTimeout(this.sharing);
    const hash = this.link().replace(/^[^#]*/, "");
    if (hash === location.hash) return;
    const { depth = 0 } = history.state ?? {};
    if (anew) history.pushState({ depth: depth + 1 }, "", hash);
    else history.replaceState({ depth }, "", hash);
  }

  // Whether there is anything to take back: what was before this page is no step of it.
  get changed() {
    return Boolean(history.state?.depth);
  }

  undo() {
    if (this.changed) history.back();
  }

  // Go back to what the address says.
  restore() {
    const link = this.read(location.hash);
    clearTimeout(this.sharing);
    // What a class has brought together is no step of a launch.
    const { classroom } = this.state;
    this.state = { ...this.state, ...link, classroom, trouble: this.troubleOf(link) };
    this.dispatchEvent(new Event("state"));
    this.request(false);
    this.raise();
    this.look(link);
  }

  // Put the player where a link says.
  look({ view, timed }) {
    const { player } = this;
    if (view.shown) {
      for (const name of SHOWN) player.show({ [name]: view.shown.includes(name) });
    }
    if (view.camera && player.scene) {
      player.scene.eye.place = view.camera;
      player.scene.eye.held = true;
      player.scene.controls.update();
    }
    player.goAt(view.speed);
    if (timed) player.seek(view.time);
  }
}
