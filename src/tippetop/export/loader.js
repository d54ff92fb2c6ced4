// Unpacks what a page holds as text: gzip in base64, in elements with an id.

function unzip(id) {
  const text = atob(document.getElementById(id).textContent);
  const zipped = Uint8Array.from(text, (character) => character.charCodeAt(0));
  return new Response(new Blob([zipped]).stream().pipeThrough(new DecompressionStream("gzip")));
}

async function importPlayer() {
  const code = new Blob([await unzip("player-code").text()], { type: "text/javascript" });
  return import(URL.createObjectURL(code));
}
