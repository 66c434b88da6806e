// The table of schemes, and what all of them have in common.
#include "cosim/scheme.h"

// One line a scheme: its entry is bough_scheme_<this>.
#define SCHEMES(ENTRY)                                                                                       \
    ENTRY(frozen)                                                                                            \
    ENTRY(gauss_seidel)                                                                                      \
    ENTRY(extrapolated)                                                                                      \
    ENTRY(iterated)                                                                                          \
    ENTRY(ramp)                                                                                              \
    ENTRY(monolithic)

#define DECLARATION(scheme) extern const bough_scheme bough_scheme_##scheme;
#define ADDRESS(scheme) &bough_scheme_##scheme,
SCHEMES(DECLARATION)
static const bough_scheme *const schemes[] = {SCHEMES(ADDRESS)};
enum { N_SCHEME = sizeof schemes / sizeof *schemes };

// Keys of a scene that have no effect under the other schemes.
static const bough_scheme_key keys[] = {
    {"coupling.order", BOUGH_READS_ORDER},
    {"coupling.theta", BOUGH_READS_THETA},
    {"coupling.exchange", BOUGH_READS_EXCHANGE},
    {"coupling.accelerator", BOUGH_READS_ACCELERATOR},
    {"coupling.relaxation", BOUGH_READS_ACCELERATOR},
    {"coupling.tolerance", BOUGH_READS_ACCELERATOR},
    {"coupling.iterations", BOUGH_READS_ACCELERATOR},
    {"micro", BOUGH_READS_MEMBERS},
    {"step_control", BOUGH_READS_MEMBERS},
};

bough_scheme_options bough_scheme_options_default(void) {
    return (bough_scheme_options){.name = BOUGH_SCHEME_DEFAULT,
                                  .order = 1,
                                  .integrator = {.kind = BOUGH_IDA, .rtol = 1e-6},
                                  .accelerator = BOUGH_ACCELERATE_IQN_ILS,
                                  .relaxation = 0.5,
                                  .tolerance = 1e-6,
                                  .iterations = 30};
}

int bough_scheme_index(const char *name) {
    for (int i = 0; i < N_SCHEME; i++) {
        if (strcmp(schemes[i]->name, name) == 0) return i;
    }
    return -1;
}

const bough_scheme *bough_scheme_find(const char *name) {
    int index = bough_scheme_index(name);
    return index < 0 ? NULL : schemes[index];
}

const bough_scheme *bough_scheme_at(int index) {
    return index >= 0 && index < N_SCHEME ? schemes[index] : NULL;
}

const char *bough_scheme_name(int index) {
    const bough_scheme *scheme = bough_scheme_at(index);
    return scheme ? scheme->name : NULL;
}

const bough_scheme *bough_scheme_advised(void) {
    int i = 0;
    while (!schemes[i]->advised) i++;
    return schemes[i];
}

// The advised scheme with the settings that damp most.
bough_scheme_options bough_scheme_damped(const bough_scheme_options *options) {
    const bough_scheme *advised = bough_scheme_advised();
    bough_scheme_options damped = *options;
    damped.name = advised->name;
    if (advised->damp) advised->damp(&damped);
    return damped;
}

bool bough_scheme_reads(const bough_scheme *s, unsigned option) {
    return option == BOUGH_READS_MEMBERS ? !s->one_system : (s->reads & option) != 0;
}

const bough_scheme_key *bough_scheme_key_at(int index) {
    return index < (int)(sizeof keys / sizeof *keys) ? &keys[index] : NULL;
}

void bough_scheme_describe(const bough_scheme *s, const bough_scheme_options *options,
                           char text[BOUGH_SCHEME_TEXT]) {
    // name
    size_t room = BOUGH_SCHEME_TEXT, n = (size_t)snprintf(text, room, "%s", s->name);
    bool waveform = options->exchange == BOUGH_EXCHANGE_WAVEFORM;
    // what is exchanged
    if (s->reads & BOUGH_READS_EXCHANGE && waveform) {
        n += (size_t)snprintf(text + n, room - n, ", waveforms");
    } else if (s->reads & BOUGH_READS_ORDER) {
        n += (size_t)snprintf(text + n, room - n, ", order %d", options->order);
    }
    // settings of the iteration
    if (s->reads & BOUGH_READS_ACCELERATOR) {
        n += (size_t)snprintf(text + n, room - n, ", accelerator %s, tolerance %.6g in at most %d iterations",
                              bough_acceleration_names[options->accelerator], options->tolerance,
                              options->iterations);
    }
    if (s->reads & BOUGH_READS_THETA) snprintf(text + n, room - n, ", theta %.6g", options->theta);
}

