# Glanz: set up, render, test, build. Needs git, make and Python >= 3.11 with venv and pip; everything else comes into .venv.
#
#   PYTHON=python3.13 make test    with another Python, in .venv-3.13
#   BPY=4.2.23 make test           with another Blender (4.2, 4.5, 5.0 on Python 3.11; 5.2 on 3.13); BPY=none: without

ifeq ($(origin PYTHON), undefined)
PYTHON := python3
VENV := .venv
endif
VERSION := $(shell $(PYTHON) -c 'import sys; print("%d.%d" % sys.version_info[:2])')
VENV ?= .venv-$(VERSION)
ifdef BPY
VENV := $(VENV)-bpy-$(BPY)
EXTRAS := cli,test,bench
else
EXTRAS := cli,test,bench,blender
endif
ifneq ($(filter-out none,$(BPY)),)
BLENDER := bpy==$(BPY)
# Blender brings NumPy 1.26 up to 5.0; the wheels of 4.x do not say so.
ifneq ($(filter 4.%,$(BPY)),)
BLENDER += 'numpy<2'
endif
endif

READY := $(VENV)/.ready-$(VERSION)
RUN := $(VENV)/bin/python
# A process for each core, which takes over from others what they have still to do. One that crashes fails the test it was at.
PYTEST := $(RUN) -m pytest --numprocesses auto --dist worksteal

.DEFAULT_GOAL := help
.PHONY: help setup render test test-thorough test-addon test-matrix desktop-test bench bench-growth bench-targets bench-peers bench-presets gallery nodes closures support extension extension-linux lint clean distclean

help:
	@echo "make render           render sample_scenes/cornell_box.blend to out/"
	@echo "make test             run all tests"
	@echo "make test-matrix      run what needs Blender in Blender 4.2, 4.5, 5.0 and 5.2"
	@echo "make desktop-test     try Glanz in a Blender with a window: BLENDER=/path/to/blender make desktop-test"
	@echo "make test-thorough    draw many new examples and random numbers for tests of laws, within an hour; GLANZ_SEED=... draws the same again"
	@echo "make bench            measure speed against Cycles"
	@echo "make bench-growth     measure how time and memory grow with pixels, triangles, lights, threads, ...; GROWTH=--quick in a minute"
	@echo "make bench-targets    measure whether error targets are reached, in a night; TARGETS=--quick in two minutes"
	@echo "make bench-peers      measure time and error against Cycles and Mitsuba, in half an hour; PEERS=--quick in five minutes"
	@echo "make bench-presets    measure what the presets cost and are worth on the sample scenes, in an hour; PRESETS=--quick in minutes"
	@echo "make nodes            compare every node with Cycles for docs/nodes.md"
	@echo "make closures         compare every shader with Cycles for docs/closures.md"
	@echo "make support          write docs/support.md, what of Blender is rendered and how; with the newest Blender last"
	@echo "make gallery          render the pictures of docs/gallery.md"
	@echo "make extension        build the Blender extension for every platform in dist/"
	@echo "make extension-linux  build it for Linux only"
	@echo "make lint             check the style"
	@echo "make clean            remove what was built; make distclean: the environments and wheels too"

setup: $(READY)

# The stamp comes last, so a set-up that failed is done again.
$(READY): pyproject.toml tools/check_bpy.py
	@test -n "$(VERSION)" || { echo "glanz: '$(PYTHON)' does not run; give another, as in: PYTHON=python3.13 make $(MAKECMDGOALS)" >&2; exit 1; }
	@$(PYTHON) -c 'import sys; sys.exit(sys.version_info < (3, 11))' || { echo "glanz: Python $(VERSION) is too old, 3.11 or newer is needed" >&2; exit 1; }
	@rm -f $(VENV)/.ready-*
	@test "$$($(RUN) -c 'import pip, sys; print("%d.%d" % sys.version_info[:2])' 2>&1)" = "$(VERSION)" || $(PYTHON) -m venv --clear $(VENV) \
		|| { echo "glanz: no virtual environment; on Debian or Ubuntu: sudo apt-get install python3-venv" >&2; exit 1; }
	$(RUN) -m pip install --disable-pip-version-check --editable ".[$(EXTRAS)]" $(BLENDER)
	@$(RUN) tools/check_bpy.py
	@touch $@

render: $(READY)
	@mkdir -p out
	$(VENV)/bin/glanz render sample_scenes/cornell_box.blend -o out/cornell_box.exr -o out/cornell_box.png

test: $(READY)
	$(PYTEST)

test-addon: $(READY)
	$(PYTEST) tests/addon tests/cli tests/packaging

test-matrix:
	@$(PYTHON) tools/test_matrix.py

desktop-test: $(READY)
	@platform=$$($(RUN) tests/desktop/run.py --platform) && $(RUN) tools/build_extension.py $$platform && $(RUN) tests/desktop/run.py $(SCRIPTS)

test-thorough: $(READY)
	GLANZ_SEED=$${GLANZ_SEED:-$$(date +%s)} $(PYTEST) -m thorough

bench: $(READY)
	$(RUN) -m benchmarks

bench-growth: $(READY)
	$(RUN) -m benchmarks.growth $(GROWTH)

bench-targets: $(READY)
	$(RUN) -m benchmarks.targets $(TARGETS)

bench-peers: $(VENV)/.ready-peers
	$(RUN) -m benchmarks.peers $(PEERS)

bench-presets: $(READY)
	$(RUN) -m benchmarks.presets $(PRESETS)

# Mitsuba takes 200 MB, so it comes only here. What is set up anew removes this stamp, too.
$(VENV)/.ready-peers: $(READY)
	$(RUN) -m pip install --disable-pip-version-check --editable ".[$(EXTRAS),peers]" $(BLENDER)
	@touch $@

nodes: $(READY)
	$(RUN) tools/node_table.py

closures: $(READY)
	$(RUN) tools/closure_table.py

support: $(READY)
	$(RUN) tools/support_table.py

gallery: $(READY)
	$(RUN) tools/gallery.py

extension: $(READY)
	$(RUN) tools/build_extension.py

extension-linux: $(READY)
	$(RUN) tools/build_extension.py linux-x64

lint: $(READY)
	$(RUN) -m ruff check .

clean:
	rm -rf build dist out *.egg-info .pytest_cache .ruff_cache .hypothesis
	find . -path './.venv*' -prune -o -name __pycache__ -type d -prune -exec rm -rf {} +

distclean: clean
	rm -rf .venv .venv-* wheels
