// A button that copies a text, and says that it did; where the browser lets nothing onto the clipboard, the text to copy.

import { useEffect, useRef, useState } from "preact/hooks";

import { t } from "./i18n.js";

// How long it is said that a text was copied, ms.
const SAID = 4000;

/** Put a text onto the clipboard; returns whether that was possible. */
export async function copyText(text) {
  try {
    await navigator.clipboard.writeText(text);
    return true;
  } catch {
    // Pages that do not come by https, such as those of a class room, have the older way alone.
    return copySelected(text);
  }
}

function copySelected(text) {
  const last = document.activeElement;
  const field = document.createElement("textarea");
  field.value = text;
  field.setAttribute("aria-hidden", "true");
  field.style.cssText = "position:fixed;opacity:0";
  document.body.append(field);
  field.select();
  let isCopied = false;
  try {
    isCopied = document.execCommand("copy");
  } catch {}
  field.remove();
  last?.focus({ preventScroll: true });
  return isCopied;
}

/** The button of that name; `text` returns what it copies, and `done` says that it did. */
export function Copy({ name, text, done = t("copy.done") }) {
  const [found, show] = useState(null);
  const waiting = useRef();
  useEffect(() => () => clearTimeout(waiting.current), []);
  const copy = async () => {
    const content = text();
    const isCopied = await copyText(content);
    show(isCopied ? { isCopied } : { content });
    clearTimeout(waiting.current);
    if (isCopied) waiting.current = setTimeout(() => show(null), SAID);
  };
  return (
    <>
      <button type="button" onClick={copy}>
        {name}
      </button>
      <span class="linked" role="status">
        {found?.isCopied && done}
        {found?.content !== undefined && (
          <label>
            {t("copy.here")}
            <input readOnly value={found.content} ref={(field) => field?.select()} />
          </label>
        )}
      </span>
    </>
  );
}
