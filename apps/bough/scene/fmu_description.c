// The description of an FMU, modelDescription.xml, as far as an importer of real inputs, outputs and
// parameters needs it: FMI 3.0 (https://fmi-standard.org), co-simulation.
#include "apps/bough/scene/scene_internal.h"

#include "core/base/input_file.h"

#include <expat.h>

typedef struct reader {
    bough_arena *arena;
    bough_fmu_description *d;
    int room, scaled_room; // of the arrays
    char version[16];
    bool root, cosimulation;
    bool in_variable; // within an element Float64
    const char *unit; // of the element Unit in progress
} reader;

// -- elements -------------------------------------------------------------------------------------

static const char *attribute(const char **attributes, const char *name) {
    for (; *attributes; attributes += 2) {
        if (strcmp(attributes[0], name) == 0) return attributes[1];
    }
    return NULL;
}

static const char *kept(const reader *r, const char **attributes, const char *name) {
    return bough_arena_string(r->arena, attribute(attributes, name));
}

static bool is_true(const char **attributes, const char *name) {
    const char *value = attribute(attributes, name);
    return value && (strcmp(value, "true") == 0 || strcmp(value, "1") == 0);
}

static bough_fmu_causality causality(const char **attributes) {
    static const char *const names[] = {
        [BOUGH_FMU_INPUT] = "input", [BOUGH_FMU_OUTPUT] = "output", [BOUGH_FMU_PARAMETER] = "parameter"};
    const char *name = attribute(attributes, "causality");
    int k = 0;
    while (k < BOUGH_FMU_LOCAL && !(name && strcmp(name, names[k]) == 0)) k++;
    return (bough_fmu_causality)k;
}

static void add_variable(reader *r, const char **attributes) {
    bough_fmu_description *d = r->d;
    const char *reference = attribute(attributes, "valueReference");
    d->variable = bough_arena_grow(r->arena, d->variable, d->n_variable, &r->room, sizeof *d->variable);
    d->variable[d->n_variable++] =
        (bough_fmu_variable){.name = kept(r, attributes, "name"),
                             .reference = reference ? (uint32_t)strtoul(reference, NULL, 10) : 0,
                             .causality = causality(attributes),
                             .unit = kept(r, attributes, "unit")};
}

static void add_base_unit(reader *r, const char **attributes) {
    bough_fmu_description *d = r->d;
    const char *factor = attribute(attributes, "factor"), *offset = attribute(attributes, "offset");
    bool scaled = (factor && strtod(factor, NULL) != 1) || (offset && strtod(offset, NULL) != 0);
    if (!scaled || !r->unit) return;
    d->scaled = bough_arena_grow(r->arena, d->scaled, d->n_scaled, &r->scaled_room, sizeof *d->scaled);
    d->scaled[d->n_scaled++] = r->unit;
}

static void start(void *self, const char *element, const char **attributes) {
    reader *r = self;
    bough_fmu_description *d = r->d;
    if (strcmp(element, "fmiModelDescription") == 0) {
        const char *version = attribute(attributes, "fmiVersion");
        r->root = true;
        snprintf(r->version, sizeof r->version, "%s", version ? version : "none");
        d->token = kept(r, attributes, "instantiationToken");
    } else if (strcmp(element, "CoSimulation") == 0) {
        r->cosimulation = true;
        d->identifier = kept(r, attributes, "modelIdentifier");
        d->restores = is_true(attributes, "canGetAndSetFMUState");
        d->once = is_true(attributes, "canBeInstantiatedOnlyOncePerProcess");
    } else if (strcmp(element, "Unit") == 0) {
        r->unit = kept(r, attributes, "name");
    } else if (strcmp(element, "BaseUnit") == 0) {
        add_base_unit(r, attributes);
    } else if (strcmp(element, "Float64") == 0) {
        r->in_variable = true;
        add_variable(r, attributes);
    } else if (strcmp(element, "Dimension") == 0 && r->in_variable && d->n_variable > 0) {
        d->variable[d->n_variable - 1].array = true;
    }
}

static void end(void *self, const char *element) {
    reader *r = self;
    if (strcmp(element, "Float64") == 0) r->in_variable = false;
    if (strcmp(element, "Unit") == 0) r->unit = NULL;
}

// -- the file -------------------------------------------------------------------------------------

static bough_status parse(XML_Parser parser, const char *text, size_t size, const char *path) {
    if (XML_Parse(parser, text, (int)size, true) != XML_STATUS_ERROR) return bough_ok();
    return bough_fail(BOUGH_INVALID, "%.200s:%lu: %s", path, (unsigned long)XML_GetCurrentLineNumber(parser),
                      XML_ErrorString(XML_GetErrorCode(parser)));
}

static void free_parser(void *parser) { XML_ParserFree(parser); }

static bough_status check(const reader *r, const char *path) {
    const bough_fmu_description *d = r->d;
    if (!r->root) return bough_fail(BOUGH_INVALID, "%.200s does not describe an FMU", path);
    if (strncmp(r->version, "3.", 2) != 0) {
        return bough_fail(BOUGH_INVALID, "the FMU is of FMI %.12s; expected FMI 3.0", r->version);
    }
    if (!r->cosimulation || !d->identifier || !d->token) {
        return bough_fail(BOUGH_INVALID, "the FMU is not for co-simulation");
    }
    if (strchr(d->identifier, '/')) {
        return bough_fail(BOUGH_INVALID, "'%.80s' is not a model identifier", d->identifier);
    }
    return bough_ok();
}

bough_status bough_fmu_describe(bough_arena *arena, const char *fmu, const char *folder,
                                bough_fmu_description *description) {
    reader r = {.arena = arena, .d = description};
    char why[BOUGH_INPUT_REASON];
    size_t size;
    *description = (bough_fmu_description){0};
    bough_arena *own = bough_arena_child(arena);
    const char *path = bough_arena_print(arena, "%s/modelDescription.xml", fmu);
    const char *file = bough_arena_print(own, "%s/modelDescription.xml", folder);
    const char *text = bough_input_read(own, file, BOUGH_INPUT_TEXT, &size, why);
    bough_status status = bough_ok();
    if (!text) status = bough_fail(BOUGH_INVALID, "cannot read %.200s: %s", path, why);
    if (text) {
        XML_Parser parser = XML_ParserCreate(NULL);
        if (!parser) bough_arena_leave(arena);
        bough_arena_on_destroy(own, free_parser, parser);
        XML_SetUserData(parser, &r);
        XML_SetElementHandler(parser, start, end);
        status = parse(parser, text, size, path);
    }
    bough_arena_destroy(own);
    return bough_is_ok(&status) ? check(&r, path) : status;
}

const bough_fmu_variable *bough_fmu_find(const bough_fmu_description *d, const char *name) {
    for (int k = 0; k < d->n_variable; k++) {
        if (d->variable[k].name && strcmp(d->variable[k].name, name) == 0) return &d->variable[k];
    }
    return NULL;
}

bool bough_fmu_scaled(const bough_fmu_description *d, const bough_fmu_variable *variable) {
    for (int k = 0; k < d->n_scaled && variable->unit; k++) {
        if (strcmp(d->scaled[k], variable->unit) == 0) return true;
    }
    return false;
}
