// bough export: a scene as an FMU (FMI 3.0, co-simulation): its description from the tables of inputs
// and channels, the library that runs it, the scene's files.
#include "apps/bough/open.h"
#include "apps/bough/verb.h"
#include "apps/bough/version.h"
#include "apps/config/schema.h"
#include "apps/output/archive.h"
#include "apps/output/folder.h"
#include "apps/scene/fingerprint.h"

#include <inttypes.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum { MOST_FILES = 40 };

typedef struct export {
    bough_arena *arena;
    const bough_options *options;
    const bough_simulation *simulation;
    bough_channels channels;
    char token[40];
    const char *scene; // in resources/
    int n_file;
    struct {
        const char *path, *name; // where it is, where it goes
    } file[MOST_FILES];
} export;

// -- files ----------------------------------------------------------------------------------------

static const char *print(bough_arena *arena, const char *a, const char *b, const char *c) {
    size_t size = strlen(a) + strlen(b) + strlen(c) + 1;
    char *text = bough_arena_take(arena, size);
    if (text) snprintf(text, size, "%s%s%s", a, b, c);
    return text ? text : "";
}

static void add_path(export *x, const char *path) {
    for (int k = 0; k < x->n_file; k++) {
        if (strcmp(x->file[k].path, path) == 0) return;
    }
    if (x->n_file < MOST_FILES) x->file[x->n_file++].path = path;
}

static void list_files(export *x) {
    const bough_scene *scene = x->simulation->scene;
    add_path(x, scene->file);
    for (int i = 0; i < scene->n_body; i++) {
        const bough_node *node = scene->body[i].rod.structure.node;
        if (node && node->line > 0) add_path(x, node->file);
    }
    if (scene->aero.blade.node) add_path(x, scene->aero.blade.node->file);
    if (scene->aero.polars.node) add_path(x, scene->aero.polars.node->file);
    if (scene->aero.wind.file) add_path(x, scene->aero.wind.file);
    if (scene->control.kind == BOUGH_SCENE_BLADED && scene->control.node) {
        add_path(x, scene->control.library);
        if (scene->control.input[0]) add_path(x, scene->control.input);
    }
}

// Files that lie above the scene need as many folders below resources/.
static bough_status place_files(export *x) {
    const char *slash = strrchr(x->file[0].path, '/');
    size_t length = slash ? (size_t)(slash + 1 - x->file[0].path) : 0;
    int depth = 0;
    for (int k = 0; k < x->n_file; k++) {
        const char *path = x->file[k].path;
        if (strncmp(path, x->file[0].path, length) != 0 || (length == 0 && path[0] == '/')) {
            return bough_fail(BOUGH_INVALID,
                              "'%.200s' is not given relative to the scene; an FMU must contain "
                              "it",
                              path);
        }
        x->file[k].name = path + length;
        int up = 0;
        for (const char *c = x->file[k].name; strncmp(c, "../", 3) == 0; c += 3) up++;
        if (up > depth) depth = up;
    }
    for (int k = 0; k < x->n_file; k++) {
        const char *name = x->file[k].name, *folder = "";
        int down = depth;
        for (; strncmp(name, "../", 3) == 0; name += 3) down--;
        for (; down > 0; down--) folder = print(x->arena, folder, "scene/", "");
        x->file[k].name = print(x->arena, "resources/", folder, name);
    }
    x->scene = x->file[0].name + strlen("resources/");
    return bough_ok();
}

// -- description ----------------------------------------------------------------------------------

static void put_text(const char *text, FILE *out) {
    for (const char *c = text; *c; c++) {
        if (*c == '<') {
            fputs("&lt;", out);
        } else if (*c == '&') {
            fputs("&amp;", out);
        } else if (*c == '"') {
            fputs("&quot;", out);
        } else {
            fputc(*c, out);
        }
    }
}

static const char *input_unit(const bough_scene *scene, int k) {
    return bough_dimension_unit((bough_dimension)scene->input[k].dimension);
}

// Every unit once.
static void put_units(const export *x, FILE *out) {
    const bough_scene *scene = x->simulation->scene;
    int n = scene->n_input + x->channels.count;
    fputs("  <UnitDefinitions>\n    <Unit name=\"s\"/>\n", out);
    for (int i = 0; i < n; i++) {
        bool known = false;
        const char *unit = "";
        for (int k = 0; k <= i && !known; k++) {
            const char *other = k < scene->n_input ? input_unit(scene, k)
                                                   : x->channels.channel[k - scene->n_input].unit;
            if (k == i) {
                unit = other;
                break;
            }
            const char *own = i < scene->n_input ? input_unit(scene, i)
                                                 : x->channels.channel[i - scene->n_input].unit;
            known = strcmp(own, other) == 0;
        }
        if (known || unit[0] == '\0' || strcmp(unit, "s") == 0) continue;
        fputs("    <Unit name=\"", out);
        put_text(unit, out);
        fputs("\"/>\n", out);
    }
    fputs("  </UnitDefinitions>\n", out);
}

