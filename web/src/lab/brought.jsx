// A top that is brought: a file dropped on the page or opened, or points that are pasted.

import { useEffect, useState } from "preact/hooks";

import { edge } from "../run/arc.js";
import { contentOf, Unreadable } from "./bring.js";
import { t, translated } from "./i18n.js";
import { refusedOther } from "./refusal.js";
import { changed, inSi, withPushes } from "./setup.js";
import { MATERIALS } from "./turning.js";
import { digits } from "./units.js";
import { doubtInWords } from "./words.js";

const LENGTHS = ["m", "cm", "mm", "in"];
const MM = 1e3;
// A ball of 30 mm: half of its outline, in two arcs.
const EXAMPLE = "0, -15\n15, 0, 15\n0, 15, 15";
// A height below this, in sizes of the body, is zero but for rounding.
const NO_HEIGHT = 1e-9;

/** Take in a text: a problem or a body is launched, of all else it is asked what it is. */
export function bring(lab, name, text) {
  try {
    const content = contentOf(name, text);
    const { setup } = lab.state;
    if (content.problem) {
      launch(lab, name, { problem: content.problem, duration: setup.duration });
    } else if (content.body) {
      launch(lab, name, changed(setup, { body: content.body }));
    } else {
      // Points have no unit of their own, and most people measure in millimetres.
      const unit = content.points === undefined ? null : "mm";
      lab.set({ brought: { name, content, material: "beech", unit, whole: false } });
    }
  } catch (error) {
    if (!(error instanceof Unreadable)) throw error;
    lab.set({ brought: { name, trouble: sentenceOf(error) } });
  }
}

// Launch what a file says; only of what was launched is it said that it was.
async function launch(lab, name, setup) {
  const brought = { name, isWaiting: true };
  lab.set({ brought });
  const isLaunched = await lab.go(inSi(setup));
  if (lab.state.brought !== brought) return;
  const { sentence } = lab.state.trouble ?? {};
  if (isLaunched || !sentence) {
    lab.set({ brought: isLaunched ? { name } : null });
    return;
  }
  const trouble = t("brought.refused", { name, sentence });
  lab.set({ brought: { name, trouble }, trouble: null });
}

const sentenceOf = ({ key, gaps }) => t(`brought.trouble.${key}`, gaps);

async function bringFile(lab, file) {
  if (file) bring(lab, file.name, await file.text().catch(() => ""));
}

/** What makes an element take files that are dropped on it. */
export function dropping(lab) {
  return {
    onDragOver: (event) => event.preventDefault(),
    onDrop: (event) => {
      event.preventDefault();
      const [file] = event.dataTransfer.files;
      if (file) bringFile(lab, file);
      else bring(lab, t("brought.pasted"), event.dataTransfer.getData("text/plain"));
    },
  };
}

export function Bring({ lab }) {
  const [text, write] = useState("");
  const { brought } = lab.state;
  const open = ({ target }) => {
    bringFile(lab, target.files[0]);
    target.value = "";
  };
  return (
    <section class="bring" aria-label={t("brought.title")}>
      <h3>{t("brought.title")}</h3>
      <p class="hint">{t("brought.intro")}</p>
      <div class="row">
        <label class="file">
          <span>{t("brought.open")}</span>
          <input type="file" accept=".toml,.csv,.tsv,.txt,.svg,.stl,.dxf" onChange={open} />
        </label>
      </div>
      <details>
        <summary>{t("brought.paste")}</summary>
        <textarea
          rows={5}
          aria-label={t("brought.points")}
          placeholder={EXAMPLE}
          value={text}
          onInput={(event) => write(event.target.value)}
        />
        <button
          type="button"
          disabled={!text.trim()}
          onClick={() => bring(lab, t("brought.pasted"), text)}
        >
          {t("brought.read")}
        </button>
      </details>
      {brought?.trouble && (
        <p class="refused" role="alert">
          {brought.trouble}
        </p>
      )}
      {brought && !brought.trouble && !brought.content && !brought.isWaiting && (
        <p role="status">{t("brought.launched", brought)}</p>
      )}
    </section>
  );
}

/** What a brought top is: its choices, weight, section and what it will do, in `children`. */
export function Brought({ lab, children }) {
  const { brought } = lab.state;
  const { answer, trouble } = useAnswer(lab, brought);
  const set = (changes) => lab.set({ brought: { ...brought, ...changes } });
  const spin = () => {
    const launch = { body: answer.body, rolling_resistance: 0, "contact.liftoff": "fly" };
    lab.go(changed(withPushes(lab.state.setup, []), { ...launch, duration: 10 }));
  };
  return (
    <>
      <p>{t("brought.is", brought)}</p>
      <Choices brought={brought} set={set} />
      {trouble && (
        <p class="refused" role="alert">
          {trouble}
        </p>
      )}
      {!answer && !trouble && (
        <div class="row">
          <p role="status">{t("page.computing")}</p>
          <button type="button" onClick={() => lab.engine.forget()}>
            {t("page.stop")}
          </button>
        </div>
      )}
      {answer && <Answer answer={answer} />}
      {answer?.body && children(answer.body)}
      <div class="row">
        <button type="button" class="strong" disabled={!answer?.body} onClick={spin}>
          {t("own.spin")}
        </button>
        <button type="button" onClick={() => lab.set({ brought: null })}>
          {t("brought.back")}
        </button>
      </div>
    </>
  );
}

