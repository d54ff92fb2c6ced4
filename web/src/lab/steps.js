// The steps of the story: launches, and how each is seen.

import { preset } from "./presets.js";
import { changed } from "./setup.js";

// Of each step: its launch, what is to be seen in it (or how long it is watched, s), the arrows and curves it shows, the
// launches whose pale tops stand beside it, how far away the camera is, the preset whose figure in the report shows it
// too, the arrows that its answer speaks of, whether the picture of the torque explains it, and what the visitor may go on
// to.
export const STEPS = [
  {
    from: "turns",
    picture: true,
    arrows: ["slip", "friction", "torque"],
    watch: "flip",
    setup: preset("turns"),
    show: ["trace", "glass", "axis"],
    plots: ["tilt", "height", "spin"],
  },
  {
    setup: changed(preset("slow"), { duration: 8 }),
    show: ["trace", "glass", "axis"],
    plots: ["tilt", "spin"],
  },
  {
    from: "half",
    watch: "arrival",
    setup: preset("half"),
    show: ["trace", "glass", "axis"],
    plots: ["tilt", "slip", "precession"],
  },
  {
    from: "turns",
    watch: "flip",
    arrows: ["momentum", "torque"],
    setup: preset("turns"),
    show: ["trace", "glass", "momentum"],
    plots: ["tilt", "spin", "energy", "jellett_change"],
  },
  {
    setup: changed(preset("none"), { duration: 8 }),
    show: ["trace", "glass", "axis", "friction"],
    distance: 2,
    plots: ["tilt", "energy", "slip"],
  },
  {
    from: "much",
    watch: 7,
    beside: [changed(preset("turns"), { duration: 8 })],
    setup: changed(preset("turns"), { "friction.mu": 3000, duration: 8 }),
    show: ["trace", "glass", "friction"],
    plots: ["tilt", "slip", "energy"],
  },
  {
    from: "jumps",
    watch: "flip",
    setup: changed(preset("jumps"), { duration: 9 }),
    show: ["trace", "glass", "friction"],
    plots: ["tilt", "normal_force", "height"],
  },
  {
    watch: "flip",
    setup: preset("stem"),
    show: ["trace", "glass", "axis"],
    plots: ["tilt", "height", "normal_force"],
    extra: "thin",
  },
  {
    beside: [changed(preset("drill"), { "launch.spin": 155, duration: 8 })],
    setup: changed(preset("dry"), { duration: 8 }),
    show: ["trace", "glass", "friction"],
    plots: ["tilt", "slip", "energy"],
    extra: "drill",
  },
  {
    watch: "flip",
    setup: preset("turns"),
    show: ["trace", "glass"],
    plots: ["tilt", "spin"],
    extra: "own",
  },
];

/** The step of that number, or the last. */
export function stepOf(number) {
  return STEPS[Math.min(number, STEPS.length - 1)];
}
