# `make demo` needs Python 3.11 or later and nothing else; every other target sets itself up in the same way.
PYTHON ?= python3
JOBS ?= auto
STUDY ?= bevly-1997
VENV := .venv
BIN := $(VENV)/bin
STAMP := $(VENV)/.installed
RUN_STAMP := $(VENV)/.installed-to-run
LOCKED := $(shell command -v flock >/dev/null 2>&1 && echo "flock $(VENV)/.lock")

# Many small matrices: the threads of BLAS only get in each other's way.
export OPENBLAS_NUM_THREADS := 1
export PIP_DISABLE_PIP_VERSION_CHECK := 1

.DEFAULT_GOAL := help
.PHONY: help setup demo test slow bounds long lint types architecture check bench study docs dist versions lowest lock clean

help:  ## list the targets
	@grep -hE '^[a-z]+:.*##' Makefile | sed -E 's/:.*## /\t/' | expand -t 14

setup: $(STAMP)  ## make .venv and install Clamber and all that its tests and documentation need, once per change of the requirements

# Under a lock, and looking again inside it, so that two runs in one tree don't install over each other.
# $(1): the requirements, $(2): the stamps to set.
define install
	@$(PYTHON) -c 'import sys; sys.exit(sys.version_info < (3, 11))' || \
		{ echo "Clamber needs Python 3.11 or later; $(PYTHON) is older: make PYTHON=python3.11 ..." >&2; exit 1; }
	@mkdir -p $(VENV)
	@$(LOCKED) sh -eu -c '\
		if [ -e $@ ] && [ ! $(1) -nt $@ ] && [ ! pyproject.toml -nt $@ ]; then exit 0; fi; \
		[ -x $(BIN)/python ] || $(PYTHON) -m venv $(VENV); \
		echo "installing into $(VENV) (a minute or two, once)"; \
		$(BIN)/python -m pip install --quiet --require-hashes -r $(1); \
		$(BIN)/python -m pip install --quiet --no-deps --no-build-isolation -e .; \
		touch $(2)'
endef

$(STAMP): requirements.txt pyproject.toml
	$(call install,requirements.txt,$(STAMP) $(RUN_STAMP))

# A user's part of it: less than half to fetch.
$(RUN_STAMP): requirements-run.txt pyproject.toml
	$(call install,requirements-run.txt,$(RUN_STAMP))

demo: $(RUN_STAMP)  ## plan a climb up the ladder and one up a wall in space, climb both in contact dynamics, draw them
	@mkdir -p out
	$(BIN)/clamber run ladder --peg-error 3mm --save-plan out/ladder.json -o out/climb.gif -o out/climb.mcap > out/climb.txt \
		|| { cat out/climb.txt; exit 1; }
	@cat out/climb.txt
	$(BIN)/clamber check out/ladder.json
	$(BIN)/clamber show out/ladder.json -o out/ladder.png
	$(BIN)/clamber run wall-gripper --save-plan out/wall.json -o out/wall.gif -o out/wall.mcap > out/wall.txt || { cat out/wall.txt; exit 1; }
	@cat out/wall.txt
	@echo "Look at out/climb.gif (the climb as it was), out/climb.txt (what became of every action), out/climb.mcap (its log),"
	@echo "out/ladder.png (the plan in one picture) and out/ladder.json (the plan); out/wall.* are the same of a robot in space."

test: setup  ## fast tests
	$(BIN)/python -m pytest -n $(JOBS) -m "not slow and not long"

slow: setup  ## tests that take seconds each: whole runs, commands of the pages, kernels compiled anew
	$(BIN)/python -m pytest -n $(JOBS) --dist worksteal --durations 25 -m slow

