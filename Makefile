# make run: both wires into the phantom. make test: the test suite. Each sets up what it needs in .venv, once.

PYTHON ?= python3
VENV ?= .venv
BIN := $(VENV)/bin
FUZZ_SECONDS ?= 60
RUNS := results/runs
WIRES := phantom-universal phantom-amplatz
BOTH := $(WIRES:%=$(RUNS)/%)
STUDY := fig4 fig6 fig8 fig9 table2 reach pull_back constant_force uncertainty findings page

.PHONY: help run figure paper test sanitize fuzz soak verify mutate lint format kernels wrappers clean
.DELETE_ON_ERROR:

help:
	@echo "make run      simulate both wires in the phantom, draw them side by side and compare them"
	@echo "make figure   run both and draw docs/figures/phantom.png, the figure of the README"
	@echo "make paper    rerun the study of Sharei et al. 2019: every figure and table into results/paper/index.html"
	@echo "make test     run the test suite"
	@echo "make sanitize run the FMU's tests with a wrapper that finds its own errors in memory (needs gcc)"
	@echo "make fuzz     feed the FMU's wrapper with what nobody would send, for FUZZ_SECONDS (needs clang)"
	@echo "make soak     a thousand instances of the FMU and hundreds of kills (takes half an hour)"
	@echo "make verify   show and write the evidence that the physics is right"
	@echo "make mutate   make errors in the physics on purpose, and see that tests notice each"
	@echo "make lint     check style and types"
	@echo "make format   put the code into its format"
	@echo "make kernels  build the contact kernel for all platforms"
	@echo "make wrappers build the FMU's native wrapper for all platforms"
	@echo "make clean    remove $(VENV) and caches (results stay)"

run: $(VENV)/.ready
	$(BIN)/gw-exudyn run $(WIRES)
	@drawn=`$(BIN)/gw-exudyn plot $(BOTH) --figure insertion` && \
	  compared=`$(BIN)/gw-exudyn compare $(BOTH) --out $(RUNS)` && \
	  echo "$$compared" | grep -v '\.p[nd][gf]$$' && \
	  echo "Results:    $(BOTH)" && \
	  echo "Figure:     `echo "$$drawn" | grep '\.png$$'`" && \
	  echo "Comparison: `echo "$$compared" | grep '\.png$$'`"

figure: $(VENV)/.ready
	$(BIN)/gw-exudyn run $(WIRES) --no-figures --quiet
	@drawn=`$(BIN)/gw-exudyn plot $(BOTH) --figure insertion --out docs/figures` && \
	  rm `echo "$$drawn" | grep '\.pdf$$'` && mv `echo "$$drawn" | grep '\.png$$'` docs/figures/phantom.png
	@echo docs/figures/phantom.png

paper: $(VENV)/.ready-dev
	@for script in $(STUDY); do $(BIN)/python scenarios/paper/$$script.py || exit 1; done

test: $(VENV)/.ready-dev
	$(BIN)/python -m pytest -n auto

# The library of AddressSanitizer has to be in the host, Python here, before the wrapper is; Python itself leaks. What it
# finds it says on stderr, and ends the host.
sanitize: $(VENV)/.ready-dev
	GW_FMU_SANITIZE=1 ASAN_OPTIONS=detect_leaks=0 \
	  LD_PRELOAD="`gcc -print-file-name=libasan.so` `gcc -print-file-name=libstdc++.so`" \
	  $(BIN)/python -m pytest -n auto --capture=sys tests/fmu

fuzz: $(VENV)/.ready-dev
	$(BIN)/python tests/fmu/fuzz/fuzz.py --seconds $(FUZZ_SECONDS)

soak: $(VENV)/.ready-dev
	GW_FMU_SOAK=1 $(BIN)/python -m pytest tests/fmu/test_soak.py

verify: $(VENV)/.ready
	$(BIN)/gw-exudyn verify

mutate: $(VENV)/.ready-dev
	$(BIN)/python tests/mutation/mutate.py

lint: $(VENV)/.ready-dev
	$(BIN)/ruff check .
	$(BIN)/ruff format --check .
	$(BIN)/mypy

format: $(VENV)/.ready-dev
	$(BIN)/ruff check --fix .
	$(BIN)/ruff format .

kernels: $(VENV)/.ready-dev
	$(BIN)/python -m gw_exudyn.model.kernel.build

wrappers: $(VENV)/.ready-dev
	$(BIN)/python -m gw_exudyn.fmi.wrapper.build

clean:
	rm -rf $(VENV) .mypy_cache .pytest_cache .ruff_cache .hypothesis build dist
	find . -name __pycache__ -type d -prune -exec rm -rf {} +

$(BIN)/python:
	@command -v $(PYTHON) >/dev/null || { \
	  echo "'$(PYTHON)' is not there; Python 3.11 or newer is needed."; \
	  echo "Name another one: make $(MAKECMDGOALS) PYTHON=python3.11"; exit 1; }
	@$(PYTHON) -c 'import sys; sys.exit(sys.version_info < (3, 11))' 2>/dev/null || { \
	  echo "Python 3.11 or newer is needed, and '$(PYTHON)' is `$(PYTHON) --version 2>&1 | head -n 1`."; \
	  echo "Name another one: make $(MAKECMDGOALS) PYTHON=python3.11"; exit 1; }
	@$(PYTHON) -c 'import ensurepip, venv' 2>/dev/null || { \
	  echo "Python's venv module is missing; on Debian and Ubuntu: apt-get install python3-venv"; exit 1; }
	$(PYTHON) -m venv $(VENV)

$(VENV)/.ready: pyproject.toml | $(BIN)/python
	$(BIN)/python -m pip install --quiet --disable-pip-version-check --editable .
	@touch $@

$(VENV)/.ready-dev: pyproject.toml | $(BIN)/python
	$(BIN)/python -m pip install --quiet --disable-pip-version-check --editable '.[dev]'
	@touch $(VENV)/.ready $@
