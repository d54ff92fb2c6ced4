// Licences of the npm packages that the bundles contain. `notices.txt` has the licence of each package, and bundles begin
// or end with the licences of theirs.

import { readdir, readFile } from "node:fs/promises";

const HERE = new URL(".", import.meta.url);
const HEADING = /^=== (\S+) ===\n/m;
const LICENCE = /^licen[cs]e(\.(md|txt))?$/i;

/** Returns the names of the npm packages among the inputs of esbuild's metafiles, sorted. */
export function packagesOf(...metafiles) {
  const inputs = metafiles.flatMap(({ inputs }) => Object.keys(inputs));
  const found = inputs.map((path) => /.*node_modules\/((?:@[^/]+\/)?[^/]+)\//.exec(path)?.[1]);
  return [...new Set(found.filter(Boolean))].sort();
}

/** Returns the licences in a text, by the names of the packages in its headings. */
export function licencesIn(text) {
  const [, ...parts] = text.split(HEADING);
  const names = parts.filter((_, place) => place % 2 === 0);
  return new Map(names.map((name, place) => [name, parts[2 * place + 1].trim()]));
}

/** Returns the notice of some packages; throws if one has no licence among those of a text. */
export function noticeOf(packages, licences) {
  for (const name of packages) {
    if (!licences.has(name)) {
      throw new Error(`web/notices.txt has no licence of ${name}, which is bundled: add it there`);
    }
  }
  return packages.map((name) => `=== ${name} ===\n\n${licences.get(name)}`).join("\n\n");
}

/** Throws unless the licences are those of the bundled packages, each as the package has it. */
export function requireLicences(packages, licences, installed) {
  noticeOf(packages, licences);
  for (const [name, licence] of licences) {
    if (!packages.includes(name)) {
      throw new Error(`web/notices.txt has a licence of ${name}, which is not bundled: remove it`);
    }
    if (installed.get(name) !== licence) {
      throw new Error(`web/notices.txt has another licence of ${name} than the package: renew it`);
    }
  }
}

/** Returns the licences in `notices.txt`, once they are compared with those in `node_modules`. */
export async function checkedLicences(packages) {
  const licences = licencesIn(await readFile(new URL("notices.txt", HERE), "utf8"));
  const installed = new Map();
  for (const name of packages) {
    const folder = new URL(`node_modules/${name}/`, HERE);
    const file = (await readdir(folder)).find((entry) => LICENCE.test(entry));
    if (!file) throw new Error(`the npm package ${name} has no file with its licence`);
    const text = await readFile(new URL(file, folder), "utf8");
    installed.set(name, text.replaceAll("\r\n", "\n").trim());
  }
  requireLicences(packages, licences, installed);
  return licences;
}
