// The player in a notebook. It follows the player's code and the text of three.js, in one module.

async function three() {
  globalThis.tippetopThree ??= unzip(THREE_PACKED).then((bytes) => importText(new TextDecoder().decode(bytes)));
  return globalThis.tippetopThree;
}

async function render({ model, el }) {
  const host = document.createElement("div");
  host.style.height = `${model.get("height")}px`;
  el.append(host);
  const player = createPlayer(await three(), host, { theme: model.get("theme") });
  const show = () => {
    const view = model.get("track");
    player.load(new Uint8Array(view.buffer, view.byteOffset, view.byteLength).slice().buffer);
  };
  model.on("change:track", show);
  show();
  return () => {
    model.off("change:track", show);
    player.dispose();
  };
}

export default { render };
