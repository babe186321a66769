#!/bin/sh
# Brings .venv/ to what requirements.lock says. Called by every recipe; silent and quick when nothing changed.
set -eu
want=$(cat requirements.lock pyproject.toml | sha256sum)
[ "$(cat .venv/r2x-installed 2>/dev/null || true)" = "$want" ] && exit 0
echo "installing the pinned packages into .venv/ ..." >&2
[ -x .venv/bin/python ] || uv venv -q --python 3.11 .venv || {
    echo "R2X needs Python 3.11: install it (python3.11 with pip) and run this again" >&2
    exit 1
}
VIRTUAL_ENV="$PWD/.venv" uv pip install -q --require-hashes -r requirements.lock
.venv/bin/rerun analytics disable >/dev/null 2>&1 || true
echo "$want" > .venv/r2x-installed
