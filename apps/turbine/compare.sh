#!/bin/sh
# Compares a run with its reference:  apps/turbine/compare.sh out/runup apps/turbine/reference-runup.csv
# One line per channel that both have with the same unit; exit 1 when a tolerance that the
# reference states is exceeded or its channel is missing.
set -eu
[ $# -eq 2 ] || { echo "usage: $0 RESULTS REFERENCE.csv" >&2; exit 2; }
exec awk -v results="$1/channels.out" '
function abs(x) { return x < 0 ? -x : x }
function fail(text) { print "compare: " text > "/dev/stderr"; code = 2; exit code }
function percent(x, of) { return of == 0 ? (x == 0 ? 0 : 999) : 100 * abs(x) / abs(of) }

function read_results(   line, n, i, unit, name, part) {
    while ((status = (getline line < results)) > 0 && line !~ /^ *Time/) {
        if (line ~ /^INCOMPLETE/) print "compare: " line > "/dev/stderr"
    }
    if (status <= 0) fail("cannot read " results)
    n = split(line, name, " ")
    getline line < results
    split(line, unit, " ")
    for (i = 1; i <= n; i++) column[name[i] "_[" substr(unit[i], 2, length(unit[i]) - 2) "]"] = i
    while ((getline line < results) > 0) {
        split(line, part, " ")
        rows++
        for (i = 1; i <= n; i++) value[rows, i] = part[i]
    }
}

# The run at time t, linear between rows; times ascend from call to call.
function at(t, i,   t0, t1) {
    while (row < rows && value[row + 1, 1] <= t + 1e-9) row++
    if (row == rows) return value[row, i]
    t0 = value[row, 1]; t1 = value[row + 1, 1]
    return value[row, i] + (value[row + 1, i] - value[row, i]) * (t - t0) / (t1 - t0)
}

BEGIN { FS = ","; read_results(); row = 1 }
/^# tolerance/ { split($0, word, " "); allowed[word[3], word[4]] = word[5]; wanted[word[3]]; next }
/^#/ { next }
!names { names = NF; for (i = 1; i <= NF; i++) title[i] = $i; next }
$1 > value[rows, 1] + 1e-9 { missing++; next }
{
    for (i = 2; i <= names; i++) {
        if (!(title[i] in column)) continue
        own = at($1, column[title[i]])
        if (abs($i) > abs(peak[i])) peak[i] = $i
        if (abs(own) > abs(own_peak[i])) own_peak[i] = own
        if (abs(own - $i) > worst[i]) { worst[i] = abs(own - $i); when[i] = $1 }
        if ($1 >= 30) { mean[i] += $i; own_mean[i] += own }
    }
    if ($1 >= 30) averaged++
}

function judge(name, kind, found) {
    if (!((name, kind) in allowed) || found <= allowed[name, kind]) return ""
    code = 1
    return "  " kind " above " allowed[name, kind] " %"
}

END {
    if (code == 2) exit code
    printf "%-18s %12s %12s %7s %12s %12s %7s %9s %7s\n", "channel", "mean 30-40 s", "reference",
        "off %", "peak", "reference", "off %", "history %", "at s"
    for (i = 2; i <= names; i++) {
        if (!(title[i] in column)) continue
        name = title[i]; sub(/_\[.*/, "", name); delete wanted[name]
        of_mean = averaged ? percent(own_mean[i] - mean[i], mean[i]) : 999
        of_peak = percent(own_peak[i] - peak[i], peak[i])
        history = percent(worst[i], peak[i])
        n = averaged ? averaged : 1
        printf "%-18s %12.6g %12.6g %7.2f %12.6g %12.6g %7.2f %9.2f %7.2f%s%s%s\n", title[i],
            own_mean[i] / n, mean[i] / n, of_mean, own_peak[i], peak[i], of_peak, history, when[i],
            judge(name, "mean", of_mean), judge(name, "peak", of_peak),
            judge(name, "history", history)
    }
    for (name in wanted) { print "missing: " name; code = 1 }
    if (missing) { print "the run ends " missing " rows before the reference"; code = 1 }
    print code ? "outside the tolerances" : "within the tolerances"
    exit code
}' "$2"
