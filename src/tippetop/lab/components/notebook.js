// The player in a notebook. It follows the player's code and the text of three.js, in one module.

async function three() {
  globalThis.tippetopThree ??= unzip(THREE_PACKED).then((bytes) => importText(new TextDecoder().decode(bytes)));
  return globalThis.tippetopThree;
}

async function render({ model, el }) {
  const host = document.createElement("div");
  const resize = () => (host.style.height = `${model.get("height")}px`);
  resize();
  el.append(host);
  const player = createPlayer(await three(), host, { theme: model.get("theme") });
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

export default { render };
