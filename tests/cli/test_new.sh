#!/bin/sh
# Scenes that `bough new` writes, scenes found by their directory, results compared: test_new.sh PROGRAM.
set -u
bough=$1
. "$(dirname "$0")/scratch.sh"

# Each kind is a scene that runs; its directory is its name.
says 1 "cannot make 'mine/beam'" new beam mine/beam
mkdir mine
for kind in beam mechanism turbine; do
    says 0 "next: bough run mine/$kind" new $kind mine/$kind
    says 0 "scene: mine/$kind/scene.yaml" check mine/$kind
    says 0 "out: out/$kind" run mine/$kind/ --quiet --set simulation.duration=0.2s
    [ -f out/$kind/channels.out ] || fail "out/$kind: no channels.out"
done
says 0 "^blade blade2: pitch 1 deg, cone 0 deg," check mine/turbine
says 0 "^blade blade2: pitch 1 deg, cone 3 deg," check mine/turbine --set 'turbine.cone=3 deg'
says 2 "unknown kind 'turbin' (did you mean 'turbine'?)" new turbin other
says 2 "'mine/beam' is not empty" new beam mine/beam

# A directory's scene is the only one, scene.yaml, or the one with the directory's name.
says 2 "'mine' holds no scene" check mine
mkdir two
cp mine/beam/scene.yaml two/a.yaml
says 0 "scene: two/a.yaml" check two
cp mine/beam/scene.yaml two/b.yaml
says 2 "'two' holds 2 scenes; name one of them: a.yaml, b.yaml" check two
cp mine/beam/scene.yaml two/two.yaml
says 0 "scene: two/two.yaml" check two/

# A result differs from itself by nothing, and from another where the other load acts.
says 0 "" run mine/beam --quiet --out one
says 0 "" run mine/beam --quiet --out other --set 'loads[0].force=[0, 1, -20]'
says 0 "^beamTipZ  *0 (m)  *equal" diff one one
says 0 "^beamTipY  *0.001[0-9]* (m)  *1 " diff one other
says 2 "no channels.out" diff one mine
exit "$failures"
