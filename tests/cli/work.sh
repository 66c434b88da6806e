# shellcheck shell=sh
# For tests that look at what the program writes, sourced with $bough set: scratch.sh, and inside its folder an empty
# one to work in.
. "$(dirname "$0")/scratch.sh"
mkdir work
cd work || exit 1

empty() { [ ! -s "$1" ] || fail "$said: $1 should be empty, has: $(cat "$1")"; }
exists() { [ -e "$1" ] || fail "$said: no $1"; }
missing() { [ ! -e "$1" ] || fail "$said: $1 should not exist"; }
nothing_written() { [ -z "$(ls -A .)" ] || fail "$said: wrote $(ls -A .)"; }

# refused MESSAGE ARGUMENT...: a usage error on stderr, and nothing done.
refused() {
    message=$1
    shift
    expect 2 "$@"
    has ../stderr "$message"
    empty ../stdout
    nothing_written
}
