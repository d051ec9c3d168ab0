# A target for each task of a contributor. Stamp files in .venv avoid installing again.
PYTHON ?= python3
VENV   := .venv
BIN    := $(VENV)/bin
PIP    := $(BIN)/python -m pip --disable-pip-version-check --quiet

# `make test ORDER=random` shuffles the tests and prints a seed; SEED=N repeats that order.
ORDER  ?= fixed
ifeq ($(ORDER),random)
ifndef SEED
SEED   := $(shell $(PYTHON) -c 'import random; print(random.randrange(10**6))')
endif
ORDERED := --random-order --random-order-seed=$(SEED)
endif

# One worker of pytest more than there are cores, because a worker often waits for a process; at most four, for the memory.
WORKERS ?= $(shell $(PYTHON) -c 'import os; print(min(4, (os.cpu_count() or 1) + 1))')

# Let Python store compiled modules, even if the shell forbids it. Otherwise each process that a test starts, and each
# worker of pytest, compiles all modules again.
unexport PYTHONDONTWRITEBYTECODE

.PHONY: demo quick test tests test-again test-slow fuzz lint format generate docs vscode bench checkers clean

# Compile and draw the Cover and Hide spec, run its generated monitor over a recorded trace, and play the level.
demo: $(VENV)/.installed-game
	$(BIN)/tltlc compile examples/cover_and_hide.tltl -o demo -t json,dot,python,svg
	$(BIN)/python demo/cover_and_hide_monitor.py examples/cover_and_hide.csv > demo/cover_and_hide_run.csv
	@echo "The last step of the recorded trace, as the generated monitor saw it:"
	@head -n 1 demo/cover_and_hide_run.csv
	@tail -n 1 demo/cover_and_hide_run.csv
	@echo "Written: the artefact demo/cover_and_hide.fspa.json, its picture demo/cover_and_hide.svg,"
	@echo "the monitor demo/cover_and_hide_monitor.py and every step of the trace, demo/cover_and_hide_run.csv."
	@if $(BIN)/python -c "import pybullet" 2> /dev/null; then \
		echo "The scripted expert plays the level; its recording, and beside it a plan of its trajectory (.png):"; \
		$(BIN)/tltlc demonstrate cover_and_hide -o demo && \
		echo "The policy that was trained for the level plays four episodes, with actions sampled and with the likeliest:" && \
		$(BIN)/tltlc evaluate --level cover_and_hide --episodes 4 --out demo && \
		echo "Written: demo/evaluation.json, and the trajectories of these episodes, demo/ways-sampled.png and demo/ways-arg-max.png." && \
		echo "Do the levels still play as designed, where assets that they share were changed? (a minute or two)" && \
		rm -f demo/regression/report.html && \
		{ $(BIN)/tltlc regress -o demo/regression || test -f demo/regression/report.html; }; \
	else \
		echo "The game is not played: its physics, pybullet, needs Python 3.10 or 3.11 (make demo PYTHON=python3.11)."; \
	fi
	@echo "The command is $(BIN)/tltlc; after 'source $(BIN)/activate' it is tltlc."

# Run the tests of the compiler that start no process and no other compiler, in a minute. tests/quick.py has the rules.
quick: $(VENV)/.installed-dev
	$(BIN)/ruff check .
	$(BIN)/python -m pytest -q -n 2 -m quick $(ORDERED)

# Run the static checks and the tests at the same time, because mypy alone would leave a core idle.
test: $(VENV)/.installed-dev
	@$(MAKE) --no-print-directory -j 2 lint tests SEED=$(SEED)

tests: $(VENV)/.installed-dev
	@$(if $(ORDERED),echo "The order is random; the same one again: make test ORDER=random SEED=$(SEED)")
	@# Without MAKEFLAGS, because compilers that tests start would look for the job server of `make -j`.
	env -u MAKEFLAGS -u MFLAGS $(BIN)/python -m pytest -q -rs -n $(WORKERS) -m "not slow" $(ORDERED)

# Check that the tests depend neither on their order nor on how busy the machine is: N runs in random orders, beside BUSY
# busy processes, with a line for each. ARGS are further arguments of pytest, such as `-n 4` or a folder.
N      ?= 10
BUSY   ?= 6
test-again: $(VENV)/.installed-dev
	$(BIN)/python -m tests.repeated_runs $(N) $(BUSY) $(ARGS)

# Run the slow tests: whole trainings, Ray clusters, long sessions, the shipped suite, large formulas. This takes half an
# hour. `make test-slow PART=2/4` runs the second of four parts.
PART   ?= 1/1
test-slow: $(VENV)/.installed-dev
	$(BIN)/python -m pytest -q -rs -n 2 -m slow --part $(PART)

