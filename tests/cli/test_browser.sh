#!/bin/sh
# bough report's pages open in a browser: their program runs to its end without an error.
# test_browser.sh BOUGH SOURCE BROWSER
set -eu
bough=$1 source=$2 browser=$3
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT

opens() {
    "$bough" report "$@"
    "$browser" --headless --no-sandbox --disable-gpu --user-data-dir="$folder/profile" \
        --virtual-time-budget=3000 --dump-dom "file://$1/report.html" >"$folder/dom" 2>/dev/null
    grep -q '<body data-ready="yes"' "$folder/dom" || {
        grep -o '<body[^>]*>' "$folder/dom"
        exit 1
    }
}

"$bough" run "$source/apps/mechanisms/pendulum.yaml" --out "$folder/run" --quiet \
    --set 'simulation.output.frames=0.1 s' >/dev/null
opens "$folder/run"
grep -q "\[deg\]" "$folder/dom" # its channels can be picked
grep -q '<section id="motion">' "$folder/dom"
grep -q '<th class="words">interface</th>' "$folder/dom"

"$bough" run "$source/apps/mechanisms/pendulum.yaml" --out "$folder/other" --quiet \
    --set 'gravity=[0, 0, -1.62]' >/dev/null
opens "$folder/run" "$folder/other"
grep -q "<td class=\"words\">bobPos $folder/other</td>" "$folder/dom" || grep -q "bobPos [^<]*other</td>" "$folder/dom"

mkdir "$folder/study"
echo 'a table' >"$folder/study/table.txt"
echo '<svg xmlns="http://www.w3.org/2000/svg"><rect/></svg>' >"$folder/study/plot.svg"
opens "$folder/study"
grep -q '<img src="data:image/svg+xml,%3Csvg' "$folder/dom"
grep -q '#plot img { max-width: none; }' "$folder/dom" # legible on narrow screens: it scrolls

mkdir "$folder/cases"
printf 'case,quantity,result,verdict\n"a, b",tip,1.5,pass\nc,tip,nan,FAIL\n' >"$folder/cases/verify.csv"
opens "$folder/cases"
grep -q '<td class="words">a, b</td>' "$folder/dom"
grep -q '<td class="words good">pass</td>' "$folder/dom"
grep -q '<td class="words bad">FAIL</td>' "$folder/dom"
mkdir "$folder/loads"
printf 'title\na table\n' >"$folder/loads/table.txt"
printf 'case,load case,settings,occurrences [1],outcome,A mean [m]\n1,DLC1.2,"speed=8, seed=1",1,ok,2\n' \
    >"$folder/loads/cases.csv"
printf 'channel,unit,extreme,value\nA,m,min,1\n' >"$folder/loads/extremes.csv"
opens "$folder/loads"
grep -q '<option value="0">A mean \[m\]' "$folder/dom"
grep -q '<option value="1">speed' "$folder/dom"
grep -q '<td class="words">min</td>' "$folder/dom"
echo "all pages opened"
