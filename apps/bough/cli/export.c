// bough export: a scene as an FMU (FMI 3.0, co-simulation): its description from the tables of inputs
// and channels, the library that runs it, the scene's files.
#include "apps/bough/cli/command.h"
#include "apps/bough/config/schema.h"
#include "apps/bough/results/folder.h"
#include "apps/bough/results/picture.h"
#include "apps/bough/scene/scene_files.h"
#include "core/base/bytes.h"
#include "core/base/input_file.h"

#include <inttypes.h>
#include <unistd.h>
#include <zlib.h>

// -- the archive ----------------------------------------------------------------------------------

// A ZIP archive whose files are stored as they are (PKWARE's APPNOTE 6.3, without ZIP64: at most 4 GB).

typedef struct zip_entry {
    const char *name; // "resources/scene.yaml"; borrowed until zip_end
    uint32_t sum, size, at;
} zip_entry;

typedef struct zip {
    bough_arena *arena; // of copies
    FILE *file;         // open for writing, at its beginning
    int n;
    zip_entry *entry; // (n), with room for all files
} zip;

enum { LOCAL = 0x04034b50, CENTRAL = 0x02014b50, END = 0x06054b50 };
enum {
    DAY = 1 << 5 | 1,
    VERSION = 20,
    UTF8 = 1 << 11
}; // of 1 January 1980, so that equal scenes give equal files

// The common part of a local header and of its entry in the directory.
static void put_entry(FILE *file, const zip_entry *entry) {
    bough_put_bytes(file, VERSION, 2);
    bough_put_bytes(file, UTF8, 2);
    bough_put_bytes(file, 0, 4); // stored, at midnight
    bough_put_bytes(file, DAY, 2);
    bough_put_bytes(file, entry->sum, 4);
    bough_put_bytes(file, entry->size, 4);
    bough_put_bytes(file, entry->size, 4);
    bough_put_bytes(file, (uint32_t)strlen(entry->name), 2);
    bough_put_bytes(file, 0, 2);
}

// Appends a file of `size` bytes. BOUGH_INVALID when it does not fit: 4 GB or 65535 files.
static bough_status zip_add(zip *z, const char *name, const void *bytes, size_t size) {
    long at = ftell(z->file);
    if (z->n == UINT16_MAX || at < 0 || size + (size_t)at > UINT32_MAX - (1u << 20)) {
        return bough_fail(BOUGH_INVALID, "the archive has no room for '%.200s'", name);
    }
    zip_entry *entry = &z->entry[z->n++];
    *entry = (zip_entry){name, (uint32_t)crc32_z(0, bytes, size), (uint32_t)size, (uint32_t)at};
    bough_put_bytes(z->file, LOCAL, 4);
    put_entry(z->file, entry);
    fputs(name, z->file);
    fwrite(bytes, 1, size, z->file);
    return bough_ok();
}

// Appends a copy of the file at `path`. BOUGH_IO when it cannot be read.
static bough_status zip_copy(zip *z, const char *name, const char *path) {
    char why[BOUGH_INPUT_REASON];
    size_t size;
    bough_arena *own = bough_arena_child(z->arena);
    const char *bytes = bough_input_read(own, path, BOUGH_INPUT_DATA, &size, why);
    bough_status status =
        bytes ? zip_add(z, name, bytes, size) : bough_fail(BOUGH_IO, "cannot read '%.200s': %s", path, why);
    bough_arena_destroy(own);
    return status;
}

// Writes the directory that ends the archive; the stream is the caller's to close.
static void zip_end(zip *z) {
    uint32_t at = (uint32_t)ftell(z->file);
    for (int k = 0; k < z->n; k++) {
        bough_put_bytes(z->file, CENTRAL, 4);
        bough_put_bytes(z->file, VERSION, 2);
        put_entry(z->file, &z->entry[k]);
        bough_put_bytes(z->file, 0, 4); // no comment, the first disk
        bough_put_bytes(z->file, 0, 6); // attributes
        bough_put_bytes(z->file, z->entry[k].at, 4);
        fputs(z->entry[k].name, z->file);
    }
    uint32_t size = (uint32_t)ftell(z->file) - at;
    bough_put_bytes(z->file, END, 4);
    bough_put_bytes(z->file, 0, 4);
    bough_put_bytes(z->file, (uint32_t)z->n, 2);
    bough_put_bytes(z->file, (uint32_t)z->n, 2);
    bough_put_bytes(z->file, size, 4);
    bough_put_bytes(z->file, at, 4);
    bough_put_bytes(z->file, 0, 2);
}

// -- the FMU --------------------------------------------------------------------------------------

typedef struct variable {
    const char *name, *unit, *meaning;
    double start; // of an input, SI
} variable;