static void put_variables(const export *x, FILE *out) {
    const bough_scene *scene = x->simulation->scene;
    fputs("  <ModelVariables>\n    <Float64 name=\"time\" valueReference=\"0\" "
          "causality=\"independent\" variability=\"continuous\" unit=\"s\"/>\n", out);
    for (int k = 0; k < scene->n_input; k++) {
        fprintf(out, "    <Float64 name=\"");
        put_text(scene->input[k].name, out);
        fprintf(out, "\" valueReference=\"%d\" causality=\"input\" variability=\"continuous\" "
                     "start=\"%.17g\"", k + 1, scene->input[k].initial);
        if (input_unit(scene, k)[0]) {
            fputs(" unit=\"", out);
            put_text(input_unit(scene, k), out);
            fputc('"', out);
        }
        fputs("/>\n", out);
    }
    for (int k = 0; k < x->channels.count; k++) {
        fprintf(out, "    <Float64 name=\"");
        put_text(x->channels.channel[k].name, out);
        fprintf(out, "\" valueReference=\"%d\" causality=\"output\" variability=\"continuous\" "
                     "unit=\"", scene->n_input + k + 1);
        put_text(x->channels.channel[k].unit, out);
        fputs("\"/>\n", out);
    }
    fputs("  </ModelVariables>\n  <ModelStructure>\n", out);
    for (int k = 0; k < x->channels.count; k++)
        fprintf(out, "    <Output valueReference=\"%d\" dependencies=\"\"/>\n", scene->n_input + k + 1);
    for (int k = 0; k < x->channels.count; k++)
        fprintf(out, "    <InitialUnknown valueReference=\"%d\"/>\n", scene->n_input + k + 1);
    fputs("  </ModelStructure>\n", out);
}

static void put_description(const export *x, FILE *out) {
    const bough_scene *scene = x->simulation->scene;
    const bough_scene_control *control = &scene->control;
    bool copies = !control->node || control->kind != BOUGH_SCENE_BLADED;
    fputs("<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<fmiModelDescription fmiVersion=\"3.0\" "
          "modelName=\"", out);
    put_text(scene->title ? scene->title : scene->file, out);
    fprintf(out, "\" instantiationToken=\"%s\" generationTool=\"bough " BOUGH_VERSION "\" "
                 "variableNamingConvention=\"flat\">\n", x->token);
    fprintf(out, "  <CoSimulation modelIdentifier=\"bough\" canHandleVariableCommunicationStepSize="
                 "\"true\" fixedInternalStepSize=\"%.17g\" canGetAndSetFMUState=\"%s\" "
                 "providesDirectionalDerivatives=\"false\" maxOutputDerivativeOrder=\"0\"/>\n",
            scene->simulation.macro_step, copies ? "true" : "false");
    put_units(x, out);
    fputs("  <LogCategories>\n    <Category name=\"logStatusError\"/>\n    <Category "
          "name=\"logStatusWarning\"/>\n    <Category name=\"logAll\"/>\n  </LogCategories>\n", out);
    fprintf(out, "  <DefaultExperiment startTime=\"0\" stopTime=\"%.17g\" stepSize=\"%.17g\"/>\n",
            scene->simulation.duration, scene->simulation.macro_step);
    put_variables(x, out);
    fputs("</fmiModelDescription>\n", out);
}

// -- the command ----------------------------------------------------------------------------------

static bough_status check_names(const export *x) {
    const bough_scene *scene = x->simulation->scene;
    for (int k = 0; k < scene->n_input; k++) {
        const char *name = scene->input[k].name;
        if (strcmp(name, "time") != 0 && bough_channels_find(&x->channels, name) < 0) continue;
        return bough_fail(BOUGH_INVALID, "the input '%.80s' has the name of an output: rename it", name);
    }
    return bough_ok();
}

