// Plays the run on the page, once a reader comes to it. What stands before this are the player's modules.

const host = document.getElementById("stage");
const text = (id) => document.getElementById(id).textContent;

async function start() {
  const three = await importText(new TextDecoder().decode(await unzip(text("three"))));
  const player = createPlayer(three, host, { theme: "auto" });
  player.load(await unzip(text("run")));
  globalThis.tippetopPlayer = player;
}

new IntersectionObserver((seen, watch) => {
  if (!seen.some((one) => one.isIntersecting)) return;
  watch.disconnect();
  start().catch((error) => (host.textContent = `The run cannot be played here: ${error.message}`));
}, { rootMargin: "600px" }).observe(host);