// -- use ------------------------------------------------------------------------------------------

bough_status bough_scheme_couple(bough_arena *arena, const bough_assembly *assembly,
                                 const bough_scheme_options *options, bough_pool *pool,
                                 bough_coupling **coupling) {
    // the data of all schemes, then its own
    const bough_scheme *scheme = bough_scheme_find(options->name);
    assert(scheme != NULL);
    *coupling = bough_coupling_create(arena, assembly, options, pool);
    (*coupling)->scheme = scheme;
    return scheme->create ? scheme->create(*coupling, arena) : bough_ok();
}

bough_status bough_scheme_step(bough_coupling *c) {
    // members advance as the scheme orders them
    BOUGH_TRY(c->scheme->step(c));
    // their outputs become inputs
    bough_assembly_outputs(c->assembly, c->t1, c->output, c->input);
    if (c->scheme->obtained) c->scheme->obtained(c);
    bough_coupling_record(c);
    return bough_ok();
}

void bough_scheme_snapshot(bough_coupling *c, bough_snapshot *s) {
    bough_coupling_snapshot(c, s);
    if (c->scheme->snapshot) c->scheme->snapshot(c, s);
}

int bough_scheme_defect_order(const bough_scheme *s, const bough_scheme_options *options) {
    return s->defect_order ? s->defect_order(options) : 1;
}

int bough_scheme_error_order(const bough_scheme *s, const bough_scheme_options *options) {
    return s->error_order ? s->error_order(options) : bough_scheme_defect_order(s, options);
}

bough_member *bough_scheme_whole(const bough_coupling *c) {
    return c->scheme->whole ? c->scheme->whole(c) : NULL;
}

bough_scheme_report bough_scheme_reported(const bough_coupling *c) {
    bough_scheme_report report = {.interface_ratio = (double)NAN};
    if (c->scheme->report) c->scheme->report(c, &report);
    return report;
}

// -- a macro step as a map ------------------------------------------------------------------------

// The rows of z after the states; their number.
static int memory_rows(const bough_coupling *c, double *row[4]) {
    row[0] = c->past.input[1];
    row[1] = c->past.input[2];
    row[2] = c->applied;
    row[3] = c->scheme->impulse ? c->scheme->impulse(c) : NULL;
    return row[3] != NULL ? 4 : 3;
}

int bough_scheme_n_memory(const bough_coupling *c) {
    double *row[4];
    return c->assembly->n_state + memory_rows(c, row) * c->assembly->n_input;
}

void bough_scheme_load(bough_coupling *c, double h, const double *z) {
    const bough_assembly *a = c->assembly;
    size_t size = (size_t)a->n_input * sizeof(double);
    double *row[4];
    int n = memory_rows(c, row);
    // states, and rows of inputs
    for (int i = 0; i < a->n_member; i++) bough_member_set(a->member[i], 0, z + a->state_offset[i]);
    for (int p = 0; p < n; p++) memcpy(row[p], z + a->n_state + p * a->n_input, size);
    // the newest point follows from the states
    bough_assembly_outputs(a, 0, c->output, c->input);
    memcpy(c->past.input[0], c->input, size);
    for (int p = 0; p < BOUGH_HISTORY; p++) c->past.time[p] = -p * h;
    c->past.n = BOUGH_HISTORY;
    c->t1 = 0;
}

// As bough_scheme_load, the other way.
void bough_scheme_store(const bough_coupling *c, double *z) {
    const bough_assembly *a = c->assembly;
    double *row[4];
    int n = memory_rows(c, row);
    bough_assembly_states(a, z);
    for (int p = 0; p < n; p++) {
        memcpy(z + a->n_state + p * a->n_input, row[p], (size_t)a->n_input * sizeof(double));
    }
}
