#!/bin/sh
# lint.sh - checks that `make lint` finds what it must find: plants one fault of each kind in a copy
# of the sources, and runs the check that must find it. The last line is `N passed, N failed`.
#
# The libraries of a build are needed; BUILD (build) is its folder.
set -u

build=$(cd "${BUILD:-build}" && pwd) || exit 1
copy=$(mktemp -d) || exit 1
trap 'rm -rf "$copy"' EXIT
passed=0
failed=0

cp -R .ci core api server README.md STYLE.md Makefile Dockerfile "$copy"
mkdir "$copy/web" && cp web/package.json "$copy/web"
cd "$copy" || exit 1

sources() {
    find core api server -name '*.[ch]' | sort
}

# verdict NAME STATUS OUTPUT WORDS: requires that the check failed with WORDS in its output or,
# without WORDS, that it passed
verdict() {
    if { [ -z "$4" ] && [ "$2" -eq 0 ]; } ||
        { [ -n "$4" ] && [ "$2" -ne 0 ] && printf '%s' "$3" | grep -q -- "$4"; }; then
        passed=$((passed + 1))
    else
        failed=$((failed + 1))
        printf 'FAILED %s (exit %s)\n%s\n' "$1" "$2" "$3"
    fi
}

# expect NAME WORDS COMMAND...: runs a check, and calls verdict with its result
expect() {
    name=$1
    words=$2
    shift 2
    output=$("$@" 2>&1)
    verdict "$name" $? "$output" "$words"
}

# shellcheck disable=SC2046 # paths without blanks
includes() { awk -f .ci/lint-includes $(sources); }
# shellcheck disable=SC2046
names() { awk -f .ci/lint-names $(sources); }
# shellcheck disable=SC2046
structs() { awk -f .ci/lint-structs $(sources); }
# shellcheck disable=SC2046
slots() { awk -f .ci/lint-slots $(sources); }
parameters() { python3 .ci/lint-parameters $(sources); }

expect 'the rooms are in order as they are' '' includes
expect 'every name is defined once as it is' '' names
expect 'every struct of functions is listed as it is' '' structs
expect 'every slot is named after what it holds as it is' '' slots
expect 'functions take few parameters, or are listed, as it is' '' parameters

mkdir core/attic
echo 'int nothing;' >core/attic/loose.c
expect 'a file outside a room is found' 'no room' includes
rm -r core/attic

echo '#include "op/op.h"' >>core/mesh/mesh.h
expect 'an include against the order is found' 'core/mesh is below core/op' includes
cp "$OLDPWD/core/mesh/mesh.h" core/mesh/mesh.h

# Two rooms include each other, so one of the two includes must run upward.
echo '#include "api/write/edit_cost.h"' >>api/read/elements.h
echo '#include "api/read/elements.h"' >>api/write/edit_cost.h
expect 'a circle between rooms is found' 'api/read is below api/write' includes
cp "$OLDPWD/api/read/elements.h" api/read/elements.h
cp "$OLDPWD/api/write/edit_cost.h" api/write/edit_cost.h

printf '\nint he_edge_split(void)\n{\n    return 0;\n}\n' >>core/repair/fill.c
expect 'a prefixed name that is defined twice is found' 'he_edge_split is defined in' names
cp "$OLDPWD/core/repair/fill.c" core/repair/fill.c

printf '\ntypedef struct api_planted {\n    void (*begin)(void *self);\n    void (*end)(void *self);\n} api_planted;\n' >>api/limits.h
expect 'a struct of functions that is not listed is found' 'api_planted is a struct' structs
cp "$OLDPWD/api/limits.h" api/limits.h

# plant_slot NAME WORDS SCRIPT: changes the rows of edges by a script of sed, which must be found
plant_slot() {
    sed -i "$3" core/op/edge_rows.c
    expect "$1" "$2" slots
    cp "$OLDPWD/core/op/edge_rows.c" core/op/edge_rows.c
}
plant_slot 'a bare number for an argument is found' 'a bare number, 0, stands for an argument' \
    's/args\[EDGE_FLIP_EDGE\]/args[0]/'
plant_slot 'a bare number for a result is found' 'a bare number, 0, stands for a result' \
    's/he_results_set(out, EDGE_FLIP_OUT_EDGE,/he_results_set(out, 0,/'
plant_slot 'a bare number for a list of results is found' 'a bare number, 2, stands for a result' \
    's/he_results_add(out, EDGE_SPLIT_OUT_FACES,/he_results_add(out, 2,/'
plant_slot "another operation's slot is found" 'EDGE_JOIN_OUT_EDGE is not a slot of the results of run_edge_flip' \
    's/he_results_set(out, EDGE_FLIP_OUT_EDGE,/he_results_set(out, EDGE_JOIN_OUT_EDGE,/'
plant_slot 'a slot of results among the arguments is found' 'EDGE_FLIP_OUT_EDGE is not a slot of the arguments' \
    's/args\[EDGE_FLIP_EDGE\]/args[EDGE_FLIP_OUT_EDGE]/'
plant_slot 'a parameter in the slot of another is found' '"to" is placed in EDGE_COLLAPSE_T,' \
    's/\[EDGE_COLLAPSE_TO\] =/[EDGE_COLLAPSE_T] =/'
plant_slot 'a parameter without its slot is found' '"width" is placed without its slot, EDGE_BEVEL_WIDTH' \
    's/\[EDGE_BEVEL_WIDTH\] =//'
plant_slot 'a renamed result is found' '"side" is placed in EDGE_BEVEL_OUT_FACE' \
    's/\(EDGE_BEVEL_OUT_FACE\] = {\)"face"/\1"side"/'
