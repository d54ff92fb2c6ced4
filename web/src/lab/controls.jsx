// The launch's controls: what to start from, the main dials, the table, and the rest to be unfolded.

import { Dial } from "./dial.jsx";
import { LAW, MAIN, START, TABLE, TOP } from "./dials.js";
import { part, t } from "./i18n.js";
import { PRESETS, TABLES } from "./presets.js";
import { Push } from "./push.jsx";
import { same } from "./setup.js";
import { CHOICES, shown } from "./units.js";
import { heading } from "./words.js";

const LAWS = ["viscous", "coulomb", "static_coulomb", "contensou", "regularized_coulomb"];
// Marks beyond the slider of the spin, rad/s, are not shown.
const HIGHEST_MARK = 250;

function Choice({ name, value, options, onChange }) {
  return (
    <label class="choice">
      <span>{name}</span>
      <select value={value} onChange={(event) => onChange(event.target.value)}>
        {options.map(([key, text]) => (
          <option value={key}>{text}</option>
        ))}
      </select>
    </label>
  );
}

export function Launch({ lab }) {
  const { setup, prospect } = lab.state;
  const marks = marksOf(prospect);
  const tops = Array.isArray(setup.problem.body.shape) ? [TOP.at(-1)] : TOP;
  return (
    <div class="controls">
      <Preset lab={lab} />
      <Dials lab={lab} dials={MAIN} marks={marks} />
      <Prospect lab={lab} marks={marks} />
      <div class="row">
        <button type="button" class="strong" onClick={() => lab.go(setup)}>
          {t("controls.launch")}
        </button>
        <span class="hint">{t("controls.flick")}</span>
      </div>
      <Push lab={lab} />
      <Friction lab={lab} />
      <Units lab={lab} />
      <Section lab={lab} name="more" dials={TABLE}>
        <Liftoff lab={lab} />
      </Section>
      <Section lab={lab} name="top" dials={tops} />
      <Section lab={lab} name="letGo" dials={START} />
    </div>
  );
}

// Controls to be unfolded, which are where one of them is refused.
function Section({ lab, name, dials, children }) {
  const isRefused = dials.some(({ field }) => field === lab.state.trouble?.field);
  return (
    <details open={isRefused || undefined}>
      <summary>{t(`controls.${name}`)}</summary>
      {children}
      <Dials lab={lab} dials={dials} />
    </details>
  );
}

function Dials({ lab, dials, marks = [] }) {
  return dials.map((dial) => (
    <Dial
      key={dial.field}
      dial={dial}
      lab={lab}
      marks={dial.field === "launch.spin" ? marks : []}
    />
  ));
}

// The launch to start from, and where it is taken from.
function Preset({ lab }) {
  const preset = PRESETS.find((one) => same(one.setup, lab.state.setup));
  const names = PRESETS.map(({ key }) => [key, t(`presets.${key}`)]);
  const source = preset && part(`sources.${preset.key}`);
  const choose = (key) => {
    if (key) lab.go(PRESETS.find((one) => one.key === key).setup);
  };
  return (
    <>
      <Choice
        name={t("controls.start")}
        value={preset?.key ?? ""}
        options={[["", t("controls.other")], ...names]}
        onChange={choose}
      />
      {source && <Source text={source} figure={preset.figure} />}
    </>
  );
}

function Source({ text, figure }) {
  if (!figure) return <p class="source">{text}</p>;
  return (
    <p class="source">
      <a href={figure} rel="noreferrer" title={t("presets.figure")}>
        {text}
      </a>
    </p>
  );
}

// What the theory says of the launch before it is followed.
function Prospect({ lab, marks }) {
  const { setup, prospect, units } = lab.state;
  const sentences = meaningOf(marks, setup.problem, units);
  return (
    <p class="prospect">
      {prospect?.ends?.length ? heading(prospect, units) : t("controls.unknown")}
      {sentences.map((sentence) => ` ${sentence}`)}
    </p>
  );
}

// The critical spins that the slider of the spin can show.
function marksOf(prospect) {
  const { upright, inverted } = prospect?.critical ?? {};
  const marks = [
    { name: "ω_c1", what: "upright", value: upright },
    { name: "ω_c2", what: "inverted", value: inverted },
  ];
  return marks.filter(({ value }) => Number.isFinite(value) && value < HIGHEST_MARK);
}

// What marks mean: a sphere is upright below the first and turns over above the second; others are told one by one.
function meaningOf(marks, { body, launch }, units) {
  const [first, second] = marks;
  const spins = marks.map(({ name, value }) => `${name} = ${shown(value, "spin", units)}`);
  const isSphere = body.shape.kind === "eccentric_sphere";
  if (isSphere && second && first.value < second.value) {
    const tilt = shown(launch.tilt, "angle", units, 3);
    return [t("controls.marks.both", { tilt }), ...spins.map((spin) => `${spin}.`)];
  }
  return marks.map(({ what }, k) => t(`controls.marks.${what}`, { spin: spins[k] }));
}

function Friction({ lab }) {
  const { friction } = lab.state.setup.problem;
  const tables = Object.keys(TABLES);
  const table = tables.find((key) => same(TABLES[key], friction)) ?? "";
  const names = tables.map((key) => [key, t(`tables.${key}`)]);
  const choose = (key) => {
    if (key) lab.change({ friction: TABLES[key] });
  };
  return (
    <>
      <Choice
        name={t("controls.table")}
        value={table}
        options={[["", t("tables.choose")], ...names]}
        onChange={choose}
      />
      <Choice
        name={t("controls.law")}
        value={friction.kind}
        options={LAWS.map((kind) => [kind, t(`laws.${kind}`)])}
        onChange={(kind) => lab.change({ "friction.kind": kind })}
      />
      <Dials lab={lab} dials={LAW} />
    </>
  );
}

function Units({ lab }) {
  const { units } = lab.state;
  const choice = (kind, name) => (
    <label>
      <input
        type="radio"
        name={`unit-${kind}`}
        checked={units[kind] === name}
        onChange={() => lab.set({ units: { ...units, [kind]: name } })}
      />{" "}
      {t(`units.${name}`)}
    </label>
  );
  return (
    <fieldset class="units">
      <legend>{t("controls.units")}</legend>
      {Object.entries(CHOICES).map(([kind, names]) => names.map((name) => choice(kind, name)))}
    </fieldset>
  );
}

function Liftoff({ lab }) {
  const options = [
    ["fly", t("controls.fly")],
    ["stop", t("controls.stopRun")],
    ["ignore", t("controls.ignore")],
  ];
  return (
    <Choice
      name={t("controls.liftoff")}
      value={lab.state.setup.problem.contact?.liftoff ?? "fly"}
      options={options}
      onChange={(liftoff) => lab.change({ "contact.liftoff": liftoff })}
    />
  );
}
