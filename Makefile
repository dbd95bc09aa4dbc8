# hedge - builds and checks everything; `make help` lists the targets.
#
# A configuration has a build folder: release has build/; asan, tsan, coverage and fuzz have
# build/NAME. Sources are found by pattern, so a new file needs no line here. What must be installed
# for a target is in a table below, and .ci/deps installs it first; therefore pkg-config is called
# only inside recipes.

CONFIG ?= release
BUILD  := $(if $(filter release,$(CONFIG)),build,build/$(CONFIG))
PREFIX ?= /usr/local
UNITS  ?= $(PREFIX)/lib/systemd/system
WERROR ?= -Werror
SHELL  := /bin/sh
.DEFAULT_GOAL := all
.DELETE_ON_ERROR:
.SUFFIXES:

# make runs as many jobs as there are cores, unless the caller has chosen a number.
ifeq ($(MAKELEVEL)$(filter -j% --jobserver%,$(MAKEFLAGS)),0)
MAKEFLAGS += -j$(shell nproc)
endif

# V=1 prints whole commands.
Q        := $(if $(V),,@)
CC       := $(if $(filter fuzz,$(CONFIG)),clang,gcc)
WARNINGS := -Wall -Wextra -Wpedantic -Wshadow -Wconversion -Wstrict-prototypes \
            -Wmissing-prototypes -Wswitch-enum -Wvla $(WERROR)
CPPFLAGS := -D_DEFAULT_SOURCE -D_POSIX_C_SOURCE=200809L -Icore -I. -Itests
# The report of a sanitizer shows line numbers, for which line tables suffice.
DEBUG    ?= $(if $(filter asan tsan fuzz,$(CONFIG)),-g1,-g)
CFLAGS   := -std=c11 -pthread $(DEBUG) $(WARNINGS) $(EXTRA_CFLAGS)
LDFLAGS  := -pthread -Wl,--as-needed $(EXTRA_LDFLAGS)
# This is expanded only when a program is linked, after .ci/deps has run.
DAEMON_LIBS = $(shell pkg-config --libs libmicrohttpd libcjson zlib libisal libzstd sqlite3 nettle gnutls) -lmeshoptimizer -lamd -lm
TEST_LIBS   = $(shell pkg-config --libs libcurl cmocka)
# Some two hundred test programs each contain the whole daemon, in every configuration: lld links
# them in half of the time. The daemon is linked by the compiler's default linker.
TEST_LD    := -fuse-ld=lld

# Asserts stay in the release, because a daemon that stops is better than one that overwrites a
# mesh. What -O3 inlines makes gcc warn wrongly about values that are set through a pointer;
# instead, lint's analyzer looks for reads of uninitialized memory.
ifeq ($(CONFIG),release)
CFLAGS  += -O3 -fno-math-errno -fstack-protector-strong -U_FORTIFY_SOURCE -D_FORTIFY_SOURCE=2 \
           -Wno-maybe-uninitialized
LDFLAGS += -Wl,-z,relro,-z,now
else ifeq ($(CONFIG),asan)
SANITIZE := -fsanitize=address,undefined -fno-sanitize-recover=all -fno-omit-frame-pointer
CFLAGS  += -O1 $(SANITIZE)
LDFLAGS += $(SANITIZE)
else ifeq ($(CONFIG),tsan)
SANITIZE := -fsanitize=thread -fno-omit-frame-pointer
CFLAGS  += -O1 $(SANITIZE)
LDFLAGS += $(SANITIZE)
else ifeq ($(CONFIG),coverage)
CFLAGS  += -O0 --coverage -fprofile-update=atomic
LDFLAGS += --coverage
else ifeq ($(CONFIG),fuzz)
SANITIZE := -fsanitize=address,undefined -fno-sanitize-recover=all -fno-omit-frame-pointer
# Only gcc's warnings are used: clang has other ones, and the sources are written for gcc's.
CFLAGS  += -O1 $(SANITIZE) -fsanitize=fuzzer-no-link -w
LDFLAGS += $(SANITIZE) -fsanitize=fuzzer
else
$(error CONFIG is release, asan, tsan, coverage or fuzz, not "$(CONFIG)")
endif

# --- what there is -------------------------------------------------------------------------

