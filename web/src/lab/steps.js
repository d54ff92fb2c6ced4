// The steps of the story: launches, and how each is seen.

import { preset } from "./presets.js";
import { changed } from "./setup.js";

// Of each step: its launch, what is to be seen in it (or how long it is watched, s), the arrows and curves it shows, the
// launches whose pale tops stand beside it, how far away the camera is, the preset whose figure in the report shows it
// too, whether the picture of the torque explains it, and what the visitor may go on to.
export const STEPS = [
  {
    from: "turns",
    picture: true,
    watch: "flip",
    setup: preset("turns"),
    show: ["trace", "glass", "axis"],
    plots: ["theta", "height", "omega3"],
  },
  {
    setup: changed(preset("slow"), { duration: 8 }),
    show: ["trace", "glass", "axis"],
    plots: ["theta", "omega3"],
  },
  {
    from: "half",
    watch: "arrival",
    setup: preset("half"),
    show: ["trace", "glass", "axis"],
    plots: ["theta", "slip", "phi_dot"],
  },
  {
    from: "turns",
    watch: "flip",
    setup: preset("turns"),
    show: ["trace", "glass", "momentum"],
    plots: ["theta", "omega3", "energy", "jellett_error"],
  },
  {
    setup: changed(preset("none"), { duration: 8 }),
    show: ["trace", "glass", "axis", "friction"],
    distance: 2,
    plots: ["theta", "energy", "slip"],
  },
  {
    from: "much",
    watch: 7,
    beside: [changed(preset("turns"), { duration: 8 })],
    setup: changed(preset("turns"), { "friction.mu": 3000, duration: 8 }),
    show: ["trace", "glass", "friction"],
    plots: ["theta", "slip", "energy"],
  },
  {
    from: "jumps",
    watch: "flight",
    setup: changed(preset("jumps"), { duration: 9 }),
    show: ["trace", "glass", "friction"],
    plots: ["theta", "normal_force", "height"],
  },
  {
    watch: "flip",
    setup: preset("stem"),
    show: ["trace", "glass", "axis"],
    plots: ["theta", "height", "normal_force"],
    extra: "thin",
  },
  {
    beside: [changed(preset("drill"), { "launch.spin": 155, duration: 8 })],
    setup: changed(preset("dry"), { duration: 8 }),
    show: ["trace", "glass", "friction"],
    plots: ["theta", "slip", "energy"],
    extra: "drill",
  },
  {
    watch: "flip",
    setup: preset("turns"),
    show: ["trace", "glass"],
    plots: ["theta", "omega3"],
    extra: "own",
  },
];

/** The step of that number, or the last. */
export function stepOf(number) {
  return STEPS[Math.min(number, STEPS.length - 1)];
}
