# `make help` lists what there is. Needs Python 3.11 or newer and nothing else; everything goes into .venv.
PYTHON3 ?= python3
PYTHON  := .venv/bin/python
PYTEST  := $(PYTHON) -m pytest
# Tests and tools share two cores: one thread each.
export OMP_NUM_THREADS := 1
export OPENBLAS_NUM_THREADS := 1
export MKL_NUM_THREADS := 1
# Modules are compiled once and kept, whatever the caller's shell says; else every notebook would compile them anew.
export PYTHONDONTWRITEBYTECODE :=

.DEFAULT_GOAL := help
.PHONY: help environment book pdf chapter drive test test-slow test-kernel test-lowest test-book lint format twins explorer bench references clean

help: ## list the targets
	@grep -hE '^[a-z-]+:.*## ' $(MAKEFILE_LIST) | awk -F ':.*## ' '{printf "  make %-12s %s\n", $$1, $$2}'

environment: ## create or update .venv (every target below does it first)
	@$(PYTHON3) tools/set_up.py

book: environment ## execute what changed, check it, build the book
	@$(PYTHON) tools/build.py

pdf: environment ## print the book to build/facegear.pdf (needs Chromium)
	@$(PYTHON) tools/build.py pdf && echo 'Printed: build/facegear.pdf'

chapter: environment ## execute and check one notebook: make chapter NAME=03_geometry_and_meshing
	@test -f 'notebooks/$(NAME).ipynb' || { echo 'There is no notebooks/$(NAME).ipynb. Say for example: make chapter NAME=03_geometry_and_meshing'; exit 2; }
	@$(PYTHON) tools/build.py 'notebook:$(NAME)' && echo 'Executed: build/executed/$(NAME).ipynb'

drive: environment ## facegear report on a drive of your own: make drive FILE=my_drive.yaml
	@test -n '$(FILE)' || { echo 'Say which file, for example: make drive FILE=data/drives/case_2.yaml'; exit 2; }
	@test -f '$(FILE)' || { echo 'There is no file $(FILE)'; exit 2; }
	@$(PYTHON) -m facegear report '$(FILE)'

# Tests are shared out by file: what those of one file share, such as a derivation, is computed once.
test: environment ## run the tests (some minutes)
	@$(PYTEST) -n 2 --dist loadfile -m 'not slow and not book'

# One more than there are processors: these wait for kernels, signals and the browser now and then.
test-slow: environment ## run the tests that take a minute each
	@$(PYTEST) -n 3 --dist loadscope -m 'slow and not book' $$(grep -rl --include='*.py' 'mark[.]slow' tests)

test-kernel: environment ## run the tests as on another processor
	@$(PYTHON) tools/test_kernel.py -n 2 --dist loadfile -m 'not slow and not book'

test-lowest: environment ## run the tests with the oldest versions that pyproject.toml allows
	@$(PYTHON) tools/test_lowest.py -n 2 --dist loadfile -m 'not slow and not book'

test-book: environment ## look at the built book in Chromium (make book first)
	@$(PYTEST) -n 3 --dist loadscope -m book tests/book

lint: environment ## check style, types, import order, notebooks
	$(PYTHON) -m ruff check .
	$(PYTHON) -m ruff format --check .
	$(PYTHON) -m mypy
	.venv/bin/lint-imports
	$(PYTHON) -m nbstripout --verify --keep-id --extra-keys '$(STRIPPED)' notebooks/*.ipynb

format: environment ## put code and notebooks into their committed form
	$(PYTHON) -m ruff check --fix .
	$(PYTHON) -m ruff format .
	$(PYTHON) -m nbstripout --keep-id --extra-keys '$(STRIPPED)' notebooks/*.ipynb

twins: environment ## write what computations take from the derivations anew
	@$(PYTHON) tools/write_twins.py

explorer: environment ## open the live explorer in a browser (Voilà on this machine)
	@$(PYTHON) -m voila notebooks/explorer.ipynb --preheat_kernel=True --VoilaKernelManager.fill_delay=5

bench: environment ## measure the performance tables, beside other packages (group `peers` of pyproject.toml)
	@UV_PROJECT_ENVIRONMENT=.venv $(PYTHON) -m uv sync --quiet --locked --inexact --python $(PYTHON) --group peers
	@for file in benchmarks/bench_*.py; do $(PYTHON) -m benchmarks.$$(basename $$file .py) || exit 1; done

references: environment ## make the stored arrays anew and say what moved: make references [NAME=03_geometry_and_meshing]
	@$(PYTHON) tools/update_references.py $(NAME)

clean: ## remove everything that is built (.venv stays)
	rm -rf build/*

STRIPPED := metadata.papermill metadata.widgets cell.metadata.papermill cell.metadata.execution
