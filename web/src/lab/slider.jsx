// A slider with its name and, beside it and for those who hear it, its value in words.

/** `range` has the least and the largest value and the step between values; `mark` is an attribute to find it by. */
export function NamedSlider({ name, text, range: [low, high, step], value, mark, onChange }) {
  return (
    <label class="named-slider">
      <span>
        {name} <b>{text}</b>
      </span>
      <input
        type="range"
        min={low}
        max={high}
        step={step}
        value={value}
        data-own={mark}
        aria-valuetext={text}
        onInput={(event) => onChange(Number(event.target.value))}
      />
    </label>
  );
}
