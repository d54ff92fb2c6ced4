// The phase map on the page.

import { lab, followTheme } from "tippetop-lab";
import { PhaseMap } from "tippetop-lab/map.js";

export default {
  template: `<div class="lab-map">
    <div class="lab-map-chart" tabindex="0" role="application" aria-label="Map of final tilts over spin and friction.
      Arrow keys choose a cell, Enter launches it."></div>
    <div class="lab-map-key" aria-hidden="true"><span>upright <i></i> inverted</span>
      <span><b></b> leaves the table</span><span><u></u> no final tilt; point to see why</span></div>
    <p class="lab-map-tip" aria-live="polite"></p></div>`,
  mounted() {
    this.map = new PhaseMap(this.$el.querySelector(".lab-map-chart"), this.$el.querySelector(".lab-map-tip"));
    lab.map = this.map;
    this.map.addEventListener("launch", ({ detail }) => this.$emit("launch", detail));
    this.observer = followTheme((dark) => this.map.setTheme(dark));
  },
  unmounted() {
    this.observer?.disconnect();
    this.map?.dispose();
  },
  methods: {
    begin(...map) {
      this.$el.classList.add("lab-map-begun");
      this.map.begin(...map);
    },
    put(...cells) {
      this.map.put(...cells);
    },
    here(place) {
      this.map.here(place);
    },
  },
};