typedef struct export {
    bough_arena *arena;
    const bough_options *options;
    bough_simulation *simulation;
    int n_input, n_variable;
    variable *variable; // (n_variable) inputs, then outputs
    char token[40];
    const char *scene; // in resources/
    bough_scene_files files;
    const char **name; // (files.n) of a file in the archive
}
export;

// -- files ----------------------------------------------------------------------------------------

// "ctrl/./../../air/polars.yaml" as "../air/polars.yaml": ".." only at the beginning.
static const char *tidy(bough_arena *arena, const char *path) {
    char *text = bough_arena_take(arena, strlen(path) + 1);
    size_t used = 0, least = 0; // the part before `least` is "../../…"
    for (size_t length; *path; path += length + (path[length] == '/')) {
        length = strcspn(path, "/");
        bool up = length == 2 && strncmp(path, "..", 2) == 0;
        if (length == 0 || (length == 1 && path[0] == '.')) continue;
        if (up && used > least) {
            used--; // its slash
            while (used > least && text[used - 1] != '/') used--;
            continue;
        }
        memcpy(text + used, path, length);
        used += length;
        if (path[length] == '/') text[used++] = '/';
        if (up) least = used;
    }
    text[used] = '\0';
    return text;
}

// If files lie in folders above the scene, the scene lies as many folders below resources/.
static bough_status place_files(export *x) {
    const char *scene = x->files.item[0].path;
    size_t length = (size_t)(bough_file_name(scene) - scene);
    int depth = 0;
    x->name = bough_arena_take(x->arena, (size_t)x->files.n * sizeof *x->name);
    for (int k = 0; k < x->files.n; k++) {
        const bough_scene_file *file = &x->files.item[k];
        if (file->absolute) {
            return bough_fail(BOUGH_INVALID,
                              "%.80s: '%.200s' is not given relative to the scene; an FMU must contain it",
                              file->key, file->path);
        }
        x->name[k] = tidy(x->arena, file->path + length);
        int up = 0;
        for (const char *c = x->name[k]; strncmp(c, "../", 3) == 0; c += 3) up++;
        if (up > depth) depth = up;
    }
    for (int k = 0; k < x->files.n; k++) {
        const char *name = x->name[k], *folder = "";
        int down = depth;
        for (; strncmp(name, "../", 3) == 0; name += 3) down--;
        for (; down > 0; down--) folder = bough_arena_print(x->arena, "%sscene/", folder);
        x->name[k] = bough_arena_print(x->arena, "resources/%s%s", folder, name);
    }
    x->scene = x->name[0] + strlen("resources/");
    return bough_ok();
}

// -- description ----------------------------------------------------------------------------------

static void put_text(const char *name, const char *text, FILE *out) {
    fprintf(out, " %s=\"", name);
    bough_picture_text(out, text);
    fputc('"', out);
}

static void put_unit(const char *unit, FILE *out) {
    fputs("    <Unit", out);
    put_text("name", unit, out);
    fputc('>', out);
    static const char *const base[BOUGH_BASE_UNITS] = {"m", "kg", "s", "rad"};
    int exponent[BOUGH_BASE_UNITS];
    double factor;
    char text[40], why[160];
    // channels write "kN-m" for a product, and "-" for a pure number
    snprintf(text, sizeof text, "%s", unit);
    for (char *c = text; *c; c++) {
        if (*c == '-') *c = ' ';
    }
    if (bough_unit_base(text, &factor, exponent, why)) {
        fputs("<BaseUnit", out);
        for (int k = 0; k < BOUGH_BASE_UNITS; k++)
            if (exponent[k] != 0) fprintf(out, " %s=\"%d\"", base[k], exponent[k]);
        if (factor != 1) fprintf(out, " factor=\"%.17g\"", factor);
        fputs("/>", out);
    }
    fputs("</Unit>\n", out);
}

// Every unit once.
static void put_units(const export *x, FILE *out) {
    fputs("  <UnitDefinitions>\n", out);
    put_unit("s", out);
    for (int i = 0; i < x->n_variable; i++) {
        const char *unit = x->variable[i].unit;
        bool known = unit[0] == '\0' || strcmp(unit, "s") == 0;
        for (int k = 0; k < i && !known; k++) known = strcmp(unit, x->variable[k].unit) == 0;
        if (!known) put_unit(unit, out);
    }
    fputs("  </UnitDefinitions>\n", out);
}

static void put_variable(const variable *v, int reference, bool input, FILE *out) {
    fputs("    <Float64", out);
    put_text("name", v->name, out);
    fprintf(out, " valueReference=\"%d\" causality=\"%s\" variability=\"continuous\"", reference,
            input ? "input" : "output");
    if (input) fprintf(out, " start=\"%.17g\"", v->start);
    if (v->meaning) put_text("description", v->meaning, out);
    if (v->unit[0]) put_text("unit", v->unit, out);
    fputs("/>\n", out);
}

