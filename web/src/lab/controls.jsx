// The launch's controls: each a name with its meaning, a slider and a number, in the visitor's units.

import { useState } from "preact/hooks";

import { ALL, kindOf, LAW, MAIN, placeOf, scaleOf, START, TABLE, TOP, valueAt } from "./dials.js";
import { decimal, part, t, translated } from "./i18n.js";
import { PRESETS, TABLES } from "./presets.js";
import { same, valueOf } from "./setup.js";
import { CHOICES, digits, shown, unitOf, withUnit } from "./units.js";
import { heading } from "./words.js";

export const LAWS = ["viscous", "coulomb", "contensou", "regularized_coulomb"];

export function Why({ name, text }) {
  const [open, turn] = useState(false);
  return (
    <>
      <button
        type="button"
        class="why"
        aria-expanded={open}
        aria-label={`? ${name}`}
        onClick={() => turn(!open)}
      >
        ?
      </button>
      {open && (
        <span class="why-text" role="note">
          {text}
        </span>
      )}
    </>
  );
}

function Dial({ dial, lab, marks = [] }) {
  const { setup, units, trouble } = lab.state;
  const value = valueOf(setup, dial.field);
  const [typed, type] = useState(null);
  if (value === undefined || value === null) return null;
  const { name, symbol, help } = part(`quantities.${dial.field}`);
  const kind = kindOf(dial, setup);
  const { name: unit, size } = unitOf(kind, units);
  const scale = scaleOf(dial, setup);
  const label = `${name} ${symbol}${unit ? ` (${unit})` : ""}`;
  const id = `dial-${dial.field.replaceAll(".", "-")}`;
  const [low, high] = [placeOf(dial, dial.low), placeOf(dial, dial.high)];
  const place = placeOf(dial, value / scale);
  const wrong = trouble?.field === dial.field;
  const text =
    typeof value === "number"
      ? decimal(String(Number((value / scale / size).toPrecision(4))))
      : String(value);
  const commit = (input) => {
    type(null);
    const number = Number(input.replace(",", ".").replace("−", "-"));
    lab.change({
      [dial.field]: input.trim() && Number.isFinite(number) ? number * size * scale : input,
    });
  };
  const share = (spin) => (100 * (placeOf(dial, spin) - low)) / (high - low);
  return (
    <div class={`dial ${wrong ? "wrong" : ""}`}>
      <span class="dial-name">
        <label for={id}>{label}</label>
        <Why name={name} text={help} />
      </span>
      <input
        class="dial-number"
        type="text"
        inputMode="decimal"
        aria-label={label}
        value={typed ?? text}
        aria-invalid={wrong}
        aria-describedby={wrong ? `${id}-wrong` : undefined}
        onInput={(event) => type(event.target.value)}
        onBlur={(event) => typed !== null && commit(event.target.value)}
        onKeyDown={(event) => event.key === "Enter" && commit(event.target.value)}
      />
      <div class="dial-slide">
        <input
          id={id}
          type="range"
          min={low}
          max={high}
          step={dial.step}
          value={place}
          data-field={dial.field}
          aria-valuetext={shown(value / scale, kind, units)}
          onInput={(event) =>
            lab.change({ [dial.field]: valueAt(dial, Number(event.target.value)) * scale }, true)
          }
          onChange={() => lab.settle()}
        />
        {marks.length > 0 && (
          <div class="dial-marks" aria-hidden="true">
            {marks.map(({ name: mark, value: at }) => (
              <span style={`left:${share(at)}%`}>{mark}</span>
            ))}
          </div>
        )}
      </div>
      {wrong && (
        <p class="refused" id={`${id}-wrong`} role="alert">
          {trouble.sentence}
        </p>
      )}
    </div>
  );
}

function Choice({ name, value, options, onChange }) {
  return (
    <label class="choice">
      <span>{name}</span>
      <select value={value} onChange={(event) => onChange(event.target.value)}>
        {options.map(([key, text, title]) => (
          <option value={key} title={title}>
            {text}
          </option>
        ))}
      </select>
    </label>
  );
}

function Units({ lab }) {
  const { units } = lab.state;
  return (
    <fieldset class="units">
      <legend>{t("controls.units")}</legend>
      {Object.entries(CHOICES).map(([kind, names]) =>
        names.map((name) => (
          <label>
            <input
              type="radio"
              name={`unit-${kind}`}
              checked={units[kind] === name}
              onChange={() => lab.set({ units: { ...units, [kind]: name } })}
            />{" "}
            {t(`units.${name}`)}
          </label>
        )),
      )}
    </fieldset>
  );
}

export function marksOf(prospect) {
  const { upright, inverted } = prospect?.critical ?? {};
  const marks = [
    { name: "ω₁", what: "upright", value: upright },
    { name: "ω₂", what: "inverted", value: inverted },
  ];
  return marks.filter(({ value }) => Number.isFinite(value) && value < 250);
}

