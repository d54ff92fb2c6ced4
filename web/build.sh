#!/bin/sh
# Build what runs in browsers: web/build.sh PYTHON, as run.sh takes it.
set -eu
web=$(dirname "$0")
exec "$web/run.sh" "${1-python3}" node "$web/build.mjs"
