# shellcheck shell=sh
# For tests that call the program, sourced with $bough set: a folder of its own, which is removed at the
# end, the number of failures, and what the program answers.
failures=0
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
cd "$scratch" || exit 1
export OPENBLAS_NUM_THREADS=1

fail() {
    echo "FAILED: $*"
    failures=$((failures + 1))
}

# expect CODE ARGUMENT...: runs the program; its output is then in stdout and stderr of the folder.
expect() {
    code=$1
    shift
    said="bough $*"
    "$bough" "$@" >"$scratch/stdout" 2>"$scratch/stderr" </dev/null
    got=$?
    [ "$got" -eq "$code" ] || fail "$said: exit code $got, expected $code: $(head -c 600 "$scratch/stderr")"
}

# has FILE PATTERN: a line of the file matches.
has() { grep -q -e "$2" "$1" || fail "$said: no '$2' in $1: $(head -n 20 "$1")"; }

# says CODE PATTERN ARGUMENT...: runs the program; a line of its output matches.
says() {
    want=$1 pattern=$2
    shift 2
    expect "$want" "$@"
    [ -z "$pattern" ] || grep -q -e "$pattern" "$scratch/stdout" "$scratch/stderr" ||
        fail "$said: no '$pattern' in: $(head -c 600 "$scratch/stdout" "$scratch/stderr")"
}