object      = $(patsubst %.c,$(BUILD)/obj/%.o,$(1))
STORE_C    := $(sort $(shell find core/system core/journal core/store -name '*.c'))
KERNEL_C   := $(sort $(filter-out $(STORE_C),$(shell find core -name '*.c')))
API_C      := $(sort $(shell find api -name '*.c'))
MAIN_C     := server/boot/main.c server/version.c
SERVER_C   := $(sort $(filter-out $(MAIN_C),$(shell find server -name '*.c')))
SUITES     := unit model api e2e
PROGRAM_C  := $(sort $(foreach suite,$(SUITES),$(wildcard tests/$(suite)/test_*.c)))
# The sources of the random tests; tests with threads do not need them.
ORACLE_C   := $(sort $(wildcard tests/oracle/*.c tests/unit/scenarios_*.c) \
                $(filter-out tests/model/test_% $(patsubst %,tests/model/%.c,corpus marks parts shapes), \
                    $(wildcard tests/model/*.c)))
SUPPORT_C  := $(sort $(filter-out $(PROGRAM_C) $(ORACLE_C), \
                $(wildcard tests/*.c $(foreach suite,$(SUITES),tests/$(suite)/*.c))))
SIDE_C     := $(sort $(wildcard tests/bench/side/*.c))
OURS_C     := $(sort $(wildcard tests/bench/ours/*.c))
BENCH_C    := tests/bench/space.c tests/bench/polygons.c tests/bench/store.c tests/bench/checks.c tests/bench/lists.c $(SIDE_C) $(OURS_C)
PEER_CC    := $(sort $(wildcard tests/bench/peers/*.cc))
FUZZ_C     := $(sort $(wildcard tests/fuzz/fuzz_*.c))
# The sources that all fuzz targets are linked with, besides the libraries; libFuzzer has a main
# program of its own.
FUZZ_PARTS := $(sort $(filter-out $(FUZZ_C) $(if $(filter fuzz,$(CONFIG)),tests/fuzz/replay.c), \
                $(wildcard tests/fuzz/*.c)) tests/codings.c tests/json_tokens.c tests/pace.c tests/traffic.c \
                tests/api/request.c tests/unit/fixture.c tests/unit/format_fixture.c server/http/syntax/http_fault.c server/http/syntax/http_syntax.c \
                server/log/trace.c)
HTTP_C     := $(sort $(wildcard tests/bench/http/*.c))
FAULTS_C   := tests/durable/inject/faults.c
DAMAGE_C   := $(sort $(wildcard tests/durable/damage/*.c))
HEADERS    := $(sort $(shell find core api server -name '*.h') $(wildcard tests/*.h tests/*/*.h tests/durable/damage/*.h \
                tests/bench/side/*.h tests/bench/ours/*.h))
ALL_C      := $(KERNEL_C) $(STORE_C) $(API_C) $(SERVER_C) $(wildcard $(MAIN_C)) $(PROGRAM_C) $(SUPPORT_C) $(ORACLE_C) \
              $(wildcard tests/fuzz/*.c) $(BENCH_C) $(HTTP_C) $(FAULTS_C) $(DAMAGE_C)

LIBRARIES  := $(patsubst %,$(BUILD)/lib%.a,server api store kernel)
HEDGED     := $(BUILD)/hedged
PROGRAMS   := $(patsubst %.c,$(BUILD)/%,$(PROGRAM_C))
SPACE      := $(BUILD)/tests/bench/space $(BUILD)/tests/bench/polygons
FUZZERS    := $(patsubst %.c,$(BUILD)/%,$(FUZZ_C))
FAULTS     := $(BUILD)/tests/durable/faults.so
DAMAGE     := $(BUILD)/tests/durable/damage_store
PAGE       := build/web
PAGE_FILES  = $(shell find web -name node_modules -prune -o -name dist -prune -o -type f -print)
STAMPS     := build/.stamps

.PHONY: all help run page programs built ready test lint format asan tsan coverage crosscheck proof soak durable \
        hostile clients fuzz targets bench bench-http bench-store bench-events bench-slow bench-flood bench-fair bench-large bench-space bench-reshape report container fresh \
        screenshot examples \
        install uninstall clean ALWAYS

# TESTS selects tests: `make test TESTS=unit`, `make test TESTS=tests/unit/test_build.c`, `make test
# TESTS=tests/web/rows.test.mjs`.
TESTS   ?= $(SUITES) transport fuzz web install soak hostile durable lint
CHOSEN   = $(filter $(foreach t,$(TESTS),$(BUILD)/tests/$(t)/test_% $(BUILD)/$(t:.c=)),$(PROGRAMS))
WITH_WEB = $(filter web tests/web/%,$(TESTS))
WITH_FUZZ = $(filter fuzz,$(TESTS))
WITH_INSTALL = $(filter install,$(TESTS))
WITH_SOAK = $(filter soak,$(TESTS))
WITH_HOSTILE = $(filter hostile,$(TESTS))
WITH_DURABLE = $(filter durable,$(TESTS))
WITH_LINT = $(filter lint,$(TESTS))
WITH_TRANSPORT = $(filter transport,$(TESTS))
# With TRANSPORT=tls or unix, the tests of e2e reach their daemons over TLS or a Unix socket; the
# programs below do so in every run.
export TRANSPORT
TRANSPORTED = $(addprefix $(BUILD)/tests/e2e/test_,vertical history tokens limits metrics proxy service)
# A smaller selection of tests does not request every route, so its traffic is not compared.
WITH_TRAFFIC = $(and $(filter e2e,$(TESTS)),$(filter web,$(TESTS)))
WITH_DAEMON = $(filter e2e transport web install soak hostile durable tests/e2e/% tests/web/%,$(TESTS))

# --- what must be installed ----------------------------------------------------------------
# The sets of packages (.ci/deps) that each target needs. All sets of a target are requested in one
# call before anything else is done, so that a user who is not root sees one line to install, and
# apt-get never runs twice at once. A target that is a file needs what compiles it.

NEEDS.all          := build
NEEDS.run          := build web
NEEDS.page         := build web
NEEDS.programs     := build test
NEEDS.built         = $(NEEDS.test)
NEEDS.ready         = $(NEEDS.test) lint crosscheck clients fuzz
NEEDS.test          = build test $(if $(WITH_WEB)$(WITH_INSTALL),web browser) \
                      $(if $(WITH_SOAK),node) $(if $(WITH_HOSTILE),hostile) $(if $(WITH_DURABLE),durable)
NEEDS.examples     := build test
NEEDS.asan         := build test
NEEDS.tsan         := build test
NEEDS.coverage     := build test coverage
NEEDS.lint         := build test web lint
NEEDS.format       := format
NEEDS.crosscheck    = build $(if $(filter blender,$(PEERS)),blender,crosscheck)
NEEDS.proof        := build test web browser
NEEDS.soak         := build node
NEEDS.hostile      := build hostile
NEEDS.clients      := build clients
NEEDS.durable      := build durable
NEEDS.fuzz         := build test fuzz
NEEDS.targets      := build test $(if $(filter fuzz,$(CONFIG)),fuzz)
NEEDS.bench        := build node bench
NEEDS.bench-http   := build node bench-http
NEEDS.bench-store  := build durable bench-http
NEEDS.bench-events := build
NEEDS.bench-slow   := build bench-http bench-slow
NEEDS.bench-flood  := build bench-slow
NEEDS.bench-fair   := build bench-http
NEEDS.bench-large  := build bench-http
NEEDS.bench-space  := build
NEEDS.bench-reshape := build node bench
NEEDS.report        = node $(foreach name,$(REPORTS),$(NEEDS.$(name)))
NEEDS.screenshot   := build web browser
NEEDS.container    := container
NEEDS.fresh        := fresh
NEEDS.install      := build web
NEEDS.help         :=
NEEDS.clean        :=
NEEDS_OF_FILE       = build $(if $(findstring /tests/,$(1)),test) \
                      $(if $(findstring /tests/bench/,$(1)),bench) \
                      $(if $(findstring /tests/crosscheck/,$(1)),crosscheck)

NEEDS     := $(sort $(foreach goal,$(or $(MAKECMDGOALS),$(.DEFAULT_GOAL)), \
                 $(if $(filter undefined,$(origin NEEDS.$(goal))),$(call NEEDS_OF_FILE,$(goal)), \
                     $(NEEDS.$(goal)))))
empty     :=
INSTALLED := $(if $(NEEDS),$(STAMPS)/needs-$(subst $(empty) $(empty),+,$(NEEDS)))

$(STAMPS)/needs-%: .ci/deps
	@sh .ci/deps $(subst +, ,$*)
	@mkdir -p $(@D) && touch $@

# --- the daemon ----------------------------------------------------------------------------

all: $(HEDGED) ## the daemon, build/hedged (default)

help: ## this list
	@sed -n 's/^\([a-z-]*\):.*## \(.*\)/  make \1|\2/p' Makefile | \
	    awk -F'|' '{ printf "%-18s %s\n", $$1, $$2 }'

run: $(HEDGED) page ## build the daemon and its page, then serve sample meshes
	exec $(HEDGED) --samples $(RUN_FLAGS)

# --- compiling -----------------------------------------------------------------------------

# The code of a test runs only a few times, so optimizing it takes longer than it saves; the oracle
# and the models run millions of times and are optimized. The fortified functions are off, because
# they require optimization, and because libc's __recv_chk would bypass the recv() of
# server/http/http_recv.c, which test_srv_syntax tests.
PLAIN := $(patsubst %,$(BUILD)/obj/tests/%/test_%.o,unit api e2e)
$(PLAIN): private CFLAGS += -O0 $(if $(filter release,$(CONFIG)),-g1 -U_FORTIFY_SOURCE)

$(BUILD)/obj/%.o: %.c Makefile | $(INSTALLED)
	@mkdir -p $(@D)
	@echo "CC $<"
	$(Q)$(CC) $(CPPFLAGS) $(CFLAGS) -MMD -MP -c -o $@ $<

# The assembler includes this file, which the compiler does not list as a dependency.
$(call object,api/describe/examples.c): api/describe/examples.json

# The archive is made anew each time, so that the object of a deleted source does not stay in it;
# objects are appended, because two folders may have sources of one name.
$(BUILD)/libkernel.a: $(call object,$(KERNEL_C))
$(BUILD)/libstore.a: $(call object,$(STORE_C))
$(BUILD)/libapi.a: $(call object,$(API_C))
$(BUILD)/libserver.a: $(call object,$(SERVER_C))
$(BUILD)/libsupport.a: $(call object,$(SUPPORT_C))
$(BUILD)/liboracle.a: $(call object,$(ORACLE_C))
$(BUILD)/%.a:
	@mkdir -p $(@D)
	@rm -f $@
	@echo "AR $@"
	$(Q)ar qcs $@ $^

# The commit is compiled into one object of the daemon, so that a new commit costs only linking.
COMMIT := $(shell git describe --always --exclude '*' --abbrev=12 --dirty=+ 2>/dev/null)
$(BUILD)/commit: ALWAYS
	@mkdir -p $(@D)
	@echo '$(COMMIT)' | cmp -s - $@ || echo '$(COMMIT)' >$@
ALWAYS:
$(call object,server/version.c): CPPFLAGS += -DSRV_COMMIT='"$(COMMIT)"'
$(call object,server/version.c): $(BUILD)/commit

$(HEDGED): $(call object,$(MAIN_C)) $(LIBRARIES)
	@echo "LD $@"
	$(Q)$(CC) $(LDFLAGS) -o $@ $^ $(DAEMON_LIBS)

# A test that must see the calls of a lower room has the linker redirect these calls to functions of
# the test. This needs the linker bfd, because lld would also redirect calls within one source.
wrap = -fuse-ld=bfd $(patsubst %,-Wl$(comma)--wrap=%,$(1))
comma := ,
$(BUILD)/tests/api/test_writes: private LDFLAGS += $(call wrap,st_write_begin st_write_commit st_write_abort st_write_remove)
$(BUILD)/tests/api/test_limits: private LDFLAGS += $(call wrap,st_clock_micros)
$(BUILD)/tests/api/test_presence: private LDFLAGS += $(call wrap,st_clock_micros api_record_write)
$(BUILD)/tests/api/test_compare: private LDFLAGS += $(call wrap,st_read_begin st_read_end st_read_card st_elements_at st_snapshot_take st_snapshot_at)
$(BUILD)/tests/api/test_created: private LDFLAGS += $(call wrap,st_create_from)
$(BUILD)/tests/api/test_disk: private LDFLAGS += $(call wrap,st_write_begin st_write_commit st_create_from)
$(BUILD)/tests/api/test_events: private LDFLAGS += $(call wrap,he_changes_find he_changes_sum)
$(BUILD)/tests/api/test_snapshots: private LDFLAGS += $(call wrap,st_snapshot_take st_snapshot_held)
$(BUILD)/tests/unit/test_srv_journal_faults: private LDFLAGS += $(call wrap,fstatvfs posix_fallocate fsync st_clock_wait)
$(BUILD)/tests/unit/test_srv_evict: private LDFLAGS += $(call wrap,st_clock_wait)
$(BUILD)/tests/api/test_mesh_access: private LDFLAGS += $(call wrap,he_draw_slots_new)
$(BUILD)/tests/api/test_space_threads: private LDFLAGS += \
    $(call wrap,st_derived_begin st_derived_end st_derived_wait)

$(BUILD)/tests/api/test_gate: private LDFLAGS += \
    $(call wrap,api_gate_enter api_gate_sees api_gate_may_create api_gate_may_change api_role_allows \
    api_token_is_current api_token_is_equal api_token_matches api_token_owns api_token_ranges \
    api_token_sees api_tokens_find api_tokens_watch api_rating_enter api_rating_charge \
    api_rates_admit st_holders_move api_job_submit api_tickets_take st_keyed_begin st_clock_utc)

$(BUILD)/tests/unit/test_srv_slow: private LDFLAGS += \
    $(call wrap,st_clock_micros st_clock_wait pthread_rwlock_rdlock api_end st_pool_submit st_waits_add)
$(BUILD)/tests/unit/test_srv_pool: private LDFLAGS += $(call wrap,pthread_cond_signal)
$(BUILD)/tests/unit/test_srv_sweep: private LDFLAGS += \
    $(call wrap,pthread_mutex_lock shutdown)

ORACLED    := $(filter-out $(BUILD)/tests/unit/test_srv_%, \
                $(filter $(BUILD)/tests/model/% $(BUILD)/tests/unit/%,$(PROGRAMS)))
$(ORACLED): $(BUILD)/liboracle.a
$(PROGRAMS): $(BUILD)/%: $(BUILD)/obj/%.o $(BUILD)/libsupport.a $(LIBRARIES) | $(INSTALLED)
	@mkdir -p $(@D)
	@echo "LD $@"
	$(Q)$(CC) $(TEST_LD) $(LDFLAGS) -o $@ $^ $(DAEMON_LIBS) $(TEST_LIBS)

$(FUZZERS): $(BUILD)/%: $(BUILD)/obj/%.o $(call object,$(FUZZ_PARTS)) \
            $(filter-out %/libserver.a,$(LIBRARIES)) | $(INSTALLED)
	@mkdir -p $(@D)
	@echo "LD $@"
	$(Q)$(CC) $(TEST_LD) $(LDFLAGS) -o $@ $^ $(DAEMON_LIBS) $(TEST_LIBS)

-include $(patsubst %.o,%.d,$(call object,$(ALL_C)))

# --- the page ------------------------------------------------------------------------------

page: $(STAMPS)/page ## the browser's page, build/web, with the manual

$(STAMPS)/modules: web/package.json web/package-lock.json | $(INSTALLED)
	cd web && npm ci --no-audit --no-fund
	@touch $@

# The manual is made from the daemon's tables and from its answers to the manual's requests. The file
# with both changes only if one of them has changed, so that a new daemon does not always cost a new
# page. What was removed is made again, although its stamp is still there.
MANUAL := build/manual.json
removed = $(if $(wildcard $1),,ALWAYS)
$(STAMPS)/recorded: $(call removed,$(MANUAL)) $(HEDGED) $(filter web/manual/% web/src/manual/%,$(PAGE_FILES)) | $(INSTALLED)
	@mkdir -p $(@D)
	node web/manual/record.mjs $(abspath $(HEDGED)) $(MANUAL)
	@touch $@

$(MANUAL): $(STAMPS)/recorded ;

$(STAMPS)/page: $(call removed,$(PAGE)/index.html) $(PAGE_FILES) $(STAMPS)/modules $(MANUAL)
	cd web && WEB_OUT=$(abspath $(PAGE)) MANUAL=$(abspath $(MANUAL)) npm run build
	@touch $@

# --- tests ---------------------------------------------------------------------------------

TEST_NEEDS = $(if $(WITH_DAEMON)$(WITH_LINT),$(HEDGED)) $(if $(WITH_WEB)$(WITH_INSTALL),page) \
             $(if $(WITH_TRAFFIC),$(STAMPS)/modules) $(if $(WITH_FUZZ),$(FUZZERS)) \
             $(if $(WITH_DURABLE),$(FAULTS) $(DAMAGE)) $(if $(WITH_TRANSPORT),$(TRANSPORTED))

programs: $(PROGRAMS) ## all test programs, without running them

built: $(CHOSEN) $(TEST_NEEDS)

ready: built $(BUILD)/tests/crosscheck/peers $(STAMPS)/openapi $(STAMPS)/clients | $(INSTALLED) ## what .ci/run runs, without running it
	+$(MAKE) CONFIG=asan TESTS="$(ASAN_TESTS)" built
	+$(MAKE) CONFIG=tsan TESTS="$(TSAN_TESTS)" built
	+$(MAKE) CONFIG=fuzz targets

test: built | $(INSTALLED) ## all tests, with their counts
	@BUILD=$(BUILD) HEDGED=$(abspath $(HEDGED)) FUZZ=$(abspath $(BUILD)/tests/fuzz) \
	    TRANSPORTED="$(TRANSPORTED)" \
	    sh .ci/run-tests $(BUILD)/logs $(if $(filter web,$(TESTS)),--web) \
	    $(if $(WITH_TRAFFIC),--traffic) $(CHOSEN) $(filter tests/web/%,$(TESTS)) \
	    $(if $(WITH_FUZZ),tests/fuzz/replay.sh) $(if $(WITH_INSTALL),tests/install.sh) \
	    $(if $(WITH_TRANSPORT),tests/transport.sh) $(if $(WITH_LINT),tests/lint.sh) \
	    $(if $(WITH_SOAK),tests/soak.sh) $(if $(WITH_HOSTILE),tests/hostile.sh) \
	    $(if $(WITH_DURABLE),tests/durable.sh)

# Only a person runs this, and reads the difference before it is committed: the tests compare each
# answer with the file, so a wrong answer must not get there by itself.
examples: $(BUILD)/tests/api/test_examples ## records the answers of the OpenAPI document's examples in api/describe/examples.json
	$< record api/describe/examples.json

ASAN_TESTS = $(filter-out transport web tests/web/% install soak hostile durable lint,$(TESTS))
asan: ## all C tests with AddressSanitizer and UndefinedBehaviorSanitizer
	+$(MAKE) CONFIG=asan TESTS="$(ASAN_TESTS)" test

# The kernel has no threads, and most of tests/api does one thing after another, jobs included. So
# under TSan only these run: tests that start threads or read the past of a stream, which a thread
# prepares, and the tests of the daemon itself.
THREADED_C  = $(shell grep -lE 'pthread_create|tests/api/stream.h' tests/api/test_*.c) \
              $(wildcard tests/unit/test_srv_*.c)
TSAN_TESTS  = e2e $(THREADED_C)
tsan: ## the threaded tests with ThreadSanitizer
	+$(MAKE) CONFIG=tsan TESTS="$(TSAN_TESTS)" test

coverage: | $(INSTALLED) ## line and branch coverage of the C tests
	find build/coverage -name '*.gcda' -delete 2>/dev/null || true
	+$(MAKE) CONFIG=coverage TESTS="$(ASAN_TESTS)" test
	gcovr --root . --filter core/ --filter api/ --filter server/ --exclude-throw-branches \
	    --print-summary --txt build/coverage/report.txt build/coverage/obj

# CHECK_FLAGS="--files 100000 --only ply" checks more files; SEED=... repeats a run. With
# PEERS=blender only Blender reads the written files; .ci/run does not do that.
CHECK_PEERS = $(if $(filter blender,$(PEERS)),,$(BUILD)/tests/crosscheck/peers)
crosscheck: $(HEDGED) $(CHECK_PEERS) ## readers and writers beside assimp, OpenMesh, CGAL and the corpus' reader; PEERS=blender: beside Blender
	@python3 -B tests/crosscheck/run.py --hedged $(abspath $(HEDGED)) \
	    $(if $(CHECK_PEERS),--peers $(CHECK_PEERS),--blender blender) $(CHECK_FLAGS)

$(BUILD)/tests/crosscheck/peers: tests/crosscheck/peers.cc | $(INSTALLED)
	@mkdir -p $(@D)
	@echo "CXX $<"
	$(Q)g++ -std=c++17 -O0 -w -o $@ $< -lOpenMeshCore -lgmp -lmpfr

# The long version of what .ci/run does once; `make fuzz FUZZ_SECONDS=1800` is another one.
ROUNDS ?= 10
proof: | $(INSTALLED) ## ROUNDS=10 of random edits from every start: a million, in turn a tenth of that under ASan; of a thousand meshes through each operation on surfaces; 8 writers at once; a copy and a page beside them; as many minutes of soak
	+$(MAKE) $(HEDGED) page $(BUILD)/tests/model/test_model $(BUILD)/tests/model/test_reshape \
	    $(BUILD)/tests/e2e/test_writers $(BUILD)/tests/e2e/test_events
	+$(MAKE) CONFIG=asan build/asan/tests/model/test_model build/asan/tests/model/test_reshape
	sh .ci/proof $(ROUNDS)

# With LOAD below 1 the test pauses, and leaves the machine to other programs for that part of the
# time.
MINUTES ?= 60
LOAD    ?= 1
soak: $(HEDGED) | $(INSTALLED) ## MINUTES=60 of everything that clients do: is the daemon's memory flat? build/soak.csv and .svg
	@HEDGED=$(abspath $(HEDGED)) node tests/soak/soak.mjs --minutes $(MINUTES) --load $(LOAD)

# HOSTILE_FLAGS="--only fan" selects rows by their name, "--parts operations,starving" selects parts
# of run.py's list; SEED=... repeats a run.
hostile: $(HEDGED) | $(INSTALLED) ## files and requests made to be slow: what each may hold of the daemon, and what it held
	@python3 -B tests/hostile/run.py --hedged $(abspath $(HEDGED)) \
	    --corpus ../shared/corpus/files $(HOSTILE_FLAGS)

# The generators have a lock file of their own, too, of some 700 packages.
$(STAMPS)/clients: tests/clients/package.json tests/clients/package-lock.json | $(INSTALLED)
	@mkdir -p build/clients
	cp tests/clients/package.json tests/clients/package-lock.json build/clients
	cd build/clients && npm ci --no-audit --no-fund --ignore-scripts
	@touch $@

clients: $(HEDGED) $(STAMPS)/clients | $(INSTALLED) ## clients that generators make of the OpenAPI document; CLIENTS="orval kubb" for some, JUDGES="spectral prism"
	@cp tests/clients/* build/clients
	@CLIENTS="$(CLIENTS)" JUDGES="$(JUDGES)" sh tests/clients.sh $(HEDGED)

# This library is preloaded into a daemon, with whatever flags that daemon was compiled.
$(FAULTS): $(FAULTS_C) Makefile | $(INSTALLED)
	@mkdir -p $(@D)
	@echo "LD $@"
	$(Q)$(CC) $(CPPFLAGS) -std=c11 -g1 -O1 -fPIC -shared $(WARNINGS) -o $@ $<

$(DAMAGE): $(call object,$(DAMAGE_C)) $(BUILD)/libsupport.a $(LIBRARIES) | $(INSTALLED)
	@mkdir -p $(@D)
	@echo "LD $@"
	$(Q)$(CC) $(LDFLAGS) -o $@ $^ $(DAEMON_LIBS) $(TEST_LIBS)

# A default for ROUNDS in this file belongs to another target, so only a value from the caller is
# passed on.
GIVEN_ROUNDS = $(if $(filter file default,$(origin ROUNDS)),,--rounds $(ROUNDS))
PROOF ?= kill
durable: $(HEDGED) $(FAULTS) $(DAMAGE) | $(INSTALLED) ## PROOF=kill ROUNDS= SEED=: what was acknowledged is there, whatever the disk did; tests/durable/run.py lists the proofs; EVERY=101: not every place of cut and flip
	@python3 -B tests/durable/run.py --hedged $(abspath $(HEDGED)) --faults $(abspath $(FAULTS)) \
	    --damage $(abspath $(DAMAGE)) --proof $(PROOF) $(GIVEN_ROUNDS) $(if $(EVERY),--every $(EVERY)) \
	    $(if $(SEED),--seed $(SEED)) --work build/durable

# Before a release, `make fuzz FUZZ_SECONDS=1800` is run; it runs with low priority, because it uses
# two cores.
FUZZ_SECONDS ?= 20
fuzz: | $(INSTALLED) ## FUZZ_SECONDS=20 of libFuzzer on each reader, the JSON document, edits, stored meshes, requests and HTTP
	+$(MAKE) CONFIG=fuzz targets
	@sh tests/fuzz/run.sh $(FUZZ_SECONDS)

targets: $(FUZZERS)

# --- the kernel beside its peers -------------------------------------------------------------
# BENCH selects parts: `make bench BENCH=build,onering`; RUNS=3 and SCALE=0.1 make it quicker. The
# peers are other mesh libraries, compiled only for the benchmark and as their users would: optimized
# as our program is, but without our hardening, and with NDEBUG, which turns CGAL's checks off.
# Neither side is tuned to the machine.

BENCH      ?=
RUNS       ?= 5
SCALE      ?= 1
BENCH_PEERS := openmesh cgal meshoptimizer eigen
PEER_FLAGS := -std=c++17 -O3 -fno-math-errno -DNDEBUG
SIDES      := $(addprefix $(BUILD)/tests/bench/sides/,ours $(BENCH_PEERS))
LIBS_openmesh      := -lOpenMeshTools -lOpenMeshCore
LIBS_meshoptimizer := -lmeshoptimizer

$(BUILD)/obj/tests/bench/peers/%.o: tests/bench/peers/%.cc Makefile | $(INSTALLED)
	@mkdir -p $(@D)
	@echo "CXX $<"
	$(Q)g++ -Itests -isystem /usr/include/eigen3 $(PEER_FLAGS) -Wall -Wextra -Wno-maybe-uninitialized -MMD -MP -c -o $@ $<

peer_objects = $(patsubst %.cc,$(BUILD)/obj/%.o,$(wildcard tests/bench/peers/$(1)*.cc))
define PEER
$(BUILD)/tests/bench/sides/$(1): $(call peer_objects,$(1)) $(call object,$(SIDE_C))
	@mkdir -p $$(@D)
	@echo "LD $$@"
	$$(Q)g++ -o $$@ $$^ $(LIBS_$(1))
endef
$(foreach peer,$(BENCH_PEERS),$(eval $(call PEER,$(peer))))

$(BUILD)/tests/bench/sides/ours: $(call object,$(OURS_C) $(SIDE_C)) $(LIBRARIES)
	@mkdir -p $(@D)
	@echo "LD $@"
	$(Q)$(CC) $(LDFLAGS) -o $@ $^ $(DAEMON_LIBS)

$(SPACE): $(BUILD)/tests/bench/%: $(BUILD)/obj/tests/bench/%.o $(call object,tests/polygons.c) $(BUILD)/libkernel.a
	@mkdir -p $(@D)
	@echo "LD $@"
	$(Q)$(CC) $(LDFLAGS) -o $@ $^ $(DAEMON_LIBS)

-include $(patsubst %.cc,$(BUILD)/obj/%.d,$(PEER_CC))

bench: $(SIDES) | $(INSTALLED) ## the kernel beside OpenMesh, CGAL and Eigen; BENCH=build,files for parts
	@node tests/bench/compare.mjs --programs $(BUILD)/tests/bench/sides --only "$(BENCH)" \
	    --runs $(RUNS) --scale $(SCALE) --flags="$(filter -O% -f% -m%,$(CFLAGS))" \
	    --peer-flags="$(PEER_FLAGS)"

bench-reshape: $(SIDES) | $(INSTALLED) ## remeshing, smoothing, filling, deforming, comparing and solving, beside CGAL and Eigen
	@$(MAKE) --no-print-directory bench BENCH=reshape

bench-space: $(SPACE) ## rays, nearest points, intersections, curvature, triangulation: our figures alone
	@for program in $(SPACE); do $$program; done

bench-http: $(HEDGED) $(BUILD)/tests/bench/http/bare $(addprefix $(BUILD)/tests/bench/,checks lists) | $(INSTALLED) ## requests a second, beside a bare libmicrohttpd; lists of edits; steps a second of dragging 50,176 vertices; a million positions both ways
	@sh tests/bench/http.sh $(HEDGED) $(BUILD)/tests/bench/http/bare $(BUILD)/tests/bench/checks
	@sh tests/bench/http_store.sh $(HEDGED) build/durable $(BUILD)/tests/bench/lists
	@sh tests/bench/drag.sh $(HEDGED)
	@sh tests/bench/arrays.sh $(HEDGED)

$(addprefix $(BUILD)/tests/bench/,store checks lists): $(BUILD)/%: $(BUILD)/obj/%.o $(LIBRARIES)
	@mkdir -p $(@D)
	@echo "LD $@"
	$(Q)$(CC) $(LDFLAGS) -o $@ $^ $(DAEMON_LIBS)

# ONLY chooses rows: writers is tests/bench/store.c, tests/bench/store_daemon.py has the others.
STORE_ROWS = $(or $(ONLY),writers snapshots start log reads)
bench-store: $(HEDGED) $(BUILD)/tests/bench/store | $(INSTALLED) ## what durable edits cost, beside the same bytes written and synced, and beside memory; ONLY="writers snapshots start log reads" for some, ROUNDS=
	@mkdir -p build/durable
	@$(if $(filter writers,$(STORE_ROWS)),$(BUILD)/tests/bench/store build/durable $(lastword $(GIVEN_ROUNDS)))
	@$(if $(filter-out writers,$(STORE_ROWS)),python3 -B tests/bench/store_daemon.py --hedged $(abspath $(HEDGED)) \
	    --work build/durable --only $(filter-out writers,$(STORE_ROWS)) $(GIVEN_ROUNDS))

bench-events: $(HEDGED) $(BUILD)/tests/bench/http/listeners ## a thousand listeners: memory, and time to reach them all
	@sh tests/bench/events.sh $(HEDGED) $(BUILD)/tests/bench/http/listeners

bench-slow: $(HEDGED) $(BUILD)/tests/bench/http/bare | $(INSTALLED) ## a thousand clients who read slowly: what others wait for, and when those are closed
	@sh tests/bench/slow.sh $(HEDGED) $(BUILD)/tests/bench/http/bare

bench-flood: $(HEDGED) $(BUILD)/tests/bench/http/paced | $(INSTALLED) ## one token far beyond its rate, 10,000 idle and 1,000 slow clients: what others wait for
	@sh tests/bench/flood.sh $(HEDGED) $(BUILD)/tests/bench/http/paced

bench-fair: $(HEDGED) $(BUILD)/tests/bench/http/paced | $(INSTALLED) ## small requests beside imports, exports, decimations and checks of a million faces: what they wait for
	@sh tests/bench/fair.sh $(HEDGED) $(BUILD)/tests/bench/http/paced

bench-large: $(HEDGED) | $(INSTALLED) ## a million quads through the daemon: times and memory
	@sh tests/bench/large.sh $(HEDGED)

# Runs each benchmark in REPORTS by itself, and writes what it printed into tests/bench/README.md.
# RUNS, BENCH, SCALE, MINUTES and LOAD are passed on to the benchmarks.
REPORTS  ?= bench bench-reshape bench-http bench-store bench-events bench-slow bench-flood bench-fair bench-large bench-space soak
REPORTED  = $(strip make $(1) $(foreach v,BENCH RUNS SCALE MINUTES LOAD,$(if $(filter command%,$(origin $(v))),$(v)=$($(v)))))
report: | $(INSTALLED) ## runs REPORTS="bench soak" and writes what they print into tests/bench/README.md
	@mkdir -p build
	@$(foreach name,$(REPORTS),echo "$(call REPORTED,$(name))" && \
	    $(MAKE) --no-print-directory $(name) >build/$(name).txt && \
	    node tests/bench/report.mjs $(name) "$(call REPORTED,$(name))" <build/$(name).txt &&) true

$(patsubst %.c,$(BUILD)/%,$(HTTP_C)): $(BUILD)/%: $(BUILD)/obj/%.o
	@mkdir -p $(@D)
	@echo "LD $@"
	$(Q)$(CC) $(LDFLAGS) -o $@ $^ $(DAEMON_LIBS)

# --- style ---------------------------------------------------------------------------------

# The programs that check the OpenAPI document have a lock file of their own, so that a build of the
# page does not download them.
$(STAMPS)/openapi: .ci/openapi/package.json .ci/openapi/package-lock.json | $(INSTALLED)
	@mkdir -p build/openapi
	cp .ci/openapi/package.json .ci/openapi/package-lock.json build/openapi
	cd build/openapi && npm ci --no-audit --no-fund --ignore-scripts
	@touch $@

lint: $(LIBRARIES) $(HEDGED) $(STAMPS)/openapi | $(INSTALLED) ## formatting, names, directions of includes, static analysis
	@sh .ci/lint "$(CPPFLAGS) $(CFLAGS)" $(BUILD) $(HEADERS) $(ALL_C)

format: | $(INSTALLED) ## rewrite all C files as .clang-format says
	clang-format -i $(HEADERS) $(ALL_C) $(PEER_CC) tests/bench/peers/*.h

# --- the rest ------------------------------------------------------------------------------

screenshot: $(HEDGED) page | $(INSTALLED) ## the README's picture, web/screenshot.png
	HEDGED=$(abspath $(HEDGED)) node tests/web/screenshot.mjs

container: | $(INSTALLED) ## build the image with buildah and try it (root)
	@sh tests/container.sh

# TARGETS="lint bench-http" selects commands; the table in README.md lists all of them.
fresh: | $(INSTALLED) ## each command of the README's table alone, in a bare Debian (root); TARGETS="lint fuzz" for some
	@sh tests/fresh.sh

$(BUILD)/hedged.8: $(HEDGED) server/hedged.8.in .ci/man api/metric/metric_rows.h
	$(Q)sh .ci/man $(HEDGED) server/hedged.8.in api/metric/metric_rows.h >$@

# The unit is put where systemd looks for it; with a PREFIX of one's own, UNITS=/etc/systemd/system
# says where that is.
install: $(HEDGED) $(BUILD)/hedged.8 page ## to DESTDIR and PREFIX (/usr/local)
	install -D -m 755 $(HEDGED) $(DESTDIR)$(PREFIX)/bin/hedged
	install -D -m 644 $(BUILD)/hedged.8 $(DESTDIR)$(PREFIX)/share/man/man8/hedged.8
	install -D -m 644 LICENSE $(DESTDIR)$(PREFIX)/share/doc/hedge/LICENSE
	install -D -m 644 server/alerts.yaml $(DESTDIR)$(PREFIX)/share/hedge/alerts.yaml
	install -d $(DESTDIR)$(UNITS)
	sed 's|@PREFIX@|$(PREFIX)|' server/hedged.service.in >$(DESTDIR)$(UNITS)/hedged.service
	chmod 644 $(DESTDIR)$(UNITS)/hedged.service
	find $(PAGE) -type f | while read -r file; do \
	    install -D -m 644 "$$file" "$(DESTDIR)$(PREFIX)/share/hedge/web/$${file#$(PAGE)/}" || exit 1; \
	done

# Stored meshes and settings are kept.
uninstall: ## what install put there, with its DESTDIR and PREFIX; stop and disable the service first
	rm -f $(DESTDIR)$(PREFIX)/bin/hedged $(DESTDIR)$(PREFIX)/share/man/man8/hedged.8 \
	    $(DESTDIR)$(UNITS)/hedged.service
	rm -rf $(DESTDIR)$(PREFIX)/share/hedge $(DESTDIR)$(PREFIX)/share/doc/hedge

clean: ## remove build/
	rm -rf build
