// Plays the run on the page, once a reader comes to it.

const host = document.getElementById("stage");

async function start() {
  const { createPlayer } = await importPlayer();
  const player = createPlayer(host, { theme: "auto" });
  player.load(await unzip("run").arrayBuffer());
  globalThis.tippetopPlayer = player;
}

function showError(error) {
  host.textContent = `The run cannot be played here: ${error.message}`;
}

new IntersectionObserver(
  (seen, watch) => {
    if (!seen.some((one) => one.isIntersecting)) return;
    watch.disconnect();
    start().catch(showError);
  },
  { rootMargin: "600px" },
).observe(host);
