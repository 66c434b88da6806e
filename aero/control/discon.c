// Controllers in Bladed's interface: loads the library, and exchanges records with it.
#include "aero/control/discon.h"

#include "core/base/base.h"
#include "core/base/input_file.h"

#include <dlfcn.h>

// Records of the interface, and more for the values that controllers log.
enum { RECORDS = 8192, LOGGED = 1000, TEXT = 1024 };

typedef void call(float *swap, int *fail, char *input, char *output, char *message);

struct bough_discon {
    call *function;
    const char *library;
    float record[RECORDS + 1]; // [1] is the first
    char input[TEXT], output[TEXT], message[TEXT];
    bool started;
};

// Record numbers.
enum {
    STATUS = 1,
    TIME,
    STEP,
    PITCH,
    SHAFT_POWER = 14,
    ELECTRICAL_POWER,
    GENERATOR_SPEED = 20,
    ROTOR_SPEED,
    TORQUE = 23,
    YAW_ERROR,
    WIND = 27,
    PITCH_CONTROL, // 0 collective, 1 individual
    ROOT_MOMENT = 30,
    PITCH_2 = 33,
    PITCH_3,
    CONTACTOR = 35, // of the generator: 1 main
    HEADING = 37,
    DEMANDED_PITCH = 42,
    COLLECTIVE_PITCH = 45,
    DEMANDED_TORQUE = 47,
    MESSAGE_SIZE = 49,
    INPUT_SIZE,
    OUTPUT_SIZE,
    FORE_AFT = 53,
    SIDE_SIDE,
    AZIMUTH = 60,
    BLADES,
    LOG_MOST,
    LOG_FIRST,
    NAMES_SIZE,
    IN_PLANE = 69,
    NODDING = 83,
    RECORDS_SIZE = 129,
};

// A copy of a library: the loader takes another file for another library, with variables of its own.
typedef struct library_copy {
    FILE *file; // open as long as the library, because its number is the library's name
    void *handle;
} library_copy;

// False when the file cannot be read or the disk is full.
static bool copy_bytes(FILE *from, FILE *to) {
    char part[1 << 14];
    size_t n;
    while ((n = fread(part, 1, sizeof part, from)) > 0) {
        if (fwrite(part, 1, n, to) != n) return false;
    }
    return !ferror(from) && fflush(to) == 0;
}

static void close_copy(void *self) {
    library_copy *c = self;
    if (c->handle) dlclose(c->handle);
    if (c->file) fclose(c->file);
}

// The file of the copy has no name; the loader opens it by its number.
static void *load_copy(bough_arena *arena, const char *library) {
    char path[64], why[BOUGH_INPUT_REASON];
    library_copy *c = bough_arena_take(arena, sizeof *c);
    bough_arena_on_destroy(arena, close_copy, c);
    FILE *from = bough_input_open(library, BOUGH_INPUT_DATA, why);
    c->file = from ? tmpfile() : NULL;
    bool good = c->file && copy_bytes(from, c->file);
    if (from) fclose(from);
    if (!good) return NULL;
    snprintf(path, sizeof path, "/proc/self/fd/%d", fileno(c->file));
    return c->handle = dlopen(path, RTLD_NOW | RTLD_LOCAL);
}

// Loads the library, or a copy of it with variables of its own, and finds its function.
static bough_status find_function(bough_arena *arena, const char *library, bool copy, call **function) {
    char why[BOUGH_INPUT_REASON];
    // a missing file has its own reason; names without a folder are the loader's
    FILE *file = strchr(library, '/') ? bough_input_open(library, BOUGH_INPUT_DATA, why) : NULL;
    if (!file && strchr(library, '/')) {
        return bough_fail(BOUGH_INVALID, "the controller cannot be loaded: %.200s: %s", library, why);
    }
    if (file) fclose(file);
    void *handle = copy ? load_copy(arena, library) : dlopen(library, RTLD_NOW | RTLD_LOCAL);
    if (!handle) {
        const char *reason = dlerror();
        return bough_fail(BOUGH_INVALID, "the controller cannot be loaded: %.200s",
                          reason ? reason : "it cannot be copied");
    }
    // the one function of the interface
    void *symbol = dlsym(handle, "DISCON");
    if (!symbol) {
        if (!copy) dlclose(handle);
        return bough_fail(BOUGH_INVALID, "the controller %s has no function DISCON", library);
    }
    memcpy(function, &symbol, sizeof symbol); // of an object pointer: as POSIX has it
    return bough_ok();
}

