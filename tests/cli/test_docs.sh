#!/bin/sh
# What the documents name is there: every `ctest -R PATTERN` a test, every file a file, every anchor a heading. test_docs.sh BUILD SOURCE
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
        # the browser's test is there where a browser is, the FMU's where static libraries serve it, others where
        # Python is
        case $part in browser | fmu) continue ;; esac
        case $part in fmu_member | random_* | json_schema | python) grep -q -x python "$scratch/names" || continue ;; esac
        grep -q -E -e "$part" "$scratch/names" && continue
        echo "FAILED: no test is named by '$part' of 'ctest -R $pattern'"
        failures=$((failures + 1))
    done
done <"$scratch/patterns"
[ "$(wc -l <"$scratch/patterns")" -ge 20 ] || { echo 'FAILED: few commands were found'; failures=1; }

# Files: links, relative to the page; `folder/name.ext` of the sources, with "*" or NAME for any text; `name.c`
# anywhere.
exists() { # PATTERN
    # shellcheck disable=SC2086 # a pattern
    set -- $1
    [ -e "$1" ]
}
cd "$2" || exit 1
git ls-files '*.[ch]' 2>/dev/null | sed 's,.*/,,' >"$scratch/sources"
[ -s "$scratch/sources" ] || find . -name build -prune -o -name '*.[ch]' -print | sed 's,.*/,,' >"$scratch/sources"
n=0
for page in README.md docs/*.md docs/*/*.md; do
    grep -o '](\([^)#]*\)' "$page" | sed 's/^](//; /^https*:/d; /^$/d' >"$scratch/links"
    while read -r link; do
        n=$((n + 1))
        exists "$(dirname "$page")/$link" && continue
        echo "FAILED: $page links to $link, which does not exist"
        failures=$((failures + 1))
    done <"$scratch/links"
    # the words between backquotes; commands have several
    grep -o '`[^`]*`' "$page" | tr -d '`' | tr ' ' '\n' | sed "s/[,;:']*$//; s/NAME/*/g; s/^\.\///" |
        grep -E '^[A-Za-z0-9_*./-]+\.(c|h|yaml|md|sh|py|js|csv|cmake|svg|diff)$' | sort -u >"$scratch/named"
    while read -r name; do
        case $name in
        core/* | flexbody/* | aero/* | cosim/* | apps/* | docs/* | tests/*)
            n=$((n + 1))
            exists "$name" && continue
            ;;
        */*) continue ;;
        *.[ch])
            n=$((n + 1))
            grep -q -x "$(echo "$name" | sed 's/[.]/[.]/g; s/\*/.*/g')" "$scratch/sources" && continue
            ;;
        *) continue ;;
        esac
        echo "FAILED: $page names $name, which does not exist"
        failures=$((failures + 1))
    done <"$scratch/named"
done
# Anchors, as GitHub makes them of headings: lower case, without punctuation, blanks as hyphens. Pictures of HTML.
anchors() { # PAGE
    sed -n '/^```/,/^```/d; s/^##* //p' "$1" | LC_ALL=C.UTF-8 sed 's/.*/\L&/; s/[^[:alnum:] _-]//g; s/ /-/g'
}
for page in README.md docs/*.md docs/*/*.md; do
    grep -o '](\([^):]*#[^)]*\))' "$page" | sed 's/^](//; s/)$//' >"$scratch/links"
    while read -r link; do
        n=$((n + 1))
        target=${link%%#*}
        target=${target:+$(dirname "$page")/$target}
        anchors "${target:-$page}" | grep -q -x -F -e "${link#*#}" && continue
        echo "FAILED: $page links to $link, but no heading gives this anchor"
        failures=$((failures + 1))
    done <"$scratch/links"
    grep -oE '(src|srcset|href)="[^"#:]+"' "$page" | sed 's/.*="//; s/"$//' >"$scratch/links"
    while read -r link; do
        n=$((n + 1))
        [ -e "$(dirname "$page")/$link" ] && continue
        echo "FAILED: $page shows $link, which does not exist"
        failures=$((failures + 1))
    done <"$scratch/links"
done
# A cell of a table is read at a glance: what is longer is a sentence below the table.
for page in README.md docs/*.md docs/*/*.md; do
    awk -v page="$page" '
        /^```/ {code = !code}
        /^\|/ && !code {
            gsub(/\\[|]/, "/")
            n = split($0, cell, "|")
            for (i = 2; i < n; i++) {
                gsub(/^ +| +$/, "", cell[i])
                if (length(cell[i]) > 200) {print "FAILED: " page ":" FNR ": a cell of " length(cell[i]) " characters"; bad = 1}
            }
        }
        END {exit bad}' "$page" || failures=$((failures + 1))
done
[ $n -ge 100 ] || { echo "FAILED: only $n files were found"; failures=1; }
[ $failures -eq 0 ]
