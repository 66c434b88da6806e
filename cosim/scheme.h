// Coupling schemes: how the members of an assembly advance over one macro step, and which inputs they get
// while they integrate. A scheme is one file, which ends with its entry, and one line of the table in
// scheme.c. Other code uses the entry only, and names no scheme but the default.
#pragma once

#include "cosim/coupling.h"

// The scheme of scenes that name none, and the one to try where another is unstable.
#define BOUGH_SCHEME_DEFAULT "monolithic"

// Options that a scheme reads.
enum {
    BOUGH_READS_ORDER = 1,
    BOUGH_READS_THETA = 2,
    BOUGH_READS_EXCHANGE = 4,
    BOUGH_READS_ACCELERATOR = 8, // relaxation, tolerance and iterations too
    BOUGH_READS_MEMBERS = 16,    // the integrators of single members and the step control
};

// What a scheme reports of a run.
typedef struct bough_scheme_report {
    double interface_ratio; // theory (57) about the initial state; NaN: not known
    long sweeps;            // advances of all members over a macro step that is repeated; 0: none is repeated
    long unfinished;        // macro steps that went on before they had converged
} bough_scheme_report;

// The entry of a scheme. Fields that it leaves out are false, 0 or NULL.
struct bough_scheme {
    const char *name;
    const char *summary; // one line for help: what is exchanged, order, stability

    // properties
    unsigned reads;       // BOUGH_READS_… of the options, but of members: see bough_scheme_reads
    bool explicit_forces; // forces are frozen or extrapolated: unstable beyond some macro step
    bool foreign;         // takes members whose equations are not known
    bool repeats;         // members return to the start of a step: they must be able to restore their states
    bool judged;          // may be unstable: its eigenvalues are computed before the run
    bool one_system;      // all members are one system: there is no coupling error to judge or estimate
    bool advised; // the scheme to try instead of explicit forces where members keep their integrators; one
                  // has it

    // building
    // Allocates the scheme's memory and checks its options; NULL if it needs neither.
    bough_status (*create)(bough_coupling *c, bough_arena *arena);
    // Prepares the run at the initial state, for a first step from t0 to t1; NULL: nothing to prepare.
    // BOUGH_INVALID where the scheme does not suit the scene. A failure that the first step would repeat is
    // reported by the first step.
    bough_status (*prepare)(bough_coupling *c);

    // stepping
    // Advances all members from t0 to t1.
    bough_status (*step)(bough_coupling *c);
    // Uses the inputs obtained at t1 before they enter the history; NULL: nothing to do.
    void (*obtained)(bough_coupling *c);
    // The part of its memory that later steps depend on, without factors. NULL: nothing.
    void (*snapshot)(bough_coupling *c, bough_snapshot *s);

    // questions
    // Its most damped form, for the growth of the mechanics without that of a coupling; NULL: as the options
    // are.
    void (*damp)(bough_scheme_options *options);
    // Order of the interface defects in the macro step; NULL: 1.
    int (*defect_order)(const bough_scheme_options *options);
    // Order of the coupling error in the macro step; NULL: that of the defects.
    int (*error_order)(const bough_scheme_options *options);
    // The impulses of the inputs (n_input) that the next step compensates, in units of the inputs times s;
    // NULL: none.
    double *(*impulse)(const bough_coupling *c);
    // The member that integrates all members together; NULL: each has its own integrator.
    bough_member *(*whole)(const bough_coupling *c);
    // Fills the report, which holds the values of a scheme without one; NULL: nothing to report.
    void (*report)(const bough_coupling *c, bough_scheme_report *report);
};

// The default scheme, order 1, theta automatic, IDA to 1e-6; end values by IQN-ILS from relaxation 1/2 to
// 1e-6 in at most 30 iterations.
bough_scheme_options bough_scheme_options_default(void);

// -- the table ------------------------------------------------------------------------------------

// The scheme of that name; NULL when unknown.
const bough_scheme *bough_scheme_find(const char *name);

// The scheme at that place of the table, and its name; NULL beyond its end.
const bough_scheme *bough_scheme_at(int index);
const char *bough_scheme_name(int index);
int bough_scheme_index(const char *name); // −1: there is none

// The scheme that is `advised`.
const bough_scheme *bough_scheme_advised(void);

// The options with the advised scheme in its most damped form.
bough_scheme_options bough_scheme_damped(const bough_scheme_options *options);

// Whether the scheme reads an option, one of BOUGH_READS_….
bool bough_scheme_reads(const bough_scheme *s, unsigned option);

// A key of the settings of a run that not every scheme reads.
typedef struct bough_scheme_key {
    const char *path; // below the settings of the run: "coupling.order"
    unsigned option;  // BOUGH_READS_… of the schemes that read it
} bough_scheme_key;

// The key at that place of their table; NULL beyond its end.
const bough_scheme_key *bough_scheme_key_at(int index);

enum { BOUGH_SCHEME_TEXT = 200 };

// The scheme with the options that it reads, "iterated, order 1, accelerator …".
void bough_scheme_describe(const bough_scheme *s, const bough_scheme_options *options,
                           char text[BOUGH_SCHEME_TEXT]);

// -- use ------------------------------------------------------------------------------------------

// Builds the working data of a coupling and creates the scheme that the options name, one of the
// table. BOUGH_INVALID when it does not suit the assembly.
bough_status bough_scheme_couple(bough_arena *arena, const bough_assembly *assembly,
                                 const bough_scheme_options *options, bough_pool *pool,
                                 bough_coupling **coupling);

// One macro step from t0 to t1: advances all members and exchanges their values.
bough_status bough_scheme_step(bough_coupling *c);

// All that later steps depend on: the coupling's and the scheme's own.
void bough_scheme_snapshot(bough_coupling *c, bough_snapshot *s);

// The entry's answers, or those of an entry that leaves the question out.
int bough_scheme_defect_order(const bough_scheme *s, const bough_scheme_options *options);
int bough_scheme_error_order(const bough_scheme *s, const bough_scheme_options *options);
bough_member *bough_scheme_whole(const bough_coupling *c);
bough_scheme_report bough_scheme_reported(const bough_coupling *c);

// The memory of a macro step as one vector z: the members' states (n_state), the inputs one and two steps
// ago, the inputs applied last and, for schemes that compensate them, the impulses (n_input each). The
// functions: the length of z; set the coupling from z, for the step that begins at time 0 after steps
// of length h; get z from the coupling.
int bough_scheme_n_memory(const bough_coupling *c);
void bough_scheme_load(bough_coupling *c, double h, const double *z);
void bough_scheme_store(const bough_coupling *c, double *z);
