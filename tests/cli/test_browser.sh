#!/bin/sh
# bough report's pages open in a browser: their program runs to its end without an error.
# test_browser.sh BOUGH SOURCE BROWSER
set -eu
bough=$1 source=$2 browser=$3
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT

# shows FOLDER [OPTION]...: the page after its program has run, and what the program below finds.
shows() {
    page=$1/report.html
    shift
    cat "$page" - >"$folder/page.html" <<'END'
<script>
const seen = document.body.dataset, visible = list => [...list].filter(x => x.offsetParent !== null).length;
seen.fits = document.documentElement.scrollWidth <= innerWidth && [...document.querySelectorAll("canvas")].every(
    c => c.getBoundingClientRect().right <= c.parentElement.getBoundingClientRect().right + .5);
seen.tiles = visible(document.querySelectorAll("#figures div"));
seen.empty = [...document.querySelectorAll("tr")].filter(
    r => r.querySelector("td:nth-child(2)") && [...r.cells].slice(1).every(c => c.textContent === "–")).length;
if (data.channels) {
    const find = document.getElementById("find"), picks = document.querySelectorAll("#picks label");
    find.value = "angle JOINT";
    find.dispatchEvent(new Event("input"));
    seen.found = visible(picks);
    find.value = "";
    find.dispatchEvent(new Event("input"));
    seen.all = visible(picks);
    const chart = document.getElementById("chart"), width = chart.clientWidth;
    const mouse = (kind, x) => chart.dispatchEvent(new MouseEvent(kind,
        {clientX: chart.getBoundingClientRect().left + x, clientY: chart.getBoundingClientRect().top + 50}));
    mouse("mousedown", 66 + .5 * (width - 80));
    mouse("mousemove", width - 14);
    mouse("mouseup", width - 14);
    seen.span = document.getElementById("window").textContent;
}
</script>
END
    "$browser" --headless --no-sandbox --disable-gpu --user-data-dir="$folder/profile" "$@" \
        --virtual-time-budget=3000 --dump-dom "file://$folder/page.html" >"$folder/dom" 2>/dev/null
    if grep -q 'data-broken=\|data-fits="false"' "$folder/dom"; then
        grep -o '<body[^>]*>' "$folder/dom"
        exit 1
    fi
}

has() { # PATTERN
    grep -q -e "$1" "$folder/dom" && return 0
    echo "FAILED: no $1 in $page: $(grep -o '<body[^>]*>' "$folder/dom")"
    exit 1
}

opens() {
    "$bough" report "$@"
    shows "$1"
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
has '<th class="words">solver</th>'
has 'data-fits="true"'
has 'data-tiles="4"' # the first channels, each with its error
has '<small>[^<]*error at most [0-9]'
has 'data-empty="0"'                            # no row of dashes
has 'data-found="1"'                            # "angle of the joint about its axis"
has 'data-all="5"'
has 'data-span="Amplitude over frequency from 5.[0-9]* to 10 s' # the spectrum is that of the chosen span
has '<button id="play">pause'
shows "$folder/run" --force-prefers-reduced-motion --window-size=500,900 # chromium has no narrower window
has '<button id="play">play'
has 'data-fits="true"'

"$bough" run "$source/apps/mechanisms/pendulum.yaml" --out "$folder/other" --quiet \
    --set 'gravity=[0, 0, -1.62]' >/dev/null
opens "$folder/run" "$folder/other"
grep -q "<td class=\"words\">bobPos $folder/other</td>" "$folder/dom" || grep -q "bobPos [^<]*other</td>" "$folder/dom"

has '<th class="words">of its range</th>' # of the differences
has 'data-tiles="0"'

"$bough" modes "$source/apps/beams/blade.yaml" --out "$folder/modes" >/dev/null
opens "$folder/modes"
has '<h1 id="title">modes</h1>'
has '<td>0.68582</td>'

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
