#!/bin/sh
# clients.sh HEDGED - checks that the clients that generators make of the OpenAPI document compile
# in strict mode and do their work.
#
# The document comes from the running daemon. Each client has a program, which tells the story of
# tests/clients/story.ts: first to the daemon, then to Prism, which passes everything on to the
# daemon and compares it with the document. Spectral reads the document, too (redocly does in `make
# lint`). build/clients has these programs (Makefile), and what they made in work/. CLIENTS selects
# clients; JUDGES=prism leaves Spectral out, JUDGES=spectral Prism. The last line is
# `N passed, N failed`.
set -u

hedged=$(realpath "$1")
cd "$(dirname "$0")/../build/clients" || exit 1
# Some generators need a newer node than Debian's. It comes from packages that contain the program
# alone; npm's package `node` downloads these by a script, which the lock file says nothing of.
for modern in "$PWD"/node_modules/node-linux-*/bin; do
    PATH=$modern:$PATH
done
clients=${CLIENTS:-openapi-typescript hey-api swagger-typescript-api orval kubb}
judges=${JUDGES:-spectral prism}
daemon=
proxy=
passed=0
failed=0
stop() {
    [ -z "$proxy" ] || kill "$proxy"
    [ -z "$daemon" ] || kill "$daemon"
}
trap stop EXIT
trap 'exit 1' INT TERM

# try WHAT COMMAND...: counts one success or failure, and shows what the command said if it failed
try() {
    what=$1
    shift
    if "$@" >work/said 2>&1; then
        passed=$((passed + 1))
        echo "ok $what"
        return 0
    fi
    failed=$((failed + 1))
    tail -n 40 work/said
    echo "FAILED $what"
    return 1
}

# run PROGRAM ARGUMENT...: runs a program of a package, which may take five minutes
run() {
    program=$1
    shift
    timeout 300 node "node_modules/.bin/$program" "$@"
}

generate() {
    made=./work/$1/made
    case $1 in
    openapi-typescript) run openapi-typescript "$document" -o "$made/schema.ts" ;;
    hey-api) run openapi-ts -i "$document" -o "$made" -c @hey-api/client-fetch --no-log-file ;;
    swagger-typescript-api)
        run swagger-typescript-api generate -p "$document" -o "$made" -n api.ts
        ;;
    orval) run orval --config orval.config.mjs ;;
    kubb) run kubb generate --config kubb.config.mjs ;;
    *)
        echo "there is no client of $1"
        return 1
        ;;
    esac
}

compile() {
    run tsc --strict --noEmitOnError --target es2022 --module nodenext --skipLibCheck \
        --rewriteRelativeImportExtensions --types node --lib es2023,dom,dom.iterable \
        --rootDir work --outDir out "work/$1/program.ts"
}

# tell CLIENT URL: lets the program of a client tell its story
tell() {
    timeout 60 node "out/$1/program.js" "$2"
}

client() {
    mkdir -p "work/$1/made"
    cp story.ts "work/$1/story.ts"
    cp "$1.ts" "work/$1/program.ts"
    generate "$1" && compile "$1" && tell "$1" "$url"
}

# Starts Prism with its defaults on a port that the system chooses, and sets $proxied to its
# address. With its defaults Prism passes on what the document does not allow, too, and writes a
# line about it, so its log tells whether there was any.
start_prism() {
    mkfifo work/prism
    timeout 600 node node_modules/.bin/prism proxy -p 0 "$document" "$url" >work/prism 2>&1 &
    proxy=$!
    proxied=
    exec 3<work/prism
    while [ -z "$proxied" ] && read -r line <&3; do
        echo "$line"
        case $line in *'is listening on http'*) proxied=http${line##*is listening on http} ;; esac
    done
    # The rest is what Prism says of requests. This ends when Prism does.
    cat <&3 >work/prism.log &
    reader=$!
    exec 3<&-
    [ -n "$proxied" ]
}

# Sends what the document does not allow, which shows how Prism's log tells it.
misbehave() {
    timeout 60 node -e 'fetch(process.argv[1]).then(({ status }) => {
        process.exitCode = status === 400 ? 0 : 1; })' "$proxied/v1/meshes?limit=none"
}

# saw COUNT: requires that Prism saw COUNT requests of clients and the one of misbehave, and found
# a violation in that one alone
saw() {
    count=$(grep -c 'Request received' work/prism.log)
    echo "Prism saw $count requests; clients sent $1"
    grep -E 'Violation|warning|error|fatal' work/prism.log >work/prism.found
    ! grep -v 'Violation: request.query.limit ' work/prism.found && [ -s work/prism.found ] &&
        [ "$1" -gt 0 ] && [ "$count" -eq $(($1 + 1)) ]
}

judge_traffic() {
    try 'prism listens' start_prism || return
    sent=0
    for name in $compiled; do
        try "the client of $name does its work through prism" tell "$name" "$proxied" &&
            sent=$((sent + $(sed -n 's/^\([0-9]*\) requests were answered well$/\1/p' work/said)))
    done
    try 'what the document does not allow is sent through prism, too' misbehave
    kill "$proxy"
    wait "$reader"
    proxy=
    try 'prism saw every request, and no violation' saw "$sent"
}

rm -rf work out
mkdir -p work
mkfifo work/log
"$hedged" --listen 127.0.0.1:0 --store memory --log off 2>work/log &
daemon=$!
line=$(sed -n '/listening on /{p;q}' work/log)
url=${line##*listening on }
document=./work/openapi.json
if ! node -e 'fetch(process.argv[1]).then((answer) => answer.text()).then((text) => {
    process.stdout.write(text); })' "$url/v1/openapi.json" >"$document"; then
    echo 'FAILED nothing was tried: the daemon gave no document'
    echo '0 passed, 1 failed'
    exit 1
fi

compiled=
for name in $clients; do
    try "the client of $name compiles and does its work" client "$name" &&
        compiled="$compiled $name"
done
case " $judges " in *' prism '*) judge_traffic ;; esac
case " $judges " in
*' spectral '*)
    try 'spectral finds nothing' run spectral lint --fail-severity=warn -r spectral.yaml "$document"
    ;;
esac
echo "$passed passed, $failed failed"
[ "$failed" -eq 0 ] && [ "$passed" -gt 0 ]