static void put_variables(const export *x, FILE *out) {
    fputs("  <ModelVariables>\n    <Float64 name=\"time\" valueReference=\"0\" "
          "causality=\"independent\" variability=\"continuous\" unit=\"s\"/>\n",
          out);
    for (int k = 0; k < x->n_variable; k++) put_variable(&x->variable[k], k + 1, k < x->n_input, out);
    fputs("  </ModelVariables>\n  <ModelStructure>\n", out);
    for (int k = x->n_input; k < x->n_variable; k++)
        fprintf(out, "    <Output valueReference=\"%d\" dependencies=\"\"/>\n", k + 1);
    for (int k = x->n_input; k < x->n_variable; k++)
        fprintf(out, "    <InitialUnknown valueReference=\"%d\"/>\n", k + 1);
    fputs("  </ModelStructure>\n", out);
}

static void put_description(const export *x, FILE *out) {
    const bough_scene *scene = x->simulation->scene;
    bool copies = !bough_scene_control_is_foreign(&scene->control);
    fputs("<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<fmiModelDescription fmiVersion=\"3.0\"", out);
    put_text("modelName", scene->title ? scene->title : scene->file, out);
    fprintf(out,
            " instantiationToken=\"%s\" generationTool=\"bough " BOUGH_VERSION "\" "
            "variableNamingConvention=\"flat\">\n",
            x->token);
    fprintf(out,
            "  <CoSimulation modelIdentifier=\"bough\" canHandleVariableCommunicationStepSize="
            "\"true\" fixedInternalStepSize=\"%.17g\" canGetAndSetFMUState=\"%s\" "
            "providesDirectionalDerivatives=\"false\" maxOutputDerivativeOrder=\"0\"/>\n",
            scene->simulation.macro_step, copies ? "true" : "false");
    put_units(x, out);
    fputs("  <LogCategories>\n    <Category name=\"logStatusError\"/>\n    <Category "
          "name=\"logStatusWarning\"/>\n    <Category name=\"logAll\"/>\n  </LogCategories>\n",
          out);
    fprintf(out, "  <DefaultExperiment startTime=\"0\" stopTime=\"%.17g\" stepSize=\"%.17g\"/>\n",
            scene->simulation.duration, scene->simulation.macro_step);
    put_variables(x, out);
    fputs("</fmiModelDescription>\n", out);
}

// -- the command ----------------------------------------------------------------------------------

static const char *const input_meanings[] = {
    [BOUGH_INPUT_LOAD] = "load",
    [BOUGH_INPUT_MOTION] = "position of the joint, reached at the end of the step",
    [BOUGH_INPUT_WIND] = "speed of the wind",
    [BOUGH_INPUT_TORQUE] = "torque demanded of the generator, on the fast shaft",
    [BOUGH_INPUT_PITCH] = "pitch demanded of the blade, positive towards feather",
};

static bough_status list_variables(export *x) {
    const bough_scene *scene = x->simulation->scene;
    bough_channels channels = bough_channels_start(x->arena);
    BOUGH_TRY(bough_simulation_channels(x->simulation, &channels));
    x->n_input = scene->n_input;
    x->n_variable = x->n_input + channels.count;
    x->variable = bough_arena_take(x->arena, ((size_t)x->n_variable + 1) * sizeof *x->variable);
    for (int k = 0; k < channels.count; k++) {
        const bough_channel *from = &channels.channel[k];
        x->variable[x->n_input + k] = (variable){from->name, from->unit, from->meaning, 0};
    }
    for (int k = 0; k < x->n_input; k++) {
        const bough_scene_input *from = &scene->input[k];
        x->variable[k] = (variable){from->name, bough_dimension_unit((bough_dimension)from->dimension),
                                    input_meanings[from->kind], from->initial};
        if (strcmp(from->name, "time") != 0 && bough_channels_find(&channels, from->name) < 0) continue;
        return bough_fail(BOUGH_INVALID, "the input '%.80s' has the name of an output: rename it",
                          from->name);
    }
    return bough_ok();
}

// The file that a session of the FMU reads: token, scene and settings, a line each.
static void put_settings(const export *x, FILE *out) {
    fprintf(out, "%s\n%s\nsimulation.threads=1\n", x->token, x->scene);
    for (int k = 0; k < x->options->set.n; k++) fprintf(out, "%s\n", x->options->set.text[k]);
}

