#!/bin/sh
# docs/scene.md is what the program prints, and its example is a scene. test_scene_doc.sh BOUGH SOURCE
set -eu
bough=$1 source=$2
scene=$(mktemp)
trap 'rm -f "$scene"' EXIT
if ! "$bough" help scene | diff "$source/docs/scene.md" -; then
    echo "The keys of a scene have changed. Renew their document, in the source folder:"
    echo "    $bough help scene >docs/scene.md"
    exit 1
fi
sed -n '/^## An example/,/^## Keys/s/^    //p' "$source/docs/scene.md" >"$scene"
"$bough" run "$scene" --out "$scene.out" --quiet >/dev/null
rm -r "$scene.out"
