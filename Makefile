# make         regenerate what is out of date        make check   look for problems, write nothing
# make test    the whole test suite                  make help    all targets
MAKEFLAGS += --no-builtin-rules
.DELETE_ON_ERROR:

PYTHON ?= python3
VENV := .venv
RUN := $(VENV)/bin/python
SOURCES := $(shell find spec generator templates LICENSE -type f -not -path '*/__pycache__/*' -not -name '.*')
FUZZ_SECONDS ?= 60
LIBFUZZER = -max_total_time=$(FUZZ_SECONDS) -max_len=300 -verbosity=0 -print_funcs=0 -print_final_stats=1
PIP := $(RUN) -m pip install --quiet --disable-pip-version-check
BROWSER = { [ "$$(id -u)" = 0 ] && command -v apt-get >/dev/null && echo "make test: installing chromium" && apt-get update -qq && \
	DEBIAN_FRONTEND=noninteractive apt-get install -y -qq --no-install-recommends chromium fonts-dejavu-core >/dev/null; }

.PHONY: always all site serve check test lint bench-libs fuzz fuzz-c fuzz-rust fuzz-python census clean help
all: .build/generated .build/site

.build/generated: $(SOURCES) $(VENV)/ready
	@mkdir -p .build
	$(RUN) -m generator build
	@touch $@

site: .build/site ## build the reference in generated/html; URL=https://host/path/ adds a sitemap

.build/site: $(SOURCES) $(VENV)/ready .build/url
	@mkdir -p .build
	$(RUN) -m generator site --url '$(URL)'
	@touch $@

.build/url: always
	@mkdir -p .build
	@echo '$(URL)' | cmp -s - $@ || echo '$(URL)' > $@

serve: .build/site ## show the reference at http://localhost:8000
	$(RUN) -m http.server --directory generated/html --bind 127.0.0.1 8000

$(VENV)/ready: requirements.txt
	@command -v $(PYTHON) >/dev/null || { echo "make: install Python 3.11 or later ($(PYTHON) is not on the PATH)" >&2; exit 1; }
	@$(PYTHON) -c 'import sys; sys.exit(sys.version_info < (3, 11))' || { echo "make: $(PYTHON) is older than Python 3.11" >&2; exit 1; }
	$(PYTHON) -m venv $(VENV)
	$(PIP) -r requirements.txt
	@touch $@

$(VENV)/ready-for-tests: requirements-test.txt $(VENV)/ready
	$(PIP) -r requirements-test.txt
	@touch $@

check: $(VENV)/ready ## look for problems in spec/, write nothing
	$(RUN) -m generator check

census: $(VENV)/ready ## print every fact, one a line, and the coverage of each manual
	@$(RUN) -m generator census

test: .build/generated .build/site $(VENV)/ready-for-tests lint ## run the whole test suite
	@command -v cc >/dev/null || { echo "make test: install a C compiler (cc is not on the PATH)" >&2; exit 1; }
	@command -v c++ >/dev/null || { echo "make test: install a C++ compiler (c++ is not on the PATH)" >&2; exit 1; }
	@command -v cmake >/dev/null || { echo "make test: install CMake (cmake is not on the PATH)" >&2; exit 1; }
	@command -v pkg-config >/dev/null || { echo "make test: install pkg-config (it is not on the PATH)" >&2; exit 1; }
	@command -v chromium >/dev/null || $(BROWSER) || echo "make test: the tests in a browser are left out, install chromium for them" >&2
	@command -v cargo >/dev/null || { echo "make test: install Rust (cargo is not on the PATH)" >&2; exit 1; }
	$(RUN) -m pytest

lint: $(VENV)/ready-for-tests ## ruff and mypy --strict over the compiler and the tests
	$(VENV)/bin/ruff check generator tests
	$(VENV)/bin/ruff format --check generator tests
	$(VENV)/bin/mypy generator tests

fuzz: fuzz-c fuzz-rust fuzz-python ## fuzz the codecs of all three libraries and the readers; FUZZ_SECONDS=60 each device

fuzz-c: .build/generated
	@for tool in clang cmake; do command -v $$tool >/dev/null || { echo "make fuzz: C left out, $$tool is not on the PATH" >&2; exit 0; }; done; \
	cmake -S generated/c -B .build/fuzz -DCMAKE_C_COMPILER=clang -DDRIVESPEC_FUZZ=ON -DBUILD_TESTING=OFF >/dev/null && \
	cmake --build .build/fuzz && \
	for target in .build/fuzz/*_fuzz; do \
	    [ -x "$$target" ] || { echo "make fuzz: C left out, clang has no libFuzzer (Debian: libclang-rt-dev)" >&2; exit 0; }; \
	    echo "$$target"; "$$target" $(LIBFUZZER) -artifact_prefix=.build/fuzz/ || exit 1; \
	done

fuzz-rust: .build/generated
	@command -v cargo >/dev/null || { echo "make fuzz: Rust left out, cargo is not on the PATH" >&2; exit 0; }; \
	rm -rf .build/fuzz-rust && cp -R generated/rust .build/fuzz-rust && \
	cp tests/consumers/rust-features.lock .build/fuzz-rust/Cargo.lock && cd .build/fuzz-rust && \
	export CARGO_TARGET_DIR=../cargo/fuzz && \
	DRIVESPEC_ROUNDS=1000000 cargo test --quiet --release --tests || exit 1; \
	cargo fuzz --version >/dev/null 2>&1 && rustup toolchain list 2>/dev/null | grep -q ^nightly || \
	    { echo "make fuzz: the coverage of Rust is left out, install cargo-fuzz and the nightly toolchain" >&2; exit 0; }; \
	for target in $$(cargo +nightly fuzz list); do \
	    echo "$$target"; cargo +nightly fuzz run "$$target" -- $(LIBFUZZER) || exit 1; \
	done

fuzz-python: .build/generated $(VENV)/ready-for-tests
	$(RUN) -m pytest tests -m hypothesis --hypothesis-profile=long

bench-libs: .build/generated $(VENV)/ready ## what the libraries cost beside the usual other ways (cc, cargo; gperf and phf if there)
	@for tool in cc cargo; do command -v $$tool >/dev/null || { echo "make bench-libs: $$tool is not on the PATH" >&2; exit 1; }; done
	@PYTHONPATH=tests $(RUN) -m bench

clean: ## remove the virtual environment and what builds and tests leave behind
	rm -rf $(VENV) .build .pytest_cache .mypy_cache .ruff_cache .hypothesis generated/.state.json generated/html

help: ## show this list
	@echo "make            regenerate what is out of date in generated/"
	@sed -n 's/^\([a-z-]*\):.*## \(.*\)/make \1|\2/p' Makefile | while IFS='|' read -r a b; do printf '%-15s %s\n' "$$a" "$$b"; done
