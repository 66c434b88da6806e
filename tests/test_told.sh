#!/bin/sh
# What a run tells of its error decides: test_told.sh PROGRAM SOURCE_FOLDER. Scenes whose coupling fails
# in ways that interface defects do not show, made small.
set -u
bough=$1 source=$2
. "$(dirname "$0")/scratch.sh"

# run CODE PATTERN SCENE [ARGUMENT]...: a line of what the run says matches.
run() {
    code=$1 pattern=$2
    shift 2
    says "$code" "$pattern" run "$@" --quiet --out out
}

# A rod as arm on the rocker of a four-bar linkage, under ramp: the closed loop makes the rocker light.
cat >four-bar.yaml <<'END'
simulation: {duration: 0.9 s, macro_step: 20 ms, coupling: {scheme: ramp}}
bodies:
  - {name: crank, fidelity: rigid, mass: 20, inertia: [0.4, 0.4, 0.005],
     joint: {kind: revolute, axis: y, parent: ground, angle: 0.35 rad, speed: 6 rad/s}}
  - {name: coupler, fidelity: rigid, mass: 20, centre_of_mass: [0.5, 0, 0], inertia: [0.02, 1.7, 1.7],
     joint: {kind: revolute, axis: y, parent: crank, placement: [move z 0.5], angle: -0.42 rad}}
  - {name: rocker, fidelity: rigid, mass: 20, centre_of_mass: [0, 0, 0.28], inertia: [0.5, 0.5, 0.006],
     joint: {kind: revolute, axis: y, parent: ground, placement: [move x 1.1], angle: 0.12 rad}}
  - {name: arm, fidelity: rod, joint: {kind: fixed, parent: rocker},
     rod: {length: 0.7, segments: 1, stiffness: [8e7, 8e7, 2.4e8, 2.4e4, 2.4e4, 1.8e4],
           damping: [2e-3, 2e-3, 2e-3, 2e-3, 2e-3, 2e-3], mass: [9, 0, 0, 9e-4, 9e-4, 0]}}
closures: [{name: pin, kind: spherical, from: coupler, from_placement: [move x 1], to: rocker,
            to_placement: [move z 0.55]}]
END
run 3 'error bound 0.05 is exceeded: [a-zA-Z]* errs by .* of its range, noticeably from .* s on; cause: .*; try' four-bar.yaml
grep -q '"status": "failed"' out/summary.json || fail 'the summary of a run beyond its bound'
coupled='simulation.coupling={scheme: monolithic}'
run 0 '^error: .* by second solution, same mesh' four-bar.yaml --set "$coupled" \
    --set 'simulation.master={solver: rosenbrock, rtol: 1e-5}'

# A blade without damping on a rotor whose speed hardly changes: the axial vibration that the run loses, 0.78 % of
# the range, is below the tolerance. Steps of half the length to an eighth of it lost most of it too and told 0.19 %.
cat >lost.yaml <<'END'
simulation: {duration: 0.6 s, macro_step: 5 ms}
gravity: [0, 0, 0]
bodies:
  - {name: mast, fidelity: rod, joint: {kind: fixed, parent: ground, placement: [rotate x 88.5 deg]},
     rod: {length: 1.12, segments: 4, stiffness: [887200, 887200, 2307000, 2935, 2935, 2260],
           damping: [0, 0, 0, 0, 0, 0], mass: [33.48, 0, 0, 0.0426, 0.0426, 0]}}
  - {name: head, joint: {kind: fixed, parent: mast}, fidelity: rigid, mass: 0.4537, inertia: [0.008744, 0.01096, 0.007919]}
  - {name: hub, fidelity: rigid, mass: 614.1, inertia: [19.26, 11.55, 11.55],
     joint: {kind: revolute, axis: x, parent: head, speed: 5.33 rad/s, placement: [move x -0.112 m]}}
  - {name: blade, fidelity: rod, joint: {kind: fixed, parent: hub, placement: [move z 0.028 m]},
     rod: {length: 0.56, segments: 3, stiffness: [1.288e7, 1.288e7, 3.349e7, 1116, 5001, 859.5],
           damping: [0, 0, 0, 0, 0, 0], mass: [13.59, 0, 0, 0.000453, 0.000453, 0]}}
END
run 0 '^error: 0\.00[5-9][0-9]* of the range of hubVel' lost.yaml --set 'simulation.master={rtol: 1e-5}'
run 0 '^error: 0\.00[5-9][0-9]* of the range of hubVel' lost.yaml --set "$coupled" \
    --set 'simulation.master={solver: radau5, rtol: 1e-4}' # 0.03 % with a second solution at 1e-5

# Generalised-alpha is no reference, however small its rtol, which is that of Newton's method: shorter steps help.
alpha='generalized-alpha, rtol: 1e-8'
run 3 'errs by .*; try master.step: .* s or master.solver: rosenbrock' four-bar.yaml --set "$coupled" \
    --set "simulation.master={solver: $alpha}"
run 0 '^error: .* by second solution, same mesh' four-bar.yaml --set "$coupled" \
    --set "simulation.master={solver: $alpha, step: 0.2 ms}"

# A straight bar in free fall: what hardly moves has no say, whatever its error relative to nothing.
cat >fall.yaml <<'END'
simulation: {duration: 0.5 s, macro_step: 10 ms, coupling: {scheme: ramp}}
bodies:
  - {name: carriage, joint: {kind: planar, parent: ground, axis: x}, fidelity: rigid, mass: 2, inertia: [0.01, 0.01, 0.01]}
  - {name: arm, fidelity: rod, joint: {kind: fixed, parent: carriage},
     rod: {length: 0.8, segments: 3, stiffness: [5e6, 5e6, 1.4e7, 200, 200, 150], mass: [0.5, 0, 0, 1e-5, 1e-5, 0]}}