# Compiling takes most of the time, so a few tests of every folder with kernels. Left out: rivals and reach maps, which share `step` and
# `candidates` with the planners, climbs and walks in the plane, whose kernels are those of control, and all that compares speed.
BOUNDED := tests/actions/test_plan.py tests/actions/test_walker.py tests/statics tests/planning/test_planning.py tests/planning/test_exact.py \
	tests/planning/test_exact_costs.py tests/planning/test_crafted_files.py tests/control/test_body.py tests/control/test_laws.py \
	tests/control/test_hook_forces.py tests/control/test_load_shares.py tests/control/test_gait.py tests/control/test_identification.py \
	tests/control/cooperative tests/control/whole_body tests/sim/test_ode_limb.py tests/sim/test_walker_plant.py \
	tests/spatial/test_space_plans.py tests/spatial/test_space_proofs.py tests/spatial/test_lifted_paths.py \
	tests/spatial/test_spatial_terrain.py tests/spatial/test_whole_body_laws.py tests/spatial/test_estimate.py \
	tests/spatial/test_spatial_plant.py tests/spatial/test_break_away.py tests/spatial/test_carrying.py tests/spatial/test_space_faults.py

bounds: setup  ## tests of kernels with every index checked, the end of `make long`
	CLAMBER_BOUNDSCHECK=1 $(BIN)/python -m pytest -n $(JOBS) --dist worksteal --durations 10 -m "not long" $(BOUNDED)

long: setup  ## the longest tests: searches, tunings and thousands of cases that take tens of seconds and more each
	$(BIN)/python -m pytest -n $(JOBS) --dist worksteal --durations 25 -m long
	$(MAKE) bounds

lint: setup  ## format and lint
	$(BIN)/ruff format --check .
	$(BIN)/ruff check .

types: setup  ## mypy --strict
	$(BIN)/mypy --strict src

architecture: setup  ## who may import whom
	$(BIN)/python -m pytest -q tests/test_architecture.py

check: lint types architecture test  ## all that a change has to pass

bench: setup  ## speed and success beside DEAP, pymoo and pygad
	$(BIN)/clamber bench plan

study: setup  ## one paper's results, ours beside the printed ones: make study STUDY=name
	$(BIN)/clamber study $(STUDY)

docs: setup  ## the documentation as a site: out/docs/index.html
	$(BIN)/sphinx-build -q -W --keep-going -b html docs out/docs
	@echo "Open out/docs/index.html"

dist: setup  ## wheel, sdist and bill of materials, in dist/
	rm -rf dist
	$(BIN)/python -m build --no-isolation --outdir dist .
	$(BIN)/python release/bom.py -o dist/clamber-$$($(BIN)/python -c 'import clamber; print(clamber.__version__)').cdx.json

# What is run: TESTS="tests/test_specs.py tests/robots" runs a part of it.
TESTS ?= tests
PYTHONS ?= 3.11 3.12 3.13

versions:  ## the fast tests on each Python that is supported, with the locked requirements
	$(PYTHON) release/versions.py locked $(PYTHONS) -- -m "not slow and not long" $(TESTS)

lowest:  ## the fast tests with the lowest versions that pyproject.toml allows, on the lowest Python
	$(PYTHON) release/versions.py lowest $(firstword $(PYTHONS)) -- -m "not slow and not long and not locked" $(TESTS)

# The lock file carries hashes and no address of a package index.
COMPILE := $(BIN)/pip-compile --quiet --allow-unsafe --generate-hashes --strip-extras --no-header --no-emit-index-url --no-emit-find-links \
	--no-emit-trusted-host --no-emit-options

lock: setup  ## renew requirements.txt and requirements-run.txt after a change of the dependencies in pyproject.toml
	$(COMPILE) --extra dev --extra docs --extra view --extra bench --extra video --extra ray --extra gym -o requirements.txt pyproject.toml
	$(COMPILE) --extra view --extra video --build-deps-for editable -c requirements.txt -o requirements-run.txt pyproject.toml

clean:  ## remove what the targets made, except .venv
	rm -rf out build dist .pytest_cache .mypy_cache .ruff_cache .hypothesis
