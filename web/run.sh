#!/bin/sh
# Run a command with node and the npm packages of package.json: web/run.sh PYTHON COMMAND [ARGUMENT...]
# PYTHON looks for node; where the machine has none, it installs node from a wheel beside itself.
set -eu
python=$1
shift
exec "$python" "$(dirname "$0")/node_tools.py" "$@"
