// Watches a coupled run: values that are not finite, the interface defect and the energy residual as measures
// of the coupling error, the growth of an unstable coupling; and finds why a member fails.
#pragma once

#include "cosim/analysis/stability.h"
#include "cosim/coupling.h"

typedef struct bough_monitor bough_monitor;

// The monitor's result at the end of the run.
typedef struct bough_coupling_report {
    double defect_max;       // largest |obtained − applied| at a synchronisation point, of a force, moment
                             // or velocity relative to its own largest magnitude [1]
    double defect_rms;       // its root mean square over the steps, of the worst port [1]
    double energy_residual;  // Σ over interfaces |∫ (obtained − applied wrench) · twist dt| [J]
    double energy_exchanged; // Σ over interfaces ∫ |wrench · twist| dt [J]
} bough_coupling_report;

bough_monitor *bough_monitor_create(bough_arena *arena, const bough_coupling *coupling);

// Checks the last step: BOUGH_FAILED with a diagnosis when the run has become meaningless. Where another
// solution shows the error (`compared`), growth and energy are not judged.
bough_status bough_monitor_step(bough_monitor *m, bough_coupling *c, bool compared);

// Its windows, accounts and largest values so far.
void bough_monitor_snapshot(bough_monitor *m, const bough_coupling *c, bough_snapshot *s);

bough_coupling_report bough_monitor_report(const bough_monitor *m, const bough_coupling *c);

// Energy at one interface over the run so far [J].
typedef struct bough_pair_energy {
    double residual;  // ∫ (obtained − applied wrench) · twist dt
    double exchanged; // ∫ |wrench · twist| dt
} bough_pair_energy;
bough_pair_energy bough_monitor_energy(const bough_monitor *m, int interface);

// -- a member that fails within a macro step ------------------------------------------------------

// Keeps the members' states and inputs; a macro step begins.
void bough_monitor_keep(bough_monitor *m, const bough_coupling *c);

// Members and inputs are again what they were then.
void bough_monitor_undo(const bough_monitor *m, bough_coupling *c);

// The failure of the present step, with the part of the coupling in it: a stability analysis shows whether
// the coupling is the cause, its growth, and a stable scheme. `before`: result of the analysis before the
// run; if that found nothing, the kept states are analysed, because the members' own states are lost.
bough_status bough_monitor_explain(const bough_monitor *m, bough_coupling *c,
                                   const bough_stability_advice *before, bough_status cause);
