// The player on the page: fetches the launch it is told, shows it, and keeps links and address in step.

import { OrbitControls, THREE } from "nicegui-scene";
import { lab, readPowers, followTheme } from "tippetop-lab";
import { createPlayer, stillness } from "tippetop-player";

// How long a run may be on its way before that is shown, ms.
const PATIENCE = 300;
// When the slider's last move has reached the server, ms: it is held back for 50.
const SETTLED = 100;

export default {
  template: `<div class="lab-player"><div class="lab-player-host"></div>
    <p class="lab-trouble" role="alert" aria-live="assertive"></p></div>`,
  props: { trackPath: String, filePath: String },
  mounted() {
    this.trouble = this.$el.querySelector(".lab-trouble");
    this.player = createPlayer({ THREE, OrbitControls }, this.$el.querySelector(".lab-player-host"), {});
    lab.player = this.player;
    this.player.addEventListener("run", () => lab.dispatchEvent(new Event("run")));
    this.player.addEventListener("time", () => this.moved());
    this.observer = followTheme((dark) => this.player.setTheme(dark ? "dark" : "light"));
    lab.tune = (name, value) => this.tune(name, value);
    lab.copy = () => this.copy();
    this.powers = readPowers();
    globalThis.tippetopLab = lab;
    this.$emit("ready");
  },
  unmounted() {
    this.observer?.disconnect();
    this.powers?.disconnect();
    clearTimeout(this.waiting);
    this.player?.dispose();
  },
  methods: {
    // Show a launch, given as the query of a link; `number` counts what the page's server side has asked for.
    launch(query, play, number) {
      this.heard = number;
      this.request({ query, play, changes: {} });
    },
    // Change one field of the launch that is shown: a slider's short way, without asking the page's server side.
    tune(name, value) {
      const query = changed(this.query, { [name]: value });
      if (query === this.query) return;
      const waiting = this.next;
      this.request({ query, play: waiting?.play ?? false, changes: { ...waiting?.changes, [name]: value } });
    },
    // Ask for a run; while one is on its way only the newest waits.
    request(wanted) {
      this.next = wanted;
      this.query = wanted.query;
      this.share(wanted.query);
      if (!this.busy) this.work();
    },
    async work() {
      this.busy = true;
      while (this.next) {
        const wanted = this.next;
        this.next = null;
        this.expect(true);
        const { ok, content, sentence } = await this.ask(wanted.query);
        this.expect(false);
        if (ok) this.show(wanted, content);
        else if (ok === false) this.refuse(wanted, sentence);
        else this.say(sentence);
      }
      this.busy = false;
    },
    async ask(query) {
      try {
        const response = await fetch(`${this.trackPath}?${query}`);
        if (response.ok) return { ok: true, content: await response.arrayBuffer() };
        return { ok: response.status === 422 ? false : undefined, sentence: await response.text() };
      } catch (error) {
        return { sentence: "The laboratory's server does not answer." };
      }
    },
    // Show that a run is being computed, where that takes long enough to be noticed.
    expect(waiting) {
      clearTimeout(this.waiting);
      if (waiting) this.waiting = setTimeout(() => this.$el.setAttribute("aria-busy", "true"), PATIENCE);
      else this.$el.removeAttribute("aria-busy");
    },
    show({ query, play }, buffer) {
      this.say("");
      this.good = query;
      try {
        this.player.load(buffer);
      } catch (error) {
        console.error(error);
        this.say(`The run came, but cannot be shown: ${error.message}`);
        return;
      }
      if (play) {
        this.player.seek(0);
        this.player.toggle(!stillness());
      }
      this.fresh = query;
    },
    // What is refused is forgotten, so that it does not spoil what is asked for next; the page is told.
    refuse(wanted, sentence) {
      if (this.good === undefined) {
        this.say(sentence);
        return;
      }
      const { next } = this;
      if (next && Object.keys(next.changes).length) next.query = changed(this.good, next.changes);
      this.query = next ? next.query : this.good;
      this.share(this.query);
      const mended = next && Object.keys(wanted.changes).every((name) => name in next.changes);
      setTimeout(() => {
        this.$emit("refused", { query: this.query, heard: this.heard, why: mended ? "" : sentence });
      }, SETTLED);
    },
    async copy() {
      const { link } = lab;
      try {
        await navigator.clipboard.writeText(link);
        this.$emit("link", { link, copied: true });
      } catch (error) {
        this.$emit("link", { link, copied: false });
      }
    },
    say(sentence) {
      this.trouble.textContent = sentence;
    },
    share(query) {
      for (const link of document.querySelectorAll("a[data-kind]")) {
        link.href = `${this.filePath}/tippetop.${link.dataset.kind}?${query}`;
      }
      lab.link = `${location.origin}${location.pathname}?${query}`;
      clearTimeout(this.sharing);
      this.sharing = setTimeout(() => history.replaceState(history.state, "", `?${query}`), 400);
    },
    // A frame was drawn: the first of a run is what a slider was waiting for.
    moved() {
      lab.dispatchEvent(new Event("time"));
      if (this.fresh === undefined) return;
      const detail = { query: this.fresh, at: performance.now() };
      this.fresh = undefined;
      lab.dispatchEvent(new CustomEvent("drawn", { detail }));
    },
  },
};

// A query with some fields changed.
function changed(query, changes) {
  const fields = new URLSearchParams(query);
  for (const [name, value] of Object.entries(changes)) fields.set(name, value);
  return fields.toString();
}
