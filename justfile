# R2X: a building's cameras, drones and ground robots as one team. `./justw` lists what there is.

set positional-arguments
set quiet
set no-exit-message

python := justfile_directory() / ".venv/bin/python"
export PYTHONPATH := justfile_directory()
export PYTHONPYCACHEPREFIX := justfile_directory() / ".venv/bytecode"

[private]
default:
    just --list --unsorted

# everything from nothing: install, bring the mesh up, do one instruction, write out/demo/ (--seed N, --json, --keep)
[group('start here')]
demo *args: install
    exec {{ python }} -m console demo "$@"

# lint, types, import rules and all tests
[group('start here')]
test *args: install
    ./deploy/install_clients.sh
    {{ python }} -m ruff check .
    {{ python }} -m ruff format --check .
    {{ python }} -m mypy
    .venv/bin/lint-imports --no-logo
    {{ python }} -m pytest -m "not walk" -n auto --dist loadfile "$@"
    {{ python }} -m pytest -m walk "$@"

# fetch the pinned packages into .venv/ (done by every recipe that needs them)
[group('start here')]
install:
    ./deploy/install.sh

# start a site's mesh under supervision (default: a generated home; --seed N, --port N)
[group('mesh')]
up *args: install
    exec {{ python }} -m console up "$@"

# stop the mesh
[group('mesh')]
down *args: install
    exec {{ python }} -m console down "$@"

# what the site needs of this machine and has not: doctor [SITE] (--load, --json)
[group('mesh')]
doctor *args: install
    exec {{ python }} -m console doctor "$@"

# which processes run, and are they well (--json)
[group('mesh')]
status *args: install
    exec {{ python }} -m console status "$@"

# what processes say: logs [NAME] [-f] (--json)
[group('mesh')]
logs *args: install
    exec {{ python }} -m console logs "$@"

# restart one process: restart NAME
[group('mesh')]
restart *args: install
    exec {{ python }} -m console restart "$@"

# say what is to be done, in plain words; waits and shows progress (--json)
[group('operate')]
task *args: install
    exec {{ python }} -m console task "$@"

# where is it believed to be, who said so, when, how sure (--json)
[group('operate')]
why *args: install
    exec {{ python }} -m console why "$@"

# halt every robot and cancel all tasks
[group('operate')]
stop *args: install
    exec {{ python }} -m console stop "$@"

# halt the robots, keep the tasks
[group('operate')]
pause *args: install
    exec {{ python }} -m console pause "$@"

# go on after a pause
[group('operate')]
resume *args: install
    exec {{ python }} -m console resume "$@"

# cancel one task: cancel TASK
[group('operate')]
cancel *args: install
    exec {{ python }} -m console cancel "$@"

# the fused world, live in a browser (prints the address) or in a window where there is a display (--json)
[group('watch')]
view *args: install
    exec {{ python }} -m console view "$@"

# record what the view shows: record FILE.rrd (--json)
[group('watch')]
record *args: install
    exec {{ python }} -m console record "$@"

# what a task has cost the language model, call by call: tokens [TASK] (--json)
[group('watch')]
tokens *args: install
    exec {{ python }} -m console tokens "$@"

# a simulated drone for any MAVLink client: sitl --firmware ardupilot|px4 (--vehicles N, --gps none, --scene home:7)
[group('fly')]
sitl *args: install
    exec {{ python }} -m sim.sitl "$@"

# list the site files there are; `up NAME` starts one (--json)
[group('sites')]
sites *args: install
    exec {{ python }} -m console sites "$@"

# write the site file of a generated home: home --seed N --out FILE (--fault, --smart-appliances)
[group('sites')]
home *args: install
    exec {{ python }} -m sim.generator "$@"

# measure what the machine does: fusion, latency, physics, cameras, memory, presence (--json)
[group('measure')]
perf *args: install
    exec {{ python }} -m bench.perf "$@"

# the embedded detector's precision, recall, position error and state accuracy on held-out houses
[group('measure')]
measure-detector *args: install
    exec {{ python }} -m sim.training.measure "$@"

# places read with and without GridMask, by the detector and by a vision model: (--model NAME, --pictures N, --json)
[group('measure')]
gridmask-eval *args: install
    exec {{ python }} -m bench.gridmask "$@"

# labelled pictures with GridMask, seeded, for tuning a vision model: gridmask-data N --out DIR (--seed N)
[group('measure')]
gridmask-data *args: install
    exec {{ python }} -m sim.training.cubes.dataset "$@"

# the demo on many seeds: success, steps, path for each (--seeds 0-19)
[group('measure')]
demo-seeds *args: install
    exec {{ python }} -m console demo-seeds "$@"

# a stand-in for Ollama, without a model, for rehearsals: ollama-double --port 11434 (--scenario busy,ok, --dial NAME=RATE)
[group('develop')]
ollama-double *args: install
    exec {{ python }} -m tests.ollama_double "$@"

# what R2X relies on, asked of your own Ollama server: R2X_OLLAMA=1 ./justw test-ollama
[group('develop')]
test-ollama *args: install
    {{ python }} -m pytest -s -v tests/planners/test_ollama_contract.py "$@"

# experiments: bench reasoning compares planners over a model's error rate (--json FILE, --host URL --model NAME)
[group('measure')]
bench *args: install
    exec {{ python }} -m bench "$@"

# format the tree and rewrite the generated pages
[group('develop')]
fmt: install
    {{ python }} -m ruff check --fix .
    {{ python }} -m ruff format .
    {{ python }} -m wire.protocol_page docs/protocol.md
    {{ python }} -m deploy.notice

# renew requirements.lock from pyproject.toml, and clients.lock from clients.in
[group('develop')]
lock:
    uv pip compile -q --python-version 3.11 --python-platform x86_64-manylinux_2_28 --generate-hashes \
        --no-header --no-annotate --no-emit-index-url --extra all --extra bench --extra dev pyproject.toml -o requirements.lock
    uv pip compile -q --python-version 3.11 --python-platform x86_64-manylinux_2_28 --generate-hashes \
        --no-header --no-annotate --no-emit-index-url --excludes clients.excludes clients.in -o clients.lock
