# shellcheck shell=sh
# daemon.sh - sourced by the scripts that measure: starts a daemon of the script
# on a free port.
#
# daemon_start HEDGED FLAGS... sets $daemon (its process) and $base (its address), and no variable
# that a script may use for itself; the daemon's log is read and dropped. daemon_stop ends the
# daemon and the processes in $others, and removes $work.
work=$(mktemp -d)
daemon=""; drain=""; others=""

daemon_stop() {
    # shellcheck disable=SC2086 # a list of processes
    kill $daemon $drain $others 2>/dev/null || :
    rm -rf "$work"
}
trap daemon_stop EXIT INT TERM

daemon_start() {
    mkfifo "$work/log"
    "$@" --listen 127.0.0.1:0 --store "${store:-memory}" 2>"$work/log" &
    daemon=$!
    exec 4<"$work/log"
    base=
    while [ -z "$base" ] && read -r daemon_line <&4; do
        case $daemon_line in *"listening on "*) base=${daemon_line##*listening on } ;; esac
    done
    cat <&4 >/dev/null &
    drain=$!
}