// What the marks say: of a sphere that is upright below the first and turns over above the second; of others, less.
function* told(marks, { body, launch }, units) {
  const [first, second] = marks,
    whole = second && first.value < second.value && body.shape.kind === "eccentric_sphere";
  if (whole) yield t("controls.marks.both", { tilt: shown(launch.tilt, "angle", units, 3) });
  for (const { name, what, value } of marks) {
    const spin = `${name} = ${shown(value, "spin", units)}`;
    yield whole ? `${spin}.` : t(`controls.marks.${what}`, { spin });
  }
}

export function Launch({ lab }) {
  const { setup, prospect, units } = lab.state;
  const { problem } = setup;
  const known = PRESETS.find((one) => same(one.setup, setup));
  const source = known && part(`sources.${known.key}`);
  const table = Object.entries(TABLES).find(([, law]) => same(law, problem.friction))?.[0] ?? "";
  const marks = marksOf(prospect);
  const dials = (some) =>
    some.map((dial) => (
      <Dial
        key={dial.field}
        dial={dial}
        lab={lab}
        marks={dial.field === "launch.spin" ? marks : []}
      />
    ));
  const tops = Array.isArray(problem.body.shape) ? [TOP.at(-1)] : TOP;
  return (
    <div class="controls">
      <Choice
        name={t("controls.start")}
        value={known?.key ?? ""}
        options={[
          ["", t("controls.other")],
          ...PRESETS.map(({ key }) => [key, t(`presets.${key}`)]),
        ]}
        onChange={(key) => key && lab.go(PRESETS.find((one) => one.key === key).setup)}
      />
      {source && (
        <p class="source">
          {known.figure ? (
            <a href={known.figure} rel="noreferrer" title={t("presets.figure")}>
              {source}
            </a>
          ) : (
            source
          )}
        </p>
      )}
      {dials(MAIN)}
      <p class="prospect">
        {prospect?.ends?.length ? heading(prospect, units) : t("controls.unknown")}
        {[...told(marks, problem, units)].map((sentence) => ` ${sentence}`)}
      </p>
      <Choice
        name={t("controls.table")}
        value={table}
        options={[
          ["", t("tables.choose")],
          ...Object.keys(TABLES).map((key) => [key, t(`tables.${key}`)]),
        ]}
        onChange={(key) => key && lab.change({ friction: TABLES[key] })}
      />
      <Choice
        name={t("controls.law")}
        value={problem.friction.kind}
        options={LAWS.map((kind) => [kind, t(`laws.${kind}`)])}
        onChange={(kind) => lab.change({ "friction.kind": kind })}
      />
      {dials(LAW)}
      <Units lab={lab} />
      <details>
        <summary>{t("controls.more")}</summary>
        <Choice
          name={t("controls.liftoff")}
          value={problem.contact?.liftoff ?? "fly"}
          options={[
            ["fly", t("controls.fly")],
            ["stop", t("controls.stopRun")],
            ["ignore", t("controls.ignore")],
          ]}
          onChange={(liftoff) => lab.change({ "contact.liftoff": liftoff })}
        />
        {dials(TABLE)}
      </details>
      <details>
        <summary>{t("controls.top")}</summary>
        {dials(tops)}
      </details>
      <details>
        <summary>{t("controls.letGo")}</summary>
        {dials(START)}
      </details>
    </div>
  );
}

// What is wrong with a launch, in the page's words: which control, its value as the visitor reads it.
export function refusal(error, { units, setup }) {
  const field = error.field
    ? ALL.find((dial) => dial.field === error.field || dial.field.endsWith(`.${error.field}`))
        ?.field
    : null;
  if (!field)
    return { field: null, sentence: t("controls.refusedOther", { message: error.message }) };
  const dial = ALL.find((one) => one.field === field);
  const { name } = part(`quantities.${field}`);
  if (error.missing) return { field: null, sentence: t("controls.missing", { name }) };
  const scale = scaleOf(dial, setup);
  const value =
    typeof error.value === "number"
      ? shown(error.value / scale, kindOf(dial, setup), units)
      : t("controls.quoted", { text: error.value });
  return {
    field,
    sentence: t("controls.refused", {
      name,
      value,
      accepted: accepted(error.accepted, dial, scale, units),
    }),
  };
}

// Bounds as the engine says them are in SI; here they are told in the unit of the dial, and so that these are possible.
function accepted(text, { kind }, scale, units) {
  const unit = unitOf(kind, units),
    size = scale * unit.size;
  return translated(
    text.replace(BOUND, (whole, words, number) => {
      const bound = (number === "pi" ? Math.PI : Number(number)) / size;
      const told = digits(/least|greater|from/.test(words) ? above(bound) : -above(-bound));
      return `${words} ${number === "pi" ? withUnit(told, unit) : told}`;
    }),
  );
}

const BOUND =
  /(at least|greater than|from|at most|less than|to|=) (pi|\d+(?:\.\d+)?(?:e[-+]?\d+)?)(?![\w.]| I1)/g;

// A number of four digits that is no less, but for rounding.
function above(number) {
  const near = Number(number.toPrecision(4));
  return near >= number - 1e-12 * Math.abs(number)
    ? near
    : Number((near + 10 ** (Math.floor(Math.log10(Math.abs(number))) - 3)).toPrecision(4));
}
