// Why friction lifts the stem, as a picture: force, arm, torque and what a tenth of a second of it changes.

import { useState } from "preact/hooks";

import { t } from "./i18n.js";
import { preset } from "./presets.js";
import { torqueAt } from "./torque.js";
import { digits } from "./units.js";

// How long the torque acts, s, and how far the axis may be dragged, rad.
const TENTH = 0.1;
const [LEAST, MOST] = [0.1, 1.4];
const FIRST_TILT = 0.5;
const KEY_STEP = 0.05;
const DEGREES = 180 / Math.PI;
// Pixels of the ball's radius and of the angular momentum, and where the middle of the ball is.
const BALL = 62;
const LENGTH = 92;
const MIDDLE = [150, 148];

const { problem } = preset("turns");
const { spin } = problem.launch;

export function TorquePicture() {
  const [tilt, lean] = useState(FIRST_TILT);
  const { torque, momentum } = torqueAt(problem, spin, tilt);
  const later = momentum.map((value, k) => value + TENTH * torque[k]);
  const opened = tilt - Math.atan2(...later);
  return (
    <figure class="torque">
      <Drawing tilt={tilt} momentum={momentum} later={later} torque={torque} onLean={lean} />
      <figcaption>{t("torque.caption", { opened: digits(opened * DEGREES, 2) })}</figcaption>
    </figure>
  );
}

function Drawing({ tilt, momentum, later, torque, onLean }) {
  const scale = LENGTH / Math.hypot(...momentum);
  const alpha = problem.body.shape.eccentricity * BALL;
  const [sine, cosine] = [Math.sin(tilt), Math.cos(tilt)];
  const at = ([x, z], [dx, dz] = [0, 0]) => [x + dx, z - dz];
  const centre = at(MIDDLE, [-alpha * sine, -alpha * cosine]);
  const contact = [MIDDLE[0], MIDDLE[1] + BALL];
  const tip = at(
    centre,
    momentum.map((value) => scale * value),
  );
  const end = at(
    centre,
    later.map((value) => scale * value),
  );
  const push = at(
    centre,
    torque.map((value) => scale * TENTH * value),
  );
  const stem = at(MIDDLE, [1.45 * BALL * sine, 1.45 * BALL * cosine]);
  const set = (value) => onLean(Math.min(Math.max(value, LEAST), MOST));
  const drag = (event) => {
    if (!event.buttons) return;
    const screen = event.currentTarget.ownerSVGElement.getScreenCTM();
    const { x, y } = new DOMPoint(event.clientX, event.clientY).matrixTransform(screen.inverse());
    set(Math.atan2(x - MIDDLE[0], MIDDLE[1] - y));
  };
  const key = (event) => {
    const step = { ArrowUp: -1, ArrowLeft: -1, ArrowDown: 1, ArrowRight: 1 }[event.key];
    if (!step) return;
    set(tilt + step * KEY_STEP);
    event.preventDefault();
  };
  return (
    <svg viewBox="-34 0 334 244" role="group" aria-label={t("torque.label")}>
      <defs>
        <marker
          id="head"
          viewBox="0 0 8 8"
          refX="6"
          refY="4"
          markerWidth="7"
          markerHeight="7"
          orient="auto-start-reverse"
        >
          <path d="M0 0L8 4L0 8z" fill="context-stroke" />
        </marker>
      </defs>
      <line x1="20" x2="280" y1={contact[1]} y2={contact[1]} class="ground" />
      <circle cx={MIDDLE[0]} cy={MIDDLE[1]} r={BALL} class="ball" />
      <Line from={centre} to={stem} name="axle" />
      <Line from={centre} to={contact} name="arm" />
      <Line from={centre} to={tip} name="momentum" arrow />
      <Line from={centre} to={end} name="later" arrow />
      <Line from={centre} to={push} name="push" arrow />
      <circle cx={centre[0]} cy={centre[1]} r="4" class="mass" />
      <circle cx={contact[0]} cy={contact[1]} r="8" class="force" />
      <circle cx={contact[0]} cy={contact[1]} r="2.5" class="force point" />
      <Word place={[contact[0] - 40, contact[1] + 22]} text={t("torque.force")} name="force-word" />
      <Word place={[push[0] - 8, push[1] + 16]} text={t("torque.torque")} name="push-word" end />
      <Word place={[tip[0] + 18, tip[1] + 12]} text="L" name="momentum-word" />
      <Word place={[end[0] - 6, end[1] - 4]} text={t("torque.later")} name="later-word" end />
      <circle
        class="grip"
        cx={stem[0]}
        cy={stem[1]}
        r="11"
        tabindex="0"
        role="slider"
        aria-label={t("torque.grip")}
        aria-valuemin={Math.round(LEAST * DEGREES)}
        aria-valuemax={Math.round(MOST * DEGREES)}
        aria-valuenow={Math.round(tilt * DEGREES)}
        aria-valuetext={`${Math.round(tilt * DEGREES)}°`}
        onPointerDown={(event) => event.currentTarget.setPointerCapture(event.pointerId)}
        onPointerMove={drag}
        onKeyDown={key}
      />
    </svg>
  );
}

function Line({ from, to, name, arrow = false }) {
  const [[x1, y1], [x2, y2]] = [from, to];
  return (
    <line x1={x1} y1={y1} x2={x2} y2={y2} class={name} marker-end={arrow ? "url(#head)" : null} />
  );
}

function Word({ place: [x, y], text, name, end = false }) {
  return (
    <text x={x} y={y} class={name} text-anchor={end ? "end" : "start"}>
      {text}
    </text>
  );
}
