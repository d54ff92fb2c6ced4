// Builds what the package ships: the player of runs as one module, and the laboratory as one page.

import { mkdir, readFile, writeFile } from "node:fs/promises";
import { fileURLToPath } from "node:url";
import { deflateRawSync } from "node:zlib";
import { build } from "esbuild";
import { checkedLicences, noticeOf, packagesOf } from "./notices.mjs";

const HERE = new URL(".", import.meta.url);
const OUT = new URL("../src/tippetop/export/built/", HERE);
const ENGINE = process.env.ENGINE ?? "../src/tippetop/page_engine/index.js";

const COMMON = {
  absWorkingDir: fileURLToPath(HERE),
  bundle: true,
  minify: true,
  write: false,
  outdir: "out",
  metafile: true,
  legalComments: "none", // instead of them, the whole licences: see notices.mjs
  target: "es2022",
  charset: "utf8",
  logLevel: "warning",
  jsx: "automatic",
  jsxImportSource: "preact",
  alias: {
    engine: fileURLToPath(new URL(ENGINE, HERE)),
    "engine-tables": fileURLToPath(new URL("tables.js", new URL(ENGINE, HERE))),
    "engine-units": fileURLToPath(new URL("units.js", new URL(ENGINE, HERE))),
  },
};

async function bundled(entry, options) {
  const { outputFiles, warnings, metafile } = await build({
    ...COMMON,
    entryPoints: [entry],
    ...options,
  });
  if (warnings.length) throw new Error(`${entry}: esbuild warns, see above`);
  const text = (ending) => outputFiles.find(({ path }) => path.endsWith(ending))?.text ?? "";
  return { script: text(".js"), style: text(".css"), metafile };
}

// Makes the code of the workers, which a page from a file can start from its own text only, a module: packed.
function workers(code) {
  const contents = deflateRawSync(code, { level: 9 }).toString("base64");
  return {
    name: "workers",
    setup({ onResolve, onLoad }) {
      onResolve({ filter: /^worker-code$/ }, ({ path }) => ({ path, namespace: "workers" }));
      onLoad({ filter: /.*/, namespace: "workers" }, () => ({ contents, loader: "text" }));
    },
  };
}

async function put(name, text) {
  await writeFile(new URL(name, OUT), text);
  console.log(`${name}: ${(Buffer.byteLength(text) / 1024).toFixed(0)} KiB`);
}

const player = await bundled("src/player/index.js", { format: "esm" });
const worker = await bundled("src/lab/worker.js", { format: "iife" });
const page = await bundled("src/lab/main.jsx", {
  format: "esm",
  plugins: [workers(worker.script)],
});
const ofPage = packagesOf(page.metafile, worker.metafile);
const ofPlayer = packagesOf(player.metafile);
const licences = await checkedLicences([...new Set([...ofPlayer, ...ofPage])]);

await mkdir(OUT, { recursive: true });
await put("player.js", `/*!\n${noticeOf(ofPlayer, licences)}\n*/\n${player.script}`);
const template = await readFile(new URL("src/lab/page.html", HERE), "utf8");
await put(
  "lab.html",
  template
    .replace("%STYLE%", () => page.style)
    .replace("%SCRIPT%", () => page.script)
    .replace("%NOTICES%", () => noticeOf(ofPage, licences)),
);
