// The plots on the page: they show the player's run, follow its time, and set it.

import { lab, followTheme } from "tippetop-lab";
import { Plots } from "tippetop-lab/plots.js";

export default {
  template: `<section class="lab-plots" aria-label="Plots"><div class="lab-plots-bar">
    <span>Drag on a plot to move through time.</span>
    <button type="button" data-zoom="0.5">Zoom in</button>
    <button type="button" data-zoom="2">Zoom out</button>
    <button type="button" data-zoom="all">Whole run</button></div><div></div></section>`,
  mounted() {
    this.plots = new Plots(this.$el.lastElementChild);
    this.plots.addEventListener("seek", ({ detail }) => {
      lab.player?.toggle(false);
      lab.player?.seek(detail);
    });
    this.$el.addEventListener("click", ({ target }) => {
      const { zoom } = target.dataset;
      if (zoom) this.plots.zoom(zoom === "all" ? null : Number(zoom), lab.player?.time ?? 0);
    });
    this.onRun = () => this.plots.load(lab.player.track);
    this.onTime = () => this.plots.move(lab.player.time);
    lab.addEventListener("run", this.onRun);
    lab.addEventListener("time", this.onTime);
    this.observer = followTheme((dark) => this.plots.setTheme(dark));
    if (lab.player?.track) this.onRun();
  },
  unmounted() {
    lab.removeEventListener("run", this.onRun);
    lab.removeEventListener("time", this.onTime);
    this.observer?.disconnect();
    this.plots?.dispose();
  },
};