// What a session opens: the token, the scene, the settings, a line each.
static bough_status add_settings(const export *x, bough_archive *archive) {
    char *text = NULL;
    size_t size = 0;
    FILE *out = open_memstream(&text, &size);
    if (!out) return bough_fail(BOUGH_OUT_OF_MEMORY, "out of memory");
    fprintf(out, "%s\n%s\nsimulation.threads=1\n", x->token, x->scene);
    for (int k = 0; k < x->options->n_set; k++) fprintf(out, "%s\n", x->options->set[k]);
    fclose(out);
    bough_status status = bough_archive_add(archive, "resources/scene.txt", text, size);
    free(text);
    return status;
}

static bough_status add_description(const export *x, bough_archive *archive) {
    char *text = NULL;
    size_t size = 0;
    FILE *out = open_memstream(&text, &size);
    if (!out) return bough_fail(BOUGH_OUT_OF_MEMORY, "out of memory");
    put_description(x, out);
    fclose(out);
    bough_status status = bough_archive_add(archive, "modelDescription.xml", text, size);
    free(text);
    return status;
}

// The FMU's library lies beside the program where it was built, below ../LIBDIR where installed.
static bough_status add_library(bough_archive *archive) {
    static const char *const places[] = {"bough-fmu.so", "../" BOUGH_LIBDIR "/bough/bough-fmu.so"};
    char program[BOUGH_PATH_MAX], path[2 * BOUGH_PATH_MAX];
    ssize_t length = readlink("/proc/self/exe", program, sizeof program - 1);
    program[length > 0 ? length : 0] = '\0';
    char *slash = strrchr(program, '/');
    if (slash) *slash = '\0';
    for (size_t k = 0; k < sizeof places / sizeof *places; k++) {
        snprintf(path, sizeof path, "%s/%s", program, places[k]);
        if (access(path, R_OK) != 0) continue;
        return bough_archive_copy(archive, "binaries/x86_64-linux/bough.so", path);
    }
    return bough_fail(BOUGH_INVALID, "this program was built without the FMU's library, "
                                     "bough-fmu.so, which needs the static libraries of SUNDIALS, "
                                     "OpenBLAS, FFTW and libyaml");
}

static bough_status write_archive(export *x, const char *path) {
    FILE *file;
    bough_status status = bough_folder_open_partial(path, &file);
    if (!bough_is_ok(&status)) return status;
    bough_archive archive = {.file = file};
    status = add_description(x, &archive);
    if (bough_is_ok(&status)) status = add_library(&archive);
    if (bough_is_ok(&status)) status = add_settings(x, &archive);
    for (int k = 0; k < x->n_file && bough_is_ok(&status); k++)
        status = bough_archive_copy(&archive, x->file[k].name, x->file[k].path);
    if (!bough_is_ok(&status)) {
        bough_folder_discard(path, file);
        return status;
    }
    bough_archive_end(&archive);
    return bough_folder_commit(path, file);
}

static void make_token(export *x) {
    uint64_t hash = BOUGH_FINGERPRINT_START;
    bough_mix_scene(&hash, x->simulation->scene);
    for (int k = 0; k < x->options->n_set; k++) bough_mix_text(&hash, x->options->set[k]);
    snprintf(x->token, sizeof x->token, "{bough-" BOUGH_VERSION "-%016" PRIx64 "}", hash);
}

bough_status bough_verb_export(bough_arena *arena, const bough_options *options) {
    if (strcmp(options->operand, "fmu") != 0) {
        return bough_fail(BOUGH_INVALID, "export: unknown kind '%.80s'; known: fmu",
                          options->operand);
    }
    bough_options named = *options;
    named.operand = options->second;
    export x = {.arena = arena, .options = &named};
    bough_simulation *simulation;
    bough_status status = bough_open(arena, &named, &simulation);
    if (!bough_is_ok(&status)) return status;
    x.simulation = simulation;
    x.channels = bough_channels_start(arena);
    status = bough_simulation_channels(simulation, &x.channels);
    if (bough_is_ok(&status)) status = check_names(&x);
    if (!bough_is_ok(&status)) return status;
    list_files(&x);
    status = place_files(&x);
    make_token(&x);
    const char *folder = bough_out_folder(arena, &named);
    if (!folder) return bough_fail(BOUGH_OUT_OF_MEMORY, "out of memory");
    char path[BOUGH_PATH_MAX];
    if (bough_is_ok(&status)) status = bough_folder_make(folder);
    if (bough_is_ok(&status)) status = bough_folder_path(folder, "bough.fmu", path);
    if (bough_is_ok(&status)) status = write_archive(&x, path);
    if (!bough_is_ok(&status)) return status;
    printf("inputs: %d\noutputs: %d\nfmu: %s\n", simulation->scene->n_input, x.channels.count, path);
    return status;
}
