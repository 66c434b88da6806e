#include "cosim/scheme.h"

#include <assert.h>
#include <stdio.h>
#include <string.h>

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
    return (bough_scheme_options){.name = "ramp",
                                  .order = 1,
                                  .interpolation = BOUGH_HERMITE,
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

const char *bough_scheme_name(int index) {
    return index >= 0 && index < N_SCHEME ? schemes[index]->name : NULL;
}

bool bough_scheme_reads(const bough_scheme *s, unsigned option) {
    return option == BOUGH_READS_MEMBERS ? !s->one_system : (s->reads & option) != 0;
}

const bough_scheme_key *bough_scheme_key_at(int index) {
    return index < (int)(sizeof keys / sizeof *keys) ? &keys[index] : NULL;
}

bough_status bough_scheme_couple(bough_arena *arena, const bough_assembly *assembly,
                                 const bough_scheme_options *options, bough_pool *pool,
                                 bough_coupling **coupling) {
    const bough_scheme *scheme = bough_scheme_find(options->name);
    assert(scheme != NULL);
    *coupling = bough_coupling_create(arena, assembly, options, pool);
    (*coupling)->scheme = scheme;
    return scheme->create ? scheme->create(*coupling, arena) : bough_ok();
}

int bough_scheme_defect_order(const bough_scheme *s, const bough_scheme_options *options) {
    return s->defect_order ? s->defect_order(options) : 1;
}

void bough_scheme_describe(const bough_scheme *s, const bough_scheme_options *options,
                           char text[BOUGH_SCHEME_TEXT]) {
    size_t room = BOUGH_SCHEME_TEXT, n = (size_t)snprintf(text, room, "%s", s->name);
    bool waveform = options->exchange == BOUGH_EXCHANGE_WAVEFORM;
    if (s->reads & BOUGH_READS_EXCHANGE && waveform) {
        n += (size_t)snprintf(text + n, room - n, ", waveforms");
    } else if (s->reads & BOUGH_READS_ORDER) {
        n += (size_t)snprintf(text + n, room - n, ", order %d", options->order);
    }
    if (s->reads & BOUGH_READS_ACCELERATOR) {
        n += (size_t)snprintf(text + n, room - n, ", accelerator %s, tolerance %.6g in at most %d iterations",
                              bough_acceleration_names[options->accelerator], options->tolerance,
                              options->iterations);
    }
    if (s->reads & BOUGH_READS_THETA && options->theta > 0) {
        snprintf(text + n, room - n, ", theta %.6g", options->theta);
    } else if (s->reads & BOUGH_READS_THETA) {
        snprintf(text + n, room - n, ", theta auto: 0.5 where that is stable");
    }
}
