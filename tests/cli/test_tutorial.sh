#!/bin/sh
# A tutorial's commands print what it says. test_tutorial.sh BOUGH SOURCE TUTORIAL.md
#
# A block "yaml NAME" or "c NAME" is a file; in a block "console", "$ " begins a command, "> " continues it, the
# rest is its output. There "..." stands for a word or, last in a line, for the rest. Numbers agree in
# all digits shown but for one unit of the last, since machines round differently. After "~" zeros at the end
# of a whole number are no digits, "~2970" is 2960 to 2980, and a single digit is a size within a factor of
# three: "~2e-5".
set -eu
bough=$1 source=$2 tutorial=$3
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
ln -s "$source/apps" "$folder/apps"
mkdir "$folder/steps"
cd "$folder"
PATH=$(dirname "$bough"):$PATH
export OMP_NUM_THREADS=1

awk '
    /^```(yaml|c) ./ {file = $2; next}
    /^```console$/ {console = 1; next}
    /^```$/ {console = 0; file = ""; next}
    file {print >file}
    console && /^\$ / {n++; command = sprintf("steps/%03d", n); print substr($0, 3) >command; next}
    console && /^> / {print substr($0, 3) >command; next}
    console {print >(command ".want")}
' "$tutorial"
[ -e steps/001 ] || { echo "no commands in $tutorial"; exit 1; }

compare='
    function number(w) {return w ~ /^[-+]?[0-9]+\.?[0-9]*([eE][-+]?[0-9]+)?$/}
    function size(x) {return x < 0 ? -x : x}
    # One unit of the last digit: 0.01 of 2.54, 1e-7 of 1.2e-6.
    function unit(w,   part, dot) {
        split(tolower(w), part, "e")
        dot = index(part[1], ".")
        return 10 ^ ((dot ? dot - length(part[1]) : 0) + part[2])
    }
    function close_by(want, got) {
        if (want == got || want == "...") return 1
        if (want ~ /^~/ && number(got)) {
            about = substr(want, 2)
            last = unit(about)
            if (about !~ /[.eE]/) while (about % (10 * last) == 0) last *= 10
            if (size(about) > 9.5 * last) return size(about - got) <= 1.001 * last
            return got / about > 1 / 3 && got / about < 3
        }
        if (!number(want) || !number(got) || want got ~ /^[-+0-9]*$/) return 0
        off = size(want - got)
        return off <= 1.001 * unit(want)
    }
    # Punctuation that sticks to a number is no part of it.
    function words(line, word) {gsub(/[,;:()]/, " & ", line); return split(line, word, " ")}
    NR == FNR {want[NR] = $0; next}
    {
        m = words(want[FNR], a)
        k = words($0, b)
        if (a[m] == "..." && k > m) k = m
        good = m == k
        for (i = 1; i <= m && good; i++) good = close_by(a[i], b[i])
        if (!good) {print "  expected: " want[FNR]; print "  got:      " $0; bad = 1}
    }
    END {exit bad}'

failed=0
for step in steps/???; do
    sh "$step" >"$step.got" 2>&1 </dev/null || true
    touch "$step.want"
    lines=$(wc -l <"$step.want")
    if [ "$(wc -l <"$step.got")" -ne "$lines" ]; then
        echo "FAILED: $(cat "$step"): $lines lines expected, got:"
        cat "$step.got"
        failed=1
    elif [ "$lines" -gt 0 ] && ! awk "$compare" "$step.want" "$step.got" >"$step.why"; then
        echo "FAILED: $(cat "$step")"
        cat "$step.why"
        failed=1
    fi
done
exit $failed
