.DEFAULT_GOAL := help
.PHONY: help setup run dev library test test-fast sanitizers fuzz fuzz-node lint format bench deb deb-check deb-board wheel abi board docs clean
export CMAKE_BUILD_PARALLEL_LEVEL ?= $(shell nproc)
export CTEST_PARALLEL_LEVEL ?= $(shell nproc)
cpp = $(shell find include src bindings tests bench examples -name '*.hpp' -o -name '*.cpp')

help: ## this list
	@grep -hE '^[a-z-]+:.*##' $(MAKEFILE_LIST) | sed -E 's/:.*## /\t/' | expand -t 14

setup: ## install what is missing: Debian packages, .venv, garrison
	@tools/setup.sh

run: ## the main job: Irish wind with hijacked stations, report in out/wind
	@tools/run.sh

dev: ## build quickly for a developer, few dimensions; then PYTHONPATH=python .venv/bin/pytest
	@tools/dev.sh

test: setup ## all tests: C++, Python, and some C++ again under the sanitizers
	@tools/test.sh

sanitizers: library ## C++ tests of what reads bytes or shares memory, with sanitizers; FILES=cpp/filters/rdkf: others
	@tools/sanitizers.sh $(if $(FILES),'$(FILES)')

library:
	@tools/system.sh
	@tools/stage.sh "configure release" cmake --preset release
	@tools/stage.sh "build library" cmake --build --preset release --target garrison

test-fast: setup ## C++ and Python tests without the sanitizers
	@tools/stage.sh "configure release" cmake --preset release
	@tools/stage.sh "build release" cmake --build --preset release
	@ctest --preset release
	@.venv/bin/pytest -q

lint: setup ## ruff, mypy, clang-format, type stubs
	@.venv/bin/ruff check --quiet
	@.venv/bin/ruff format --check --quiet
	@.venv/bin/mypy --no-error-summary
	@.venv/bin/clang-format --dry-run --Werror --ferror-limit=1 $(cpp)
	@tools/stubs.sh --check
	@echo "lint: no complaint"

format: setup ## format C++ and Python, write the type stubs anew
	@.venv/bin/ruff check --fix --quiet
	@.venv/bin/ruff format --quiet
	@.venv/bin/clang-format -i $(cpp)
	@tools/stubs.sh

fuzz: setup ## every public callable with bad values, mutated scenarios and CSV files; SEED=1 tries others
	@.venv/bin/pytest -q tests/fuzz --fuzz-seed=$(or $(SEED),0)

fuzz-node: library ## the node's parsers under libFuzzer, 10 s each; FUZZ_SECONDS=60: longer
	@tools/system.sh fuzz
	@BUILD=build/release tools/fuzz.sh $(or $(FUZZ_SECONDS),10)

bench: ## measure against the peers; results in bench/results
	@tools/setup.sh bench
	@bench/build.sh
	@.venv/bin/python bench/run.py

deb: ## Debian packages for this machine, in dist/
	@tools/deb.sh

deb-check: ## lintian, then install, run and remove the packages of dist/ in a clean Debian 12, and their own tests
	@tests/package/debian.sh --all

deb-board: ## Debian packages for a board, BOARD=arm64 or armhf, in dist/BOARD, cross-built in a clean Debian 12
	@tools/deb_board.sh $(BOARD)

wheel: ## sdist and wheels in dist/, tried in bare environments; PYTHONS="python3.11 python3.12": more than one
	@tools/wheel.sh $(PYTHONS)

abi: ## compare the library of dist/ with that of an older release, OLD=folder of its packages
	@tools/abi.sh $(OLD)

board: ## node programs for a board, BOARD=arm64 or armhf, in build/board-BOARD
	@tools/board.sh $(BOARD)

docs: ## build the site into build/docs; warnings are errors
	@tools/setup.sh docs
	@tools/docs.sh

clean: ## remove everything that was built or installed here
	@rm -rf build out dist .venv docs/generated
