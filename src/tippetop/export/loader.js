const unzip = (id) => {
  const zipped = Uint8Array.from(atob(document.getElementById(id).textContent), (c) =>
    c.charCodeAt(0),
  );
  return new Response(new Blob([zipped]).stream().pipeThrough(new DecompressionStream("gzip")));
};
const code = new Blob([await unzip("player-code").text()], { type: "text/javascript" });
const { createPlayer, stillness } = await import(URL.createObjectURL(code));
