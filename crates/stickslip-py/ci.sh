#!/usr/bin/env bash
# Builds the wheel, installs it into a virtual environment of its own, and runs the Python tests with it. Sets up all it needs.
#   ci.sh [PROFILE] [write]    PROFILE: dev (the default) or release; write: writes what follows from the schema, the options of `plot` and docstrings
#                              (written.py), and runs and stores the notebooks, instead of testing
set -euo pipefail
cd "$(dirname "$0")"
profile=${1:-dev}
target=$(cd ../.. && pwd)/target
venv=$target/python
[ -x "$venv/bin/python" ] || python3 -m venv "$venv"
"$venv/bin/pip" install --quiet --disable-pip-version-check \
    'maturin>=1.7,<2' numpy pytest mypy pyvista meshio matplotlib pandas tqdm rich
rm -rf "$target/wheels"
# Tests are small: in the dev profile the library need not be optimised, which takes a minute instead of five.
fast=()
if [ "$profile" = dev ]; then
    for crate in stickslip stickslip-base stickslip-mechanics; do
        fast+=(--config "profile.dev.package.$crate.opt-level=0" --config "profile.dev.package.$crate.debug=false")
    done
fi
"$venv/bin/maturin" build --profile "$profile" --out "$target/wheels" --quiet "${fast[@]}"
"$venv/bin/pip" install --quiet --disable-pip-version-check --force-reinstall --no-deps "$target"/wheels/stickslip-*.whl
if [ "${2:-}" = write ]; then
    # Twice: the page of the book is of the package that is installed, with the options that the first run has written.
    "$venv/bin/python" written.py
    cp python/stickslip/*.py "$("$venv/bin/python" -c 'import os, stickslip; print(os.path.dirname(stickslip.__file__))')"
    "$venv/bin/python" written.py
    "$venv/bin/pip" install --quiet --disable-pip-version-check nbclient ipykernel
    PATH=$venv/bin:$PATH exec "$venv/bin/python" notebooks/store.py
fi
PATH=$venv/bin:$PATH "$venv/bin/python" -m pytest --quiet
