// The player on the page: fetches the launch it is told, shows it, and keeps links and address in step.

import { OrbitControls, THREE } from "nicegui-scene";
import { lab, watchTheme } from "tippetop-lab";
import { createPlayer } from "tippetop-player";

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
    this.observer = watchTheme((dark) => this.player.setTheme(dark ? "dark" : "light"));
    lab.tune = (name, value) => this.tune(name, value);
    globalThis.tippetopLab = lab;
    this.$emit("ready");
  },
  unmounted() {
    this.observer?.disconnect();
    this.player?.dispose();
  },
  methods: {
    // Show a launch, given as the query of a link; while one is on its way only the newest waits.
    async launch(query, play) {
      this.next = this.query = query;
      this.share(query);
      if (this.busy) return;
      this.busy = true;
      while (this.next !== undefined) {
        const wanted = this.next;
        this.next = undefined;
        try {
          const response = await fetch(`${this.trackPath}?${wanted}`);
          if (response.ok) this.show(wanted, await response.arrayBuffer(), play);
          else this.say(await response.text());
        } catch (error) {
          this.say("The laboratory's server does not answer.");
        }
      }
      this.busy = false;
    },
    // Change one field of the launch that is shown: a slider's short way, without asking the page's server side.
    tune(name, value) {
      const query = new URLSearchParams(this.query);
      query.set(name, value);
      if (query.toString() !== this.query) this.launch(query.toString());
    },
    show(query, buffer, play) {
      this.say("");
      this.player.load(buffer);
      if (play) {
        this.player.seek(0);
        this.player.toggle(true);
      }
      this.fresh = query;
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
