// Coupling schemes: how the members of an assembly are taken over one macro step, and what they see
// of each other while they integrate themselves. One file per scheme; this is the table by name.
#ifndef BOUGH_COSIM_SCHEME_H
#define BOUGH_COSIM_SCHEME_H

#include "cosim/coupling.h"

typedef struct bough_scheme {
    const char *name;
    const char *summary;  // one line for help: what is exchanged, order, stability
    bool explicit_forces; // forces are frozen or extrapolated: unstable beyond some macro step
    bool judged;          // may be unstable: its eigenvalues are looked at before the run
    // Takes the scheme's memory; NULL when it needs none.
    bough_status (*create)(bough_coupling *c, bough_arena *arena);
    // Takes all members from t0 to t1.
    bough_status (*step)(bough_coupling *c);
    // What its own memory carries from step to step; factors are found anew. NULL: nothing.
    void (*snapshot)(bough_coupling *c, bough_snapshot *s);
} bough_scheme;

// name "ramp", order 1, sequential, Hermite, theta automatic, rtol 1e-6; end
// values by IQN-ILS from relaxation 1/2 to 1e-6 in at most 30 iterations.
bough_scheme_options bough_scheme_options_default(void);

// The scheme of that name; NULL when unknown.
const bough_scheme *bough_scheme_find(const char *name);

// All names, NULL-terminated, for messages and help.
const char *const *bough_scheme_names(void);

extern const bough_scheme bough_scheme_frozen, bough_scheme_gauss_seidel,
    bough_scheme_extrapolated, bough_scheme_ramp, bough_scheme_iterated, bough_scheme_monolithic;

#endif