function Choices({ brought, set }) {
  const { workpiece } = brought.content;
  return (
    <div class="row">
      {!workpiece?.density && (
        <label class="choice">
          <span>{t("own.material")}</span>
          <select
            value={brought.material}
            onChange={(event) => set({ material: event.target.value })}
          >
            {Object.keys(MATERIALS).map((name) => (
              <option value={name}>{t(`own.${name}`)}</option>
            ))}
          </select>
        </label>
      )}
      <label class="choice">
        <span>{t("brought.unit")}</span>
        <select
          value={brought.unit ?? ""}
          onChange={(event) => set({ unit: event.target.value || null })}
        >
          {brought.content.points === undefined && <option value="">{t("brought.own")}</option>}
          {LENGTHS.map((name) => (
            <option value={name}>{name}</option>
          ))}
        </select>
      </label>
      <label>
        <input
          type="checkbox"
          checked={brought.whole}
          onChange={(event) => set({ whole: event.target.checked })}
        />{" "}
        {t("brought.whole")}
      </label>
    </div>
  );
}

// What a worker says of what was brought: nothing yet while it thinks.
function useAnswer(lab, brought) {
  const [found, say] = useState({});
  useEffect(() => {
    let isWanted = true;
    const tell = (one) => {
      if (isWanted) say(one);
    };
    const refuse = (error) => {
      if (!error) return tell({ trouble: t("brought.stopped") });
      const trouble = error instanceof Unreadable ? sentenceOf(error) : refusalOf(error);
      return tell({ trouble });
    };
    say({});
    const { content, material, unit, whole } = brought;
    const choices = { density: MATERIALS[material], unit, whole };
    lab.whatIs(content, choices).then((answer) => tell({ answer }), refuse);
    return () => {
      isWanted = false;
    };
  }, [brought]);
  return found;
}

const refusalOf = (error) => refusedOther(error).replace(" with whole=True", "");

function Answer({ answer: { weight, remarks, body, doubts = [], refusal } }) {
  const { mass, center, size, I1, I3, stated, edges, deviation } = weight;
  const height = Math.abs(center) < NO_HEIGHT * size ? 0 : center;
  const fitted = edges !== stated || deviation > 0;
  return (
    <>
      {remarks.map((remark) => (
        <p class="hint">{translated(remark) ?? t("brought.axis")}</p>
      ))}
      {fitted && (
        <p class="hint">
          {t("brought.fitted", { edges, stated, deviation: digits(deviation * MM, 2) })}
        </p>
      )}
      {body && <Outline profile={body.profile} />}
      <dl class="facts">
        <dt>{t("own.mass")}</dt>
        <dd>{digits(mass * 1e3, 4)} g</dd>
        <dt>{t("brought.centre")}</dt>
        <dd>{digits(height * MM, 4)} mm</dd>
        <dt>{t("own.inertia")}</dt>
        <dd>{digits(I3 / I1, 4)}</dd>
      </dl>
      {doubts.map((doubt) => (
        <p class="doubt">{doubtInWords(doubt)}</p>
      ))}
      {refusal && (
        <p class="refused" role="alert">
          {refusalOf(refusal)}
        </p>
      )}
    </>
  );
}

// The section of a body, with its centre of mass.
function Outline({ profile }) {
  const points = profile.slice(1).flatMap((point, k) => edge(profile[k], point));
  const least = (a, b) => Math.min(a, b);
  const most = (a, b) => Math.max(a, b);
  const across = points.map(([r]) => r).reduce(most);
  const heights = points.map(([, z]) => z);
  const [low, high] = [heights.reduce(least), heights.reduce(most)];
  const room = 0.08 * Math.max(2 * across, high - low);
  const text = (side) => points.map(([r, z]) => `${side * r},${-z}`).join(" ");
  const box = [-across - room, -high - room, 2 * (across + room), high - low + 2 * room];
  return (
    <svg class="section" viewBox={box.join(" ")} role="img" aria-label={t("brought.drawing")}>
      <polygon points={text(1)} class="wood thin" />
      <polygon points={text(-1)} class="wood thin" />
      <circle cx="0" cy="0" r={room / 5} class="mass" />
    </svg>
  );
}