bough_status bough_discon_open(bough_arena *arena, const char *library, const char *input, bool copy,
                               bough_discon **discon) {
    bough_discon *d = bough_arena_take(arena, sizeof *d);
    // the path of the library, and the names of its input and of its logs
    size_t size = strlen(library) + 3;
    char *path = bough_arena_take(arena, size);
    // A name without a slash would be looked for in the system's folders.
    snprintf(path, size, "%s%s", strchr(library, '/') ? "" : "./", library);
    if (strlen(input) >= TEXT) {
        return bough_fail(BOUGH_INVALID, "the controller's input file has too long a name");
    }
    snprintf(d->input, TEXT, "%s", input);
    snprintf(d->output, TEXT, copy ? "discon-second" : "discon");
    d->library = path;
    bough_status status = find_function(arena, path, copy, &d->function);
    if (bough_is_ok(&status)) *discon = d;
    return status;
}

// The measured values, into the records.
static void write_records(bough_discon *d, const bough_discon_sensed *s) {
    float *r = d->record;
    // the call: the first 0, the last −1; its time and interval
    r[STATUS] = s->last ? -1.0F : (float)d->started;
    r[TIME] = (float)s->time;
    r[STEP] = (float)s->step;
    r[PITCH] = (float)s->pitch[0];
    r[PITCH_2] = (float)s->pitch[1];
    r[PITCH_3] = (float)s->pitch[2];
    r[PITCH_CONTROL] = s->individual;
    // generator, rotor and wind
    r[SHAFT_POWER] = (float)s->shaft_power;
    r[ELECTRICAL_POWER] = (float)s->electrical_power;
    r[GENERATOR_SPEED] = (float)s->generator_speed;
    r[ROTOR_SPEED] = (float)s->rotor_speed;
    r[TORQUE] = (float)s->torque;
    r[YAW_ERROR] = (float)s->yaw_error;
    r[WIND] = (float)s->wind;
    // nacelle and blade roots
    r[HEADING] = (float)s->heading;
    r[FORE_AFT] = (float)s->acceleration[0];
    r[SIDE_SIDE] = (float)s->acceleration[1];
    r[NODDING] = (float)s->nodding;
    for (int b = 0; b < BOUGH_DISCON_BLADES; b++) {
        r[ROOT_MOMENT + b] = (float)s->root_moment[b];
        r[IN_PLANE + b] = (float)s->in_plane[b];
    }
    // constants of the interface: generator connected, lengths of texts, place for logs
    r[CONTACTOR] = 1;
    r[MESSAGE_SIZE] = TEXT;
    r[INPUT_SIZE] = (float)strlen(d->input);
    r[OUTPUT_SIZE] = (float)strlen(d->output);
    r[AZIMUTH] = (float)s->azimuth;
    r[BLADES] = (float)s->n_blade;
    r[LOG_MOST] = LOGGED;
    r[LOG_FIRST] = RECORDS - LOGGED;
    r[NAMES_SIZE] = TEXT;
    r[RECORDS_SIZE] = RECORDS;
    d->message[0] = '\0';
}

// With collective control all blades follow one record, else each its own.
static void read_demands(const bough_discon *d, bough_discon_demand *demand) {
    const float *r = d->record;
    // individual demands, or the collective one for all blades
    bool individual = r[PITCH_CONTROL] == 1;
    demand->torque = (double)r[DEMANDED_TORQUE];
    for (int b = 0; b < BOUGH_MOST_BLADES; b++)
        demand->pitch[b] =
            (double)r[individual && b < BOUGH_DISCON_BLADES ? DEMANDED_PITCH + b : COLLECTIVE_PITCH];
}

// Whether torque and pitch are finite and of a possible size.
static bool is_sound(const bough_discon_demand *d) {
    bool sound = isfinite(d->torque) && fabs(d->torque) < 1e12;
    for (int b = 0; b < BOUGH_MOST_BLADES; b++)
        sound = sound && isfinite(d->pitch[b]) && fabs(d->pitch[b]) < 100;
    return sound;
}

bough_status bough_discon_call(bough_discon *d, const bough_discon_sensed *sensed,
                               bough_discon_demand *demand) {
    int fail = 0;
    write_records(d, sensed);
    // Fortran's first record is number 1
    d->function(d->record + 1, &fail, d->input, d->output, d->message);
    d->started = true;
    d->message[TEXT - 1] = '\0';
    read_demands(d, demand);
    // refusals: by the controller itself, or of demands that cannot be followed
    if (fail < 0) {
        return bough_fail(BOUGH_FAILED, "the controller %.100s fails at %g s: %.200s", d->library,
                          sensed->time, d->message[0] ? d->message : "without a message");
    }
    if (d->record[PITCH_CONTROL] == 1 && sensed->n_blade > BOUGH_DISCON_BLADES) {
        return bough_fail(
            BOUGH_FAILED,
            "the controller %.100s pitches each blade individually, which its interface allows for %d blades; the rotor has %d",
            d->library, (int)BOUGH_DISCON_BLADES, sensed->n_blade);
    }
    if (!is_sound(demand)) {
        return bough_fail(BOUGH_FAILED,
                          "the controller %.100s demands at %g s a torque of %g N m and a pitch of "
                          "%g rad",
                          d->library, sensed->time, demand->torque, demand->pitch[0]);
    }
    return bough_ok();
}
