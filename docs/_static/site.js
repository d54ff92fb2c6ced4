// The site's own script: frames take over the theme that is chosen by hand, and code can be copied.

const root = document.documentElement;
const frames = () => document.querySelectorAll("figure.player iframe");
const tell = (frame) => frame.contentWindow.postMessage({ tippetopTheme: root.dataset.theme }, "*");

function followTheme() {
  for (const frame of frames()) {
    frame.addEventListener("load", () => tell(frame));
    tell(frame);
  }
  new MutationObserver(() => frames().forEach(tell)).observe(root, {
    attributeFilter: ["data-theme"],
  });
}

// Prompts of examples, and what they print, are no part of what is copied.
function codeOf(block) {
  const lines = block.textContent.trimEnd().split("\n");
  const typed = lines.filter((line) => /^(>>>|\.\.\.)( |$)/.test(line));
  return (typed.length ? typed.map((line) => line.slice(4)) : lines).join("\n");
}

async function copy(text) {
  if (navigator.clipboard) return navigator.clipboard.writeText(text);
  // Without https there is no clipboard but this.
  const field = Object.assign(document.createElement("textarea"), { value: text });
  document.body.append(field);
  field.select();
  const isCopied = document.execCommand("copy");
  field.remove();
  if (!isCopied) throw new Error("nothing was copied");
}

function addButton(block) {
  const button = Object.assign(document.createElement("button"), {
    type: "button",
    className: "copy",
    textContent: "Copy",
  });
  button.addEventListener("click", async () => {
    button.textContent = await copy(codeOf(block)).then(
      () => "Copied",
      () => "Not copied",
    );
    setTimeout(() => {
      button.textContent = "Copy";
    }, 2000);
  });
  block.closest("div.highlight").append(button);
}

addEventListener("DOMContentLoaded", () => {
  followTheme();
  for (const block of document.querySelectorAll(
    "div.highlight:not(.cell_output div.highlight) > pre",
  ))
    addButton(block);
});