static bough_status add_text(const export *x, const char *name, void (*put)(const export *x, FILE *out),
                             zip *archive) {
    char *text = NULL;
    size_t size = 0;
    FILE *out = open_memstream(&text, &size);
    if (!out) return bough_fail(BOUGH_OUT_OF_MEMORY, "out of memory");
    put(x, out);
    fclose(out);
    bough_status status = zip_add(archive, name, text, size);
    free(text);
    return status;
}

// The FMU's library lies beside the program where it was built, below ../LIBDIR where installed.
static bough_status add_library(zip *archive) {
    static const char *const places[] = {"bough-fmu.so", "../" BOUGH_LIBDIR "/bough/bough-fmu.so"};
    char program[BOUGH_PATH_MAX], path[2 * BOUGH_PATH_MAX];
    ssize_t length = readlink("/proc/self/exe", program, sizeof program - 1);
    program[length > 0 ? length : 0] = '\0';
    char *slash = strrchr(program, '/');
    if (slash) *slash = '\0';
    for (size_t k = 0; k < sizeof places / sizeof *places; k++) {
        snprintf(path, sizeof path, "%s/%s", program, places[k]);
        if (access(path, R_OK) != 0) continue;
        return zip_copy(archive, "binaries/x86_64-linux/bough.so", path);
    }
    return bough_fail(BOUGH_INVALID, "this program was built without the FMU's library, "
                                     "bough-fmu.so, which needs the static libraries of SUNDIALS, "
                                     "OpenBLAS, FFTW and libyaml");
}

enum { OWN = 3 }; // files beside the scene's: description, library, settings

static bough_status write_archive(export *x, const char *folder, char *path) {
    FILE *file;
    BOUGH_TRY(bough_folder_open(folder, "bough.fmu", path, &file));
    zip archive = {.arena = x->arena, .file = file};
    archive.entry = bough_arena_take(x->arena, ((size_t)x->files.n + OWN) * sizeof *archive.entry);
    bough_status status = add_text(x, "modelDescription.xml", put_description, &archive);
    if (bough_is_ok(&status)) status = add_library(&archive);
    if (bough_is_ok(&status)) status = add_text(x, "resources/scene.txt", put_settings, &archive);
    for (int k = 0; k < x->files.n && bough_is_ok(&status); k++) {
        bool there = false; // under another spelling of its path
        for (int i = 0; i < k && !there; i++) there = strcmp(x->name[i], x->name[k]) == 0;
        if (!there) status = zip_copy(&archive, x->name[k], x->files.item[k].path);
    }
    if (bough_is_ok(&status)) zip_end(&archive);
    return bough_folder_close(path, file, status);
}

static void make_token(export *x) {
    uint64_t hash = BOUGH_FINGERPRINT_START;
    bough_mix_scene(&hash, &(bough_file_sums){.arena = x->arena}, x->simulation->scene);
    for (int k = 0; k < x->options->set.n; k++) bough_mix_text(&hash, x->options->set.text[k]);
    snprintf(x->token, sizeof x->token, "{bough-" BOUGH_VERSION "-%016" PRIx64 "}", hash);
}

static const bough_option rows[] = {
    BOUGH_OPTION_SET,
    BOUGH_OPTION_OUT,
    {0},
};

static bough_status export_scene(bough_arena *arena, const void *given) {
    const bough_options *options = given;
    if (strcmp(options->operand, "fmu") != 0) {
        return bough_fail(BOUGH_INVALID, "export: unknown kind '%.80s'; known: fmu", options->operand);
    }
    bough_options named = *options;
    named.operand = options->operands[1];
    for (int k = 0; k < options->set.n; k++) // each is a line of a file
        if (strchr(options->set.text[k], '\n') != NULL)
            return bough_fail(BOUGH_INVALID, "export: --set %d has a line break", k + 1);
    BOUGH_TRY(bough_find_scene(arena, &named));
    export x = {.arena = arena, .options = &named};
    BOUGH_TRY(bough_open(arena, &named, &x.simulation));
    BOUGH_TRY(bough_simulation_known(x.simulation, "it has files of its own, which are not exported"));
    BOUGH_TRY(list_variables(&x));
    x.files = bough_scene_list_files(arena, x.simulation->scene);
    BOUGH_TRY(place_files(&x));
    make_token(&x);
    char path[BOUGH_PATH_MAX];
    BOUGH_TRY(write_archive(&x, bough_out_folder(arena, &named), path));
    printf("inputs: %d\noutputs: %d\nfmu: %s\n", x.n_input, x.n_variable - x.n_input, path);
    return bough_ok();
}

const bough_command bough_command_export = {
    .name = "export",
    .summary = "writes a scene as 'fmu', a model for co-simulation by other programs (FMI 3.0)",
    .operands = "KIND SCENE",
    .option = rows,
    .size = sizeof(bough_options),
    .run = export_scene,
};