END
run 0 '^status: complete' fall.yaml

# A mast that carries a head: told by the linearised members 1e3 and more times too much.
cat >carrying.yaml <<'END'
simulation: {duration: 0.1 s, macro_step: 20 ms, coupling: {scheme: ramp}}
bodies:
  - {name: mast, fidelity: rod, joint: {kind: fixed, parent: ground},
     rod: {length: 1, segments: 2, stiffness: [1.2e4, 1.2e4, 3.6e4, 1, 3, 0.8],
           damping: [3e-3, 3e-3, 3e-3, 3e-3, 3e-3, 3e-3], mass: [0.4, 0, 0, 1.2e-5, 1.2e-5, 0]}}
  - {name: head, joint: {kind: fixed, parent: mast}, fidelity: rigid, mass: 1.8, inertia: [7e-3, 7e-3, 2e-3]}
END
run 0 '^error: ' carrying.yaml

# Linearised members tell a hundredth of errors like this one; where they are not measured, the second solution serves.
run 0 '^error: .* by second solution' carrying.yaml --set simulation.error_estimate=linearised
land() { # rtol, source of the estimate
    run 0 "^error: .* by $2" "$source/apps/turbine/land.yaml" --set 'simulation.duration=0.1 s' --threads 1 \
        --set "simulation.master.rtol=$1" --set simulation.error_bound=0
}
land 3e-4 'linearised members'
land 3e-3 'second solution'

# A force that the wind's start lets grow, and that blades and hub agree on to 1e-7: the coupling is not the cause.
run 0 '^status: complete' "$source/apps/turbine/runup.yaml" --set 'simulation.duration=2 s' --set 'aero.rate=12.5 Hz' --threads 1 \
    --set 'bodies[2].inertia=[5.1414234e7, 2.6e6, 2.6e6, 0, 0, 0]' --set 'simulation.macro_step=5 ms' --set simulation.micro.rtol=1e-4 \
    --set 'simulation.output.interval=80 ms' --set 'bodies[3-5].rod.segments=24' \
    --set 'bodies[3-5].rod.damping=[1e-3, 1e-3, 1e-3, 1.4e-3, 2.2e-3, 2.2e-3]'

# A step whose repetitions end before they agree goes on, because the run tells what it errs by; else it stops.
noisy='simulation.coupling={scheme: iterated, tolerance: 1e-12, iterations: 5}'
run 0 'warning: .* of 20 macro steps went on before they had converged' carrying.yaml --set "$noisy" --set 'simulation.macro_step=5 ms'
run 3 'not converged' carrying.yaml --set "$noisy" --set 'simulation.macro_step=5 ms' --set simulation.error_estimate=none
run 3 'error bound' carrying.yaml --set 'simulation.coupling={scheme: iterated, iterations: 1}' --set 'simulation.macro_step=5 ms'

# All speeds of a driven parallelogram are constant: an error of a millionth of them is none of their range.
cat >parallelogram.yaml <<'END'
simulation: {duration: 0.1 s, macro_step: 2 ms}
bodies:
  - {name: crank, fidelity: rigid, mass: 0.4, inertia: [8e-3, 8e-3, 1e-4],
     joint: {kind: revolute, axis: y, parent: ground, angle: 40 deg, motion: {speed: 6 rad/s}}}
  - {name: coupler, fidelity: rigid, mass: 0.4, centre_of_mass: [0.5, 0, 0], inertia: [4e-4, 0.034, 0.034],
     joint: {kind: revolute, axis: y, parent: crank, placement: [move z 0.5], angle: -40 deg}}
  - {name: rocker, fidelity: rigid, mass: 0.4, inertia: [8e-3, 8e-3, 1e-4],
     joint: {kind: revolute, axis: y, parent: ground, placement: [move x 1], angle: 40 deg}}
closures: [{name: pin, kind: spherical, from: coupler, from_placement: [move x 1], to: rocker, to_placement: [move z 0.5]}]
END
run 0 '^error: 0\.[0-9]* of the range of' parallelogram.yaml

# A whip without damping that is jerked up: the second solution follows it with IDA, whose steps are cheap. Given up, it left the place
# to linearised members that told 57 times too much.
cat >whip.yaml <<'END'
simulation: {duration: 1 s, macro_step: 5 ms, coupling: {scheme: frozen}, micro: {solver: generalized-alpha, step: 1 ms}}
bodies:
  - {name: frame, fidelity: rigid, mass: 50, inertia: [5, 5, 5],
     joint: {kind: prismatic, axis: z, parent: ground, motion: {position: {from: 0, to: 0.3, ramp: [0.2 s, 0.25 s]}}}}
  - {name: whip, fidelity: rod, joint: {kind: fixed, parent: frame, placement: [rotate y 90 deg]},
     rod: {length: 1.5, segments: 8, stiffness: [1e6, 1e6, 3e6, 30, 30, 25], mass: [0.3, 0, 0, 1e-5, 1e-5, 0]}}
END
run 3 'whipTipZ errs by 0\.0[0-9]* m' whip.yaml
grep -q '"source": "second solution"' out/summary.json || fail 'the second solution of the whip'

# A reference tells nothing, and says so; a bound of 0 is none.
run 0 '^error: not estimated' fall.yaml --set "$coupled" --set simulation.error_estimate=none
grep -q '"relative": null' out/summary.json || fail 'an unknown error is null'
run 0 '^status: complete' four-bar.yaml --set simulation.error_bound=0
[ $failures -eq 0 ]
