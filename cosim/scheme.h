// Coupling schemes: how the members of an assembly advance over one macro step, and which inputs they get
// while they integrate. A scheme is one file, which ends with its entry, and one line of the table in
// scheme.c. Other code uses the entry only.
#ifndef BOUGH_COSIM_SCHEME_H
#define BOUGH_COSIM_SCHEME_H

#include "cosim/coupling.h"

// Options that a scheme reads.
enum {
    BOUGH_READS_ORDER = 1,
    BOUGH_READS_THETA = 2,
    BOUGH_READS_EXCHANGE = 4,
    BOUGH_READS_ACCELERATOR = 8, // relaxation, tolerance and iterations too
    BOUGH_READS_MEMBERS = 16,    // the integrators of single members and the step control
};

// The entry of a scheme. Fields that it leaves out are false, 0 or NULL.
struct bough_scheme {
    const char *name;
    const char *summary;  // one line for help: what is exchanged, order, stability
    unsigned reads;       // BOUGH_READS_… of the options, but of members: see bough_scheme_reads
    bool explicit_forces; // forces are frozen or extrapolated: unstable beyond some macro step
    bool repeats;         // members return to the start of a step: they must be able to restore their states
    bool judged;          // may be unstable: its eigenvalues are computed before the run
    bool one_system;      // all members are one system: there is no coupling error to judge or estimate
    // Allocates the scheme's memory and checks its options; NULL if it needs neither.
    bough_status (*create)(bough_coupling *c, bough_arena *arena);
    // Prepares the run at the initial state, for a first step from t0 to t1; NULL: nothing to prepare.
    // BOUGH_INVALID where the scheme does not suit the scene. A failure that the first step would repeat is
    // reported by the first step.
    bough_status (*prepare)(bough_coupling *c);
    // Advances all members from t0 to t1.
    bough_status (*step)(bough_coupling *c);
    // The part of its memory that later steps depend on, without factors. NULL: nothing.
    void (*snapshot)(bough_coupling *c, bough_snapshot *s);
    // Order of the interface defects in the macro step; NULL: 1.
    int (*defect_order)(const bough_scheme_options *options);
};

// name "ramp", order 1, sequential, Hermite, theta automatic, IDA to 1e-6; end
// values by IQN-ILS from relaxation 1/2 to 1e-6 in at most 30 iterations.
bough_scheme_options bough_scheme_options_default(void);

// The scheme of that name; NULL when unknown.
const bough_scheme *bough_scheme_find(const char *name);

// Builds the working data of a coupling and creates the scheme that the options name, one of the
// table. BOUGH_INVALID when it does not suit the assembly.
bough_status bough_scheme_couple(bough_arena *arena, const bough_assembly *assembly,
                                 const bough_scheme_options *options, bough_pool *pool,
                                 bough_coupling **coupling);

// Name of the scheme at that place of the table, for messages and help; NULL beyond its end.
const char *bough_scheme_name(int index);
int bough_scheme_index(const char *name); // −1: there is none

// Whether the scheme reads an option, one of BOUGH_READS_….
bool bough_scheme_reads(const bough_scheme *s, unsigned option);

// A key of the settings of a run that not every scheme reads.
typedef struct bough_scheme_key {
    const char *path; // below the settings of the run: "coupling.order"
    unsigned option;  // BOUGH_READS_… of the schemes that read it
} bough_scheme_key;

// The key at that place of their table; NULL beyond its end.
const bough_scheme_key *bough_scheme_key_at(int index);

// Order of the interface defects in the macro step.
int bough_scheme_defect_order(const bough_scheme *s, const bough_scheme_options *options);

enum { BOUGH_SCHEME_TEXT = 200 };

// The scheme with the options that it reads, "iterated, order 1, accelerator …".
void bough_scheme_describe(const bough_scheme *s, const bough_scheme_options *options,
                           char text[BOUGH_SCHEME_TEXT]);

#endif
