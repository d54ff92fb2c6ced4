// A control of the launch: a name with its meaning, a slider and a number, in the visitor's units.

import { useState } from "preact/hooks";

import { kindOf, placeOf, scaleOf, valueAt } from "./dials.js";
import { decimal, part } from "./i18n.js";
import { fieldValue } from "./setup.js";
import { typed } from "./typed.js";
import { shown, unitOf } from "./units.js";

export function Why({ name, text }) {
  const [open, setOpen] = useState(false);
  return (
    <>
      <button
        type="button"
        class="why"
        aria-expanded={open}
        aria-label={`? ${name}`}
        onClick={() => setOpen(!open)}
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

export function Dial({ dial, lab, marks = [] }) {
  const { setup, units, trouble } = lab.state;
  const value = fieldValue(setup, dial.field);
  if (value === undefined || value === null) return null;
  const { name, symbol, help } = part(`quantities.${dial.field}`);
  const { name: unit } = unitOf(kindOf(dial, setup), units);
  const label = `${name} ${symbol}${unit ? ` (${unit})` : ""}`;
  const id = `dial-${dial.field.replaceAll(".", "-")}`;
  const refused = trouble?.field === dial.field;
  return (
    <div class={`dial ${refused ? "wrong" : ""}`}>
      <span class="dial-name">
        <label for={id}>{label}</label>
        <Why name={name} text={help} />
      </span>
      <NumberField dial={dial} lab={lab} value={value} label={label} refused={refused && id} />
      <Slider dial={dial} lab={lab} value={value} id={id} marks={marks} />
      {refused && (
        <p class="refused" id={`${id}-wrong`} role="alert">
          {trouble.sentence}
        </p>
      )}
    </div>
  );
}

// The value as a number to type; `refused` is the id of a control whose value is refused.
function NumberField({ dial, lab, value, label, refused }) {
  const [typed, setTyped] = useState(null);
  const { setup, units } = lab.state;
  const size = scaleOf(dial, setup) * unitOf(kindOf(dial, setup), units).size;
  const commit = (input) => {
    setTyped(null);
    lab.change({ [dial.field]: entered(input, size) });
  };
  return (
    <input
      class="dial-number"
      type="text"
      inputMode="decimal"
      aria-label={label}
      value={typed ?? textOf(value, size)}
      aria-invalid={Boolean(refused)}
      aria-describedby={refused ? `${refused}-wrong` : undefined}
      onInput={(event) => setTyped(event.target.value)}
      onBlur={(event) => typed !== null && commit(event.target.value)}
      onKeyDown={(event) => event.key === "Enter" && commit(event.target.value)}
    />
  );
}

function textOf(value, size) {
  if (typeof value !== "number") return String(value);
  return decimal(String(Number((value / size).toPrecision(4))));
}

// What was entered in SI; with a unit, as the launch takes it; as it stands where it is no number, to be refused.
function entered(input, size) {
  const { number, unit } = typed(input);
  if (number === null) return input;
  return unit ? `${number} ${unit}` : number * size;
}

function Slider({ dial, lab, value, id, marks }) {
  const { setup, units } = lab.state;
  const scale = scaleOf(dial, setup);
  const low = placeOf(dial, dial.low);
  const high = placeOf(dial, dial.high);
  const share = (one) => (100 * (placeOf(dial, one) - low)) / (high - low);
  const slide = (event) => {
    lab.change({ [dial.field]: valueAt(dial, Number(event.target.value)) * scale }, true);
  };
  return (
    <div class="dial-slide">
      <input
        id={id}
        type="range"
        min={low}
        max={high}
        step={dial.step}
        value={placeOf(dial, value / scale)}
        data-field={dial.field}
        aria-valuetext={shown(value / scale, kindOf(dial, setup), units)}
        onInput={slide}
        onChange={() => lab.settle(true)}
      />
      {marks.length > 0 && (
        <div class="dial-marks" aria-hidden="true">
          {marks.map(({ name, value: at }) => (
            <span style={`left:${share(at)}%`}>
              {name[0]}
              <sub>{name.slice(2)}</sub>
            </span>
          ))}
        </div>
      )}
    </div>
  );
}
