// What shows a run elsewhere: the file that plays offline, the report's page, the notebook.

import { createPlayer, stillness } from "./player.js";
import { followTheme } from "./theme.js";

export { createPlayer, followTheme, stillness };

function render({ model, el }) {
  const host = document.createElement("div");
  const resize = () => {
    host.style.height = `${model.get("height")}px`;
  };
  resize();
  el.append(host);
  const player = createPlayer(host, { theme: model.get("theme") });
  const show = () => {
    const view = model.get("track");
    player.load(new Uint8Array(view.buffer, view.byteOffset, view.byteLength).slice().buffer);
  };
  const paint = () => player.setTheme(model.get("theme"));
  const changes = { "change:track": show, "change:height": resize, "change:theme": paint };
  for (const [change, call] of Object.entries(changes)) model.on(change, call);
  show();
  return () => {
    for (const [change, call] of Object.entries(changes)) model.off(change, call);
    player.dispose();
    host.remove();
  };
}

// A notebook's widget, as anywidget takes it.
export default { render };
