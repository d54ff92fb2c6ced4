// The form to push a top while it spins, at the moment that the picture shows, and the pushes that a launch has.

import { useEffect, useState } from "preact/hooks";

import { frictionKind, MAIN, placeOf, valueAt } from "./dials.js";
import { part, t } from "./i18n.js";
import { DIRECTIONS, MOST_PUSHES, momentOf, sortedPushes, strongest } from "./pushes.js";
import { digits } from "./units.js";

const FRICTION = MAIN.find(({ field }) => field === "friction.mu");
const MILLI = 1e-3;
// Steps of the slider of the strength, and the one where it is at first.
const STEPS = 50;
const FIRST_STEP = 10;

export function Push({ lab }) {
  const { setup } = lab.state;
  const { problem, pushes = [] } = setup;
  const [step, strengthen] = useState(FIRST_STEP);
  const [direction, turn] = useState("down");
  const [friction, slip] = useState(null);
  const time = useMoment(lab);
  const isFree = (problem.contact?.liftoff ?? "fly") === "fly";
  const most = strongest(problem.body.mass);
  const present = frictionAt(setup, time);
  const impulse = isFree ? Number(((step / STEPS) * most).toPrecision(3)) : 0;
  const isPossible = time < (lab.track?.header.asked ?? 0) && pushes.length < MOST_PUSHES;
  const isEmpty = impulse === 0 && (friction === null || friction === present);
  const push = () => {
    const mu = friction === present ? null : friction;
    const now = { time: momentOf(lab.player.time), impulse, direction: DIRECTIONS[direction], mu };
    lab.push(sortedPushes([...pushes, now]));
    slip(null);
  };
  return (
    <details class="push" open={pushes.length > 0 || undefined}>
      <summary>{t("push.title")}</summary>
      <p class="hint">{t("push.intro")}</p>
      {isFree ? (
        <>
          <Slider
            name={t("push.strength")}
            text={`${digits(impulse / MILLI, 3)} mN s`}
            range={[0, STEPS, 1]}
            value={step}
            onChange={strengthen}
          />
          <label class="choice">
            <span>{t("push.direction")}</span>
            <select value={direction} onChange={(event) => turn(event.target.value)}>
              {Object.keys(DIRECTIONS).map((name) => (
                <option value={name}>{t(`push.directions.${name}`)}</option>
              ))}
            </select>
          </label>
        </>
      ) : (
        <p class="hint">{t("push.held")}</p>
      )}
      <Slider
        name={t("push.friction")}
        text={frictionText(friction ?? present, problem)}
        range={[placeOf(FRICTION, FRICTION.low), placeOf(FRICTION, FRICTION.high), FRICTION.step]}
        value={placeOf(FRICTION, friction ?? present)}
        onChange={(place) => slip(valueAt(FRICTION, place))}
      />
      <div class="row">
        <button type="button" class="strong" disabled={!isPossible || isEmpty} onClick={push}>
          {t("push.now", { time: digits(time, 3) })}
        </button>
      </div>
      <Pushes lab={lab} pushes={pushes} />
    </details>
  );
}

// The time that the picture shows, rounded as a push takes it, s.
function useMoment(lab) {
  const [time, tell] = useState(0);
  useEffect(() => {
    const look = () => tell(momentOf(lab.player.time));
    lab.addEventListener("time", look);
    look();
    return () => lab.removeEventListener("time", look);
  }, []);
  return time;
}

function Slider({ name, text, range: [low, high, step], value, onChange }) {
  return (
    <label class="own-dial">
      <span>
        {name} <b>{text}</b>
      </span>
      <input
        type="range"
        min={low}
        max={high}
        step={step}
        value={value}
        aria-valuetext={text}
        onInput={(event) => onChange(Number(event.target.value))}
      />
    </label>
  );
}

function Pushes({ lab, pushes }) {
  const { problem } = lab.state.setup;
  const reached = lab.track?.header.reached ?? pushes.length;
  const remove = (push) => lab.push(pushes.filter((one) => one !== push));
  return (
    pushes.length > 0 && (
      <ul class="pushes" aria-label={t("push.list")}>
        {pushes.map((push, k) => (
          <li>
            <span>
              {pushText(push, problem)}
              {k >= reached && ` (${t("push.missed")})`}
            </span>
            <button type="button" onClick={() => remove(push)}>
              {t("push.remove")}
            </button>
          </li>
        ))}
      </ul>
    )
  );
}

/** A push in words. */
export function pushText({ time, impulse, direction, mu }, problem) {
  const name = Object.keys(DIRECTIONS).find((one) => DIRECTIONS[one] === direction);
  const where = name ? t(`push.directions.${name}`) : `${digits((direction * 180) / Math.PI, 3)}°`;
  const parts = [];
  if (impulse) parts.push(`${digits(impulse / MILLI, 3)} mN s, ${where}`);
  if (mu !== null)
    parts.push(`${part("quantities.friction.mu").symbol} = ${frictionText(mu, problem)}`);
  return `${digits(time, 4)} s: ${parts.join("; ") || "–"}`;
}

const frictionText = (mu, problem) => `${digits(mu, 3)} ${frictionKind({ problem })}`.trim();

// The friction coefficient at a time of a launch.
function frictionAt({ problem, pushes = [] }, time) {
  const before = pushes.filter((push) => push.time <= time && push.mu !== null);
  return before.at(-1)?.mu ?? problem.friction.mu;
}
