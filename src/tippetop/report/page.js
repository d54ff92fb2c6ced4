// Plays the run on the page, once a reader comes to it.

const host = document.getElementById("stage");

async function start() {
  {
    {
      player.loader | safe;
    }
  }
  const player = createPlayer(host, { theme: "auto" });
  player.load(await unzip("run").arrayBuffer());
  globalThis.tippetopPlayer = player;
}

new IntersectionObserver(
  (seen, watch) => {
    if (!seen.some((one) => one.isIntersecting)) return;
    watch.disconnect();
    start().catch(
      (error) => (host.textContent = `The run cannot be played here: ${error.message}`),
    );
  },
  { rootMargin: "600px" },
).observe(host);