plant_slot 'a slot that no row places is found' 'no row places EDGE_FLIP_SPARE' \
    's/enum { EDGE_FLIP_EDGE/&, EDGE_FLIP_SPARE/'
printf '\nvoid he_planted(const he_mesh *m, int a, int (*b)(int, int), int c, int d, int e,\n                he_error *err);\n' >>core/mesh/walk.h
expect 'five parameters beside the mesh and the error pass' '' parameters
printf '\nvoid he_crowded(const he_mesh *m, int a, int (*b)(int, int), int c, int d,\n                int e, int f, he_error *err);\n' >>core/mesh/walk.h
expect 'a sixth parameter is found' 'he_crowded takes 6 parameters' parameters
cp "$OLDPWD/core/mesh/walk.h" core/mesh/walk.h
echo 'core/mesh he_crowded 6' >>.ci/parameters
expect 'a function that is listed and has few parameters is found' 'he_crowded takes fewer than 6' parameters
cp "$OLDPWD/.ci/parameters" .ci/parameters

words() { sh .ci/lint-words api/read/elements.c; }
expect 'a handler that takes its mesh as it is given passes' '' words
printf '\nconst void *planted(st_mesh *mesh)\n{\n    return st_read_begin(mesh, 0);\n}\n' >>api/read/elements.c
expect 'a handler that obtains its mesh itself is found' 'a handler is given its mesh' words
cp "$OLDPWD/api/read/elements.c" api/read/elements.c

plain() { sh .ci/lint-words core/mesh/walk.h; }
expect 'comments that name what they are about pass' '' plain
for words in '/* The same for the other end. */' '/* Of both ends. */' '/* For callers. */' \
    '// Likewise for faces' '/*\n * Of both ends. */'; do
    # shellcheck disable=SC2059 # the words contain a line feed
    printf "\n$words\n" >>core/mesh/walk.h
    expect "a comment that begins '$words' is found" 'names what it is about' plain
    cp "$OLDPWD/core/mesh/walk.h" core/mesh/walk.h
done
plain() { sh .ci/lint-words api/limits.h; }
printf '\n/* Of both ends. */\n' >>api/limits.h
expect 'such a comment is found outside of core, too' 'names what it is about' plain
cp "$OLDPWD/api/limits.h" api/limits.h

plain() { sh .ci/lint-words tests/unit/planted.c; }
mkdir -p tests/unit
echo 'static void a_hole_is_filled(void **state)' >tests/unit/planted.c
expect 'a test whose name says what holds passes' '' plain
for name in test_holes test_cf4_join; do
    echo "static void $name(void **state)" >tests/unit/planted.c
    expect "a test that is named $name is found" 'says in its name what holds' plain
done
rm -r tests

for n in $(seq 40); do echo "int he_planted_$n;" >"core/op/planted_$n.c"; done
expect 'a room of too many files is found' 'more than one room' includes
rm core/op/planted_*.c

# The check of pages needs only the names of the tests and of the manual's sources, which are not in
# the copy.
for file in $(cd "$OLDPWD" && find tests web/manual -type f -not -path '*/.*'); do
    mkdir -p "$(dirname "$file")" && : >"$file"
done
cp "$OLDPWD/tests/README.md" tests/README.md
# shellcheck disable=SC2046
pages() { awk -f .ci/lint-pages $(find ./* -type f | sed 's/^..//'); }
expect 'the pages are as the tree is' '' pages
echo 'core/attic' >>.ci/rooms
expect 'a room without a row is found' 'core/README.md: no row of the room attic' pages
sed -i '/attic/d' .ci/rooms
sed -i '/^| `query` |/d' core/README.md
expect 'a row that is missing is found' 'the room solve stands where .ci/rooms has query' pages
cp "$OLDPWD/core/README.md" core/README.md
mkdir tests/attic && : >tests/attic/run.py
expect 'a folder of tests without a row is found' 'no row of tests/attic' pages
rm -r tests/attic
mv api/write/decode_op.c api/write/decoded_op.c
expect 'a file that is named and gone is found' 'there is no file decode_op.c' pages
mv api/write/decoded_op.c api/write/decode_op.c
sed -i 's/\bapi_edits_decode\b/api_edits_planted/' api/write/edits.c
expect 'a function that is gone from its file is found' 'api/write/edits.c has no api_edits_decode' pages
cp "$OLDPWD/api/write/edits.c" api/write/edits.c

expect 'the version is one everywhere' '' sh .ci/lint-version
sed -i 's/image.version="/&9/' Dockerfile
expect 'a version that differs is found' 'Dockerfile says' sh .ci/lint-version
cp "$OLDPWD/Dockerfile" Dockerfile

mkdir libraries
cp "$build"/lib*.a libraries
expect 'symbols are as they should be' '' sh .ci/lint-symbols libraries
printf '#include <pthread.h>\nint he_planted(pthread_t *t, void *(*f)(void *))\n{\n    return pthread_create(t, 0, f, 0);\n}\n' >planted.c
gcc -c -o planted.o planted.c && ar q libraries/libkernel.a planted.o
expect 'a thread in the kernel is found' 'pthread_create' sh .ci/lint-symbols libraries
cp "$build"/libkernel.a libraries
printf 'int srv_planted(void);\nint api_planted(void)\n{\n    return srv_planted();\n}\n' >planted.c
gcc -c -o planted.o planted.c && ar q libraries/libapi.a planted.o
expect 'a call from api into server is found' 'libapi.a calls what lies above it.*srv_planted' \
    sh .ci/lint-symbols libraries

echo "$passed passed, $failed failed"
[ "$failed" -eq 0 ]
