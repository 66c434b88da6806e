#!/bin/sh
# Installs into a folder of its own and builds the example against it. test_install.sh BUILD SOURCE
set -eu
build=$1 source=$2
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cmake --install "$build" --prefix "$folder/usr" >/dev/null
"$folder/usr/bin/bough" --version
library=$(find "$folder/usr" -name 'libbough.so.0')
declared=$(grep -o 'bough_session_[a-z_]*(' "$source/apps/bough/exchange/bough.h" | tr -d '(' | sort -u)
[ "$(nm -D --defined-only "$library" | sed 's/.* //' | sort)" = "$declared" ]
if python=$(command -v python3) && "$python" -c "import ctypes" 2>/dev/null; then
    PYTHONPATH=$(dirname "$(dirname "$(find "$folder/usr" -name py.typed)")") PYTHONDONTWRITEBYTECODE=1 "$python" -c "
import bough
print('python:', len(bough.Session('$source/apps/mechanisms/pendulum.yaml').names), 'channels')"
fi
# The wheel, of what is built here, offline.
if "$python" -m pip --version >/dev/null 2>&1; then
    BOUGH_BUILD=$build PIP_NO_INDEX=1 "$python" -m pip install -q --no-deps --prefix "$folder/wheel" "$source" 2>"$folder/said" ||
        { cat "$folder/said"; exit 1; }
    cd "$folder"
    PYTHONPATH=$(dirname "$(dirname "$(find "$folder/wheel" -name py.typed)")") "$python" -c "
import bough
print('wheel:', len(bough.run('$source/apps/mechanisms/pendulum.yaml', 'simulation.duration=0.1 s')), 'columns')"
    cd - >/dev/null
fi
# Every scene that is installed can be built, every study read with the scenes of its runs; what is neither
# is data that one of them names.
scenes=0
for file in $(find "$folder/usr/share/bough" -name '*.yaml'); do
    if grep -Eq "^(bodies|base|turbine):" "$file"; then
        "$folder/usr/bin/bough" check "$file" >"$folder/said" 2>&1 || { cat "$folder/said"; exit 1; }
        scenes=$((scenes + 1))
    elif grep -q '^kind:' "$file"; then
        # part of none; the kinds without parts say so when all is read
        "$folder/usr/bin/bough" study "$file" --part 99999/99999 --out "$folder/studied" --quiet \
            >"$folder/said" 2>&1 || grep -q 'error: only studies of kind .* run in parts' "$folder/said" ||
            { cat "$folder/said"; exit 1; }
        scenes=$((scenes + 1))
    else
        grep -rq --include='*.yaml' "[:,] *[./a-z]*$(basename "$file")" "$folder/usr/share/bough" "$source/tests" ||
            { echo "nobody names $file"; exit 1; }
    fi
done
[ $scenes -gt 40 ]
# The pages find each other and their pictures; what they name beside docs/ is in the sources only.
doc=$(dirname "$(find "$folder/usr" -name CONTRIBUTING.md)")
for page in "$doc"/*.md "$doc"/docs/*.md; do
    for link in $(grep -Eo '(\]\(|src="|srcset=")[^)"#]+\.(md|svg|png)' "$page" | sed 's/.*[("]//'); do
        case $link in http*|*apps/*|*tests/*) continue ;; esac
        [ -e "$(dirname "$page")/$link" ] || { echo "$page: no $link"; exit 1; }
    done
done
grep -q '^\.SS study' "$folder/usr/share/man/man1/bough.1"
completed=$(bash -c '. "$1/usr/share/bash-completion/completions/bough"
    complete_words() { COMP_WORDS=("$@") COMP_CWORD=$(($# - 1)); _bough "$bough"; echo "${COMPREPLY[*]}"; }
    bough=$1/usr/bin/bough
    complete_words bough st; complete_words bough run --o; complete_words bough help sce
    complete_words bough import w' sh "$folder")
[ "$completed" = "static study
--out
scene
windio" ]
mkdir "$folder/project"
cp "$source/apps/bough/exchange/example.c" "$source/apps/bough/exchange/what_if.c" "$folder/project"
cat >"$folder/project/CMakeLists.txt" <<'END'
cmake_minimum_required(VERSION 3.20)
project(example C)
find_package(bough 0.1 REQUIRED)
add_executable(example example.c)
target_link_libraries(example bough::api)
add_executable(what_if what_if.c)
target_link_libraries(what_if bough::api)
END
cmake -G Ninja -S "$folder/project" -B "$folder/b" -DCMAKE_PREFIX_PATH="$folder/usr" >/dev/null
cmake --build "$folder/b" >/dev/null
"$folder/b/example" "$source/apps/mechanisms/pendulum.yaml" bobX >"$folder/rows"
[ "$(wc -l <"$folder/rows")" -ge 100 ]
export PKG_CONFIG_PATH="$(dirname "$library")/pkgconfig"
# shellcheck disable=SC2046 # a list of words
cc -o "$folder/by-pkg-config" "$folder/project/example.c" $(pkg-config --cflags --libs bough)
LD_LIBRARY_PATH=$(dirname "$library") "$folder/by-pkg-config" "$source/apps/mechanisms/pendulum.yaml" bobX |
    cmp - "$folder/rows"
[ "$(pkg-config --modversion bough)" = "$("$folder/usr/bin/bough" --version | sed 's/^bough //;s/ .*//')" ]
if "$folder/b/example" "$source/apps/mechanisms/pendulum.yaml" nothing 2>/dev/null; then exit 1; fi
"$folder/b/what_if" "$source/apps/mechanisms/pendulum.yaml" 0.5 'gravity=[0, 0, -1.62]' bobX >"$folder/rows"
awk '{apart = ($2 - $3) ^ 2} NR == 1 && apart > 1e-6 {exit 1} END {exit !(apart > 1e-4)}' "$folder/rows"
echo "installed and used"
