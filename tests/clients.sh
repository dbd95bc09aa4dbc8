#!/bin/sh
# clients.sh HEDGED - checks that the clients that generators make of the OpenAPI document compile
# in strict mode and do their work.
#
# The document comes from the running daemon. A generator counts once for its client, whose program
# tells the story of tests/clients/story.ts to the daemon, and once for what Prism, as a proxy
# before the daemon, says of the same traffic. build/clients has the generators (Makefile), and what
# they made in work/. The last line is `N passed, N failed`.
set -u

hedged=$(realpath "$1")
cd "$(dirname "$0")/../build/clients" || exit 1
export REDOCLY_TELEMETRY=off REDOCLY_SUPPRESS_UPDATE_NOTICE=true
# Some generators need a newer node than Debian's.
for modern in "$PWD"/node_modules/node-linux-*/bin; do
    PATH=$modern:$PATH
done
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

bin() {
    name=$1
    shift
    node "node_modules/.bin/$name" "$@"
}

generate() {
    case $1 in
    openapi-typescript) bin openapi-typescript work/openapi.json -o work/openapi-typescript/made/schema.ts ;;
    hey-api) bin openapi-ts -i work/openapi.json -o work/hey-api/made -c @hey-api/client-fetch --no-log-file ;;
    swagger-typescript-api)
        bin swagger-typescript-api generate -p work/openapi.json -o work/swagger-typescript-api/made -n api.ts
        ;;
    orval) bin orval --config orval.config.mjs ;;
    kubb) bin kubb generate --config kubb.config.mjs ;;
    esac
}

compile() {
    bin tsc --strict --noEmit false --noEmitOnError --target es2022 --module nodenext --skipLibCheck \
        --rewriteRelativeImportExtensions --types node --lib es2023,dom,dom.iterable \
        --rootDir work --outDir out "work/$1/program.ts"
}

client() {
    mkdir -p "work/$1/made"
    cp story.ts "work/$1/story.ts"
    cp "$1.ts" "work/$1/program.ts"
    generate "$1" && compile "$1" && node "out/$1/program.js" "$url"
}

# Prism writes each violation into a header of the answer, and a line for it; with --errors it
# answers 500 instead, which the program sees.
proxied() {
    node "out/$1/program.js" "http://127.0.0.1:$port"
}

rm -rf work out
mkdir -p work
mkfifo work/log
"$hedged" --listen 127.0.0.1:0 --store memory --log off 2>work/log &
daemon=$!
line=$(sed -n '/listening on /{p;q}' work/log)
url=${line##*listening on }
if ! node -e 'fetch(process.argv[1]).then((a) => a.text()).then((text) => process.stdout.write(text))' \
    "$url/v1/openapi.json" >work/openapi.json; then
    echo 'FAILED nothing was tried: the daemon gave no document'
    echo '0 passed, 1 failed'
    exit 1
fi

try 'redocly finds nothing' bin redocly lint --format=codeframe work/openapi.json
try 'spectral finds nothing' bin spectral lint --fail-severity=warn -r spectral.yaml work/openapi.json
made=
for name in ${CLIENTS:-openapi-typescript hey-api swagger-typescript-api orval kubb}; do
    try "the client of $name" client "$name" && made="$made $name"
done

port=$(node -e 'const s = require("net").createServer().listen(0, "127.0.0.1", () => {
    console.log(s.address().port); s.close(); })')
mkfifo work/prism
bin prism proxy --errors -h 127.0.0.1 -p "$port" work/openapi.json "$url" >work/prism 2>&1 &
proxy=$!
# Prism's lines go on into a file after the one that says it listens.
exec 3<work/prism
while read -r line <&3; do
    case $line in *'is listening'*) break ;; esac
done
cat <&3 >work/prism.log &
for name in $made; do
    try "prism allows what the client of $name does" proxied "$name"
done
if grep -iE 'violation|error' work/prism.log; then
    failed=$((failed + 1))
    echo 'FAILED prism saw violations'
fi
echo "$passed passed, $failed failed"
[ "$failed" -eq 0 ] && [ "$passed" -gt 0 ]
