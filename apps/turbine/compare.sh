#!/bin/sh
# Compares a run with its reference:  apps/turbine/compare.sh out/runup apps/turbine/reference-runup.csv
# One line per channel that both have with the same unit; exit 1 when a tolerance that the
# reference states is exceeded or its channel is missing. Histories are compared at equal time and
# at equal rotor angle; tolerances of histories hold at equal angle.
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

# The run where abscissa a (1: time, 2: rotor angle) is x, linear between rows; x ascends from call
# to call.
function at(a, x, i,   k, x0, x1) {
    while (row[a] < rows && abscissa[a, row[a] + 1] <= x + 1e-9) row[a]++
    k = row[a]
    if (k == rows) return value[k, i]
    x0 = abscissa[a, k]; x1 = abscissa[a, k + 1]
    return value[k, i] + (value[k + 1, i] - value[k, i]) * (x - x0) / (x1 - x0)
}

# An angle in degrees continued from the one before over full turns.
function continued(angle, before,   turn) {
    turn = (angle - before) % 360
    if (turn < -180) turn += 360
    if (turn >= 180) turn -= 360
    return before + turn
}

function prepare(   k, angle) {
    row[1] = row[2] = 1
    if (!("Azimuth_[deg]" in column)) fail(results " has no channel Azimuth in deg: no rotor'\''s run")
    angle = column["Azimuth_[deg]"]
    for (k = 1; k <= rows; k++) {
        abscissa[1, k] = value[k, 1]
        abscissa[2, k] = continued(value[k, angle], k > 1 ? abscissa[2, k - 1] : 0)
    }
}

BEGIN { FS = ","; read_results(); prepare() }
/^# tolerance/ { split($0, word, " "); allowed[word[3], word[4]] = word[5]; wanted[word[3]]; next }
/^#/ { next }
!names { names = NF; for (i = 1; i <= NF; i++) title[i] = $i; next }
$1 > value[rows, 1] + 1e-9 { missing++; next }
{
    turned = continued($2, turned)
    for (i = 3; i <= names; i++) {
        if (!(title[i] in column)) continue
        own = at(1, $1, column[title[i]])
        if (turned <= abscissa[2, rows]) {
            off = abs(at(2, turned, column[title[i]]) - $i)
            if (off > worst_angle[i]) worst_angle[i] = off
        }
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
    printf "%-18s %12s %12s %7s %12s %12s %7s %9s %7s %9s\n", "channel", "mean 30-40 s",
        "reference", "off %", "peak", "reference", "off %", "in time %", "at s", "in angle %"
    for (i = 3; i <= names; i++) {
        if (!(title[i] in column)) continue
        shared++
        name = title[i]; sub(/_\[.*/, "", name); delete wanted[name]
        of_mean = averaged ? percent(own_mean[i] - mean[i], mean[i]) : 999
        of_peak = percent(own_peak[i] - peak[i], peak[i])
        in_time = percent(worst[i], peak[i])
        in_angle = percent(worst_angle[i], peak[i])
        n = averaged ? averaged : 1
        printf "%-18s %12.6g %12.6g %7.2f %12.6g %12.6g %7.2f %9.2f %7.2f %9.2f %s%s%s\n", title[i],
            own_mean[i] / n, mean[i] / n, of_mean, own_peak[i], peak[i], of_peak, in_time, when[i],
            in_angle, judge(name, "mean", of_mean), judge(name, "peak", of_peak),
            judge(name, "history", in_angle)
    }
    if (!shared) {
        print "nothing to compare: " results " has none of the channels of " ARGV[1] ", by name and unit"
        exit 1
    }
    for (name in wanted) { print "missing: " name; code = 1 }
    if (missing) { print "the run ends " missing " rows before the reference"; code = 1 }
    print code ? "outside the tolerances" : "within the tolerances"
    exit code
}' "$2"
