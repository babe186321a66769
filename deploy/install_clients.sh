#!/bin/sh
# Brings .clients/ to what clients.lock says: ground stations for the tests, apart from .venv/. Quick when nothing changed.
set -eu
want=$(sha256sum < clients.lock)
[ "$(cat .clients/installed 2>/dev/null || true)" = "$want" ] && exit 0
echo "installing the ground stations of the tests into .clients/ ..." >&2
rm -rf .clients
uv venv -q --python 3.11 .clients
# clients.lock is whole but for what clients.excludes leaves out, which must not be asked for here.
VIRTUAL_ENV="$PWD/.clients" uv pip install -q --no-deps --require-hashes -r clients.lock
echo "$want" > .clients/installed
