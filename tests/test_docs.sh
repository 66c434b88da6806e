#!/bin/sh
# Every `ctest -R PATTERN` of the documents names a test that there is: test_docs.sh BUILD SOURCE
set -u
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
ctest --test-dir "$1" -N | sed -n 's/^ *Test *#[0-9]*: //p' >"$scratch/names"
# In a table a bar is escaped.
cat "$2"/README.md "$2"/docs/*.md "$2"/docs/*/*.md | grep -o "ctest [^\`]*-R [^\`]*" |
    sed "s/^.*-R //; s/\\\\*|/|/g; s/^'\([^']*\)'.*/\1/; s/ .*//" | sort -u >"$scratch/patterns"
failures=0
while read -r pattern; do
    for part in $(echo "$pattern" | tr '|' ' '); do
        # the browser's test is there where a browser is, the FMU's where static libraries serve it
        [ "$part" = browser ] || [ "$part" = fmu ] || grep -q -E -e "$part" "$scratch/names" && continue
        echo "FAILED: no test is named by '$part' of 'ctest -R $pattern'"
        failures=$((failures + 1))
    done
done <"$scratch/patterns"
[ "$(wc -l <"$scratch/patterns")" -ge 20 ] || { echo 'FAILED: few commands were found'; failures=1; }
[ $failures -eq 0 ]
