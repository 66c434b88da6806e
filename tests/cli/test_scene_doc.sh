#!/bin/sh
# docs/scene.md, study.md and channels.md are what the program prints, and the first one's example is a
# scene. test_scene_doc.sh BOUGH SOURCE
set -eu
bough=$1 source=$2
scene=$(mktemp)
trap 'rm -f "$scene"' EXIT
for topic in scene study channels; do
    "$bough" help $topic | diff "$source/docs/$topic.md" - && continue
    echo "The document has changed. Renew it, in the source folder:"
    echo "    $bough help $topic >docs/$topic.md"
    exit 1
done
sed -n '/^## An example/,/^## Keys/s/^    //p' "$source/docs/scene.md" >"$scene"
"$bough" run "$scene" --out "$scene.out" --quiet >/dev/null
rm -r "$scene.out"