# Run the property tests with new examples each time; a failure prints how to reproduce it.
fuzz: $(VENV)/.installed-dev
	$(BIN)/python -m pytest -q -n 2 -m hypothesis --hypothesis-profile=fuzz

lint: $(VENV)/.installed-dev
	$(BIN)/ruff check .
	$(BIN)/ruff format --check .
	$(BIN)/mypy
	$(BIN)/lint-imports
	$(BIN)/tltlc fmt --check examples stdlib_predicates
	$(BIN)/tltlc lint examples stdlib_predicates

format: $(VENV)/.installed-dev
	$(BIN)/ruff check --fix .
	$(BIN)/ruff format .

# Rewrite the files in the repository that are generated from other files.
generate: $(VENV)/.installed-dev
	$(BIN)/python -m tltlc.grammar.tables
	$(BIN)/python -m tltlc.artefact.generate
	rm -rf docs/images/new && $(BIN)/tltlc new docs/images/new --game python
	$(BIN)/tltlc render docs/images/new/hall.tltl --notation english -o docs/images/leave.svg
	rm -rf docs/images/new && $(BIN)/tltlc new docs/images/new
	$(BIN)/tltlc render docs/images/new/first_level.tltl --notation english -o docs/images/leave_with_key.svg
	rm -rf docs/images/new
	$(BIN)/python docs/images/frames.py docs/images
	$(BIN)/python -m docs_site.storeys docs/images

# Build the documentation as a site, with warnings as errors: site/index.html, which needs no server.
docs: $(VENV)/.installed-dev
	NO_MKDOCS_2_WARNING=1 $(BIN)/python -m mkdocs build --quiet
	@echo "Written: site/index.html"

# Build the extension for VS Code: editors/vscode/tltl.vsix.
vscode:
	npm --prefix editors/vscode ci --no-audit --no-fund
	npm --prefix editors/vscode run build
	npm --prefix editors/vscode run package

# Compare with peers and write benchmarks/RESULTS.md; a stopped run resumes. MONA is the Debian package `mona`.
bench: $(VENV)/.installed-bench
	$(BIN)/python -m benchmarks

# Install what only tests use, each in a folder of its own: gdtoolkit needs another version of lark than tltlc.
checkers: $(VENV)/gdtoolkit/bin/gdparse $(VENV)/npm/node_modules/.bin/tsc $(VENV)/pyodide/node_modules/pyodide \
    $(VENV)/onnxruntime-web/node_modules/onnxruntime-web $(VENV)/vizdoom/vizdoom

$(VENV)/gdtoolkit/bin/gdparse:
	$(PYTHON) -m venv $(VENV)/gdtoolkit
	$(VENV)/gdtoolkit/bin/python -m pip --disable-pip-version-check --quiet install gdtoolkit==4.5.0

$(VENV)/npm/node_modules/.bin/tsc:
	npm install --prefix $(VENV)/npm --silent --no-audit --no-fund --ignore-scripts typescript@5.9.3 esbuild@0.28.2

$(VENV)/pyodide/node_modules/pyodide:
	npm install --prefix $(VENV)/pyodide --silent --no-audit --no-fund --ignore-scripts pyodide@314.0.7

$(VENV)/onnxruntime-web/node_modules/onnxruntime-web:
	npm install --prefix $(VENV)/onnxruntime-web --silent --no-audit --no-fund --ignore-scripts onnxruntime-web@1.30.0

# Without what it depends on, because pygame-ce would replace the files of pygame.
$(VENV)/vizdoom/vizdoom: | $(VENV)/bin/python
	$(PIP) install --no-deps --target $(VENV)/vizdoom vizdoom==1.3.2

clean:
	rm -rf $(VENV) demo site build dist .pytest_cache .mypy_cache .ruff_cache .hypothesis .import_linter_cache

$(VENV)/bin/python:
	$(PYTHON) -m venv $(VENV)

$(VENV)/.installed: pyproject.toml constraints.txt | $(VENV)/bin/python
	$(PIP) install -c constraints.txt -e .
	@touch $@

$(VENV)/.installed-game: pyproject.toml constraints.txt | $(VENV)/bin/python
	$(PIP) install -c constraints.txt -e '.[game]'
	@touch $@ $(VENV)/.installed

$(VENV)/.installed-dev: pyproject.toml constraints.txt | $(VENV)/bin/python
	$(PIP) install -c constraints.txt -e '.[dev,ray]'
	@touch $@ $(VENV)/.installed $(VENV)/.installed-game

$(VENV)/.installed-bench: benchmarks/requirements.txt | $(VENV)/.installed-dev
	$(PIP) install -c constraints.txt -r benchmarks/requirements.txt
	@touch $@
