#!/bin/sh
# test_tidy.sh CLANG_TIDY BUILD SOURCE: clang-tidy on the files that differ from the commit before, or from
# BOUGH_TIDY_BASE; of a header, the file of its name. Without clang-tidy, or outside git, the test is skipped.
set -u
tidy=$1 build=$2
cd "$3" || exit 1
command -v "$tidy" > /dev/null || { echo "skipped: clang-tidy is not installed"; exit 77; }
base=${BOUGH_TIDY_BASE:-HEAD~1}
git rev-parse -q --verify "$base^{commit}" > /dev/null 2>&1 || { echo "skipped: no commit $base to compare with"; exit 77; }
files=$(git diff --name-only --diff-filter=d "$base" -- core flexbody aero cosim apps \
    | sed -n 's/\.[ch]$/.c/p' | sort -u | while read -r file; do
        grep -q "\"file\": \"$PWD/$file\"" "$build/compile_commands.json" && echo "$file"
    done)
[ -n "$files" ] || { echo "no file of C changed since $base"; exit 0; }
# gcc's flags and warnings are not clang's
echo "$files" | xargs "$tidy" --quiet -p "$build" --extra-arg=-w
