#include "apps/bough/exchange/bough.h"

#include "apps/bough/config/schema.h"
#include "apps/bough/model/run.h"
#include "apps/bough/scene/scene_files.h"

enum { ERROR_TEXT = 2000 };

struct bough_session {
    bough_arena *arena;
    bool open; // the run is there
    bough_run run;
    uint64_t kind;               // fingerprint of the content of its copies
    size_t size;                 // of a copy [bytes]
    bough_vertex_motion *vertex; // scratch of the longest beam
    int opening;                 // code of the opening
    int code;                    // of the last call that has one
    char error[ERROR_TEXT];
};

static int conclude(bough_session *s, bough_status status) {
    bool good = bough_is_ok(&status);
    s->code = good ? BOUGH_SESSION_OK : bough_exit_code(status.code);
    if (good || status.message[0]) snprintf(s->error, sizeof s->error, "%s", status.message);
    return s->code;
}

#define REFUSE(s, ...) conclude(s, bough_fail(BOUGH_INVALID, __VA_ARGS__))

static bool is_open(const bough_session *s) { return s && s->open; }

// Whether a call has the scene that it needs; otherwise the session has its failure.
static bool has_scene(bough_session *s, const char *call) {
    if (!s || s->open) return s != NULL;
    snprintf(s->error, sizeof s->error, "%s: the scene could not be opened", call);
    s->code = s->opening;
    return false;
}

// The same of a call that needs its state, which is undefined after a step has failed.
static bool has_state(bough_session *s, const char *call) {
    if (!has_scene(s, call)) return false;
    bool good = bough_is_ok(&s->run.outcome);
    if (!good)
        conclude(s,
                 bough_fail(BOUGH_FAILED,
                            "%s: a step has failed, and the session can only be restored or closed: %.300s",
                            call, s->run.outcome.message));
    return good;
}

// All errors of the scene, a line each; as many as there is room for.
static void keep_errors(bough_session *s, const bough_errors *errors) {
    FILE *text = fmemopen(s->error, sizeof s->error, "w");
    if (!text) return;
    bough_errors_print(errors, text);
    fclose(text);
    s->error[sizeof s->error - 1] = '\0';
}

// -- copies ---------------------------------------------------------------------------------------

// The beginning of every copy.
typedef struct head {
    char magic[16];
    uint64_t kind;
} head;

static const char magic[sizeof((head *)0)->magic] = "bough session 1";

static void take(bough_session *s, bough_snapshot *snapshot) {
    head h = {.kind = s->kind};
    memcpy(h.magic, magic, sizeof magic);
    bough_snapshot_take(snapshot, &h, sizeof h);
    bough_snapshot_doubles(snapshot, s->run.value, s->run.channels.count);
    bough_run_snapshot(&s->run, snapshot);
}

// A copy is valid for any session whose copies have the same numbers at the same positions.
static void describe_copy(bough_session *s) {
    const bough_master *m = s->run.simulation->master;
    const bough_assembly *a = m->assembly;
    bough_snapshot measure = {.move = BOUGH_SNAPSHOT_MEASURE};
    take(s, &measure);
    s->size = measure.used;
    s->kind = BOUGH_FINGERPRINT_START;
    bough_mix(&s->kind, &s->size, sizeof s->size);
    bough_mix_text(&s->kind, m->coupling->scheme->name);
    bough_mix(&s->kind, &m->macro_step, sizeof m->macro_step);
    for (int i = 0; i < a->n_member; i++) {
        bough_snapshot own = {.move = BOUGH_SNAPSHOT_MEASURE};
        bough_member_snapshot(a->member[i], &own);
        bough_mix_text(&s->kind, a->member[i]->system.name);
        bough_mix(&s->kind, &own.used, sizeof own.used);
    }
    for (int i = 0; i < s->run.channels.count; i++) {
        bough_mix_text(&s->kind, s->run.channels.channel[i].name);
    }
}

static bough_status check_copy(const bough_session *s, const void *copy) {
    head h;
    if (!copy) return bough_fail(BOUGH_INVALID, "restore: no copy is given (NULL)");
    memcpy(&h, copy, sizeof h);
    if (memcmp(h.magic, magic, sizeof magic) != 0) {
        return bough_fail(BOUGH_INVALID, "this is not a copy of a session");
    }
    if (h.kind == s->kind) return bough_ok();
    return bough_fail(BOUGH_INVALID, "the copy is of a scene with other parts, coupling or steps");
}

size_t bough_session_size(const bough_session *s) { return s ? s->size : 0; }

int bough_session_save(bough_session *s, void *copy) {
    if (!has_state(s, "save")) return bough_session_code(s);
    if (!copy) return REFUSE(s, "save: no memory is given for the copy (NULL)");
    bough_status status = bough_run_storable(&s->run);
    if (!bough_is_ok(&status)) return conclude(s, status);
    bough_session_values(s);
    take(s, &(bough_snapshot){BOUGH_SNAPSHOT_SAVE, copy, 0});
    return bough_session_restore(s, copy);
}

int bough_session_restore(bough_session *s, const void *copy) {
    if (!has_scene(s, "restore")) return bough_session_code(s);
    bough_status status = check_copy(s, copy);
    if (!bough_is_ok(&status)) return conclude(s, status);
    take(s, &(bough_snapshot){BOUGH_SNAPSHOT_RESTORE, (char *)copy, 0});
    s->run.sampled = true; // the values are in the copy
    return conclude(s, bough_ok());
}

// -- opening and stepping -------------------------------------------------------------------------

// The first region of a thread starts its team; later ones find it.
static void start_threads(void *unused) { (void)unused; }

typedef struct opening {
    bough_session *session;
    const char *path, *const *set;
    int n_set;
    const double *input; // of the inputs at the start, NULL: those of the scene
} opening;

static bough_status check_opening(const opening *o) {
    if (!o->path) return bough_fail(BOUGH_INVALID, "no scene is given (NULL)");
    if (o->n_set < 0) return bough_fail(BOUGH_INVALID, "the number of settings is %d", o->n_set);
    if (o->n_set > 0 && !o->set) return bough_fail(BOUGH_INVALID, "no list of settings is given (NULL)");
    for (int k = 0; k < o->n_set; k++) {
        if (!o->set[k]) return bough_fail(BOUGH_INVALID, "setting %d of %d is NULL", k + 1, o->n_set);
    }
    return bough_ok();
}

static bough_status build(bough_arena *arena, void *self) {
    const opening *o = self;
    bough_session *s = o->session;
    BOUGH_TRY(check_opening(o));
    bough_errors errors = {.arena = arena};
    bough_scene *scene = NULL;
    bough_status status = bough_scene_read(arena, NULL, o->path, o->set, o->n_set, &errors, &scene);
    if (!bough_is_ok(&status)) {
        bool listed = errors.n > 0 && status.code == BOUGH_INVALID;
        if (listed) keep_errors(s, &errors);
        if (listed) status.message[0] = '\0';
        return status;
    }
    // errors are estimated only where the scene asks for it
    if (!bough_node_find(scene->simulation.node, "error_estimate"))
        scene->simulation.error_estimate = BOUGH_SCENE_NO_ESTIMATE;
    for (int k = 0; k < scene->n_input && o->input; k++) bough_scene_start_input(scene, k, o->input[k]);
    BOUGH_TRY(bough_run_create(arena, scene, &s->run));
    bough_pool_region(s->run.pool, start_threads, NULL);
    describe_copy(s);
    s->vertex =
        bough_arena_take(arena, bough_simulation_most_vertices(s->run.simulation) * sizeof *s->vertex);
    s->open = true;
    return status;
}

bough_session *bough_session_open(const char *scene, const char *const *set, int count) {
    return bough_session_open_with(scene, set, count, NULL);
}

bough_session *bough_session_open_with(const char *scene, const char *const *set, int count,
                                       const double *input) {
    bough_session *s = calloc(1, sizeof *s);
    if (!s) return NULL;
    s->arena = bough_arena_create();
    if (!s->arena) {
        free(s);
        return NULL;
    }
    opening o = {s, scene, set, count, input};
    locale_t callers = bough_c_locale();
    s->opening = conclude(s, bough_arena_guard(s->arena, build, &o));
    uselocale(callers);
    return s;
}

int bough_session_code(const bough_session *s) { return s ? s->code : BOUGH_SESSION_OTHER; }

const char *bough_session_error(const bough_session *s) {
    return s ? s->error : "there is no session (NULL): its opening ran out of memory";
}

const char *bough_session_warning(const bough_session *s) {
    return is_open(s) ? s->run.simulation->master->verdict : "";
}

int bough_session_step(bough_session *s) {
    if (!has_scene(s, "step")) return bough_session_code(s);
    if (!bough_is_ok(&s->run.outcome)) return conclude(s, s->run.outcome);
    if (bough_run_done(&s->run)) return BOUGH_SESSION_DONE;
    return conclude(s, bough_run_step(&s->run));
}

double bough_session_time(const bough_session *s) {
    return is_open(s) ? s->run.simulation->master->time : (double)NAN;
}

double bough_session_duration(const bough_session *s) {
    return is_open(s) ? s->run.simulation->master->duration : (double)NAN;
}

double bough_session_macro_step(const bough_session *s) {
    return is_open(s) ? s->run.simulation->master->macro_step : (double)NAN;
}

int bough_session_count(const bough_session *s) { return is_open(s) ? s->run.channels.count : 0; }

static bool known(const bough_session *s, int channel) {
    return channel >= 0 && channel < bough_session_count(s);
}

const char *bough_session_name(const bough_session *s, int channel) {
    return known(s, channel) ? s->run.channels.channel[channel].name : "";
}

const char *bough_session_unit(const bough_session *s, int channel) {
    return known(s, channel) ? s->run.channels.channel[channel].unit : "";
}

// The index of a name among n; -1 with a message that names the nearest of them.
static int find_name(bough_session *s, const char *what, const char *name, int n,
                     const char *(*name_of)(const bough_session *session, int k)) {
    const char *shown = name ? name : "";
    for (int k = 0; k < n; k++) {
        if (strcmp(name_of(s, k), shown) == 0) return k;
    }
    if (!has_scene(s, what)) return -1;
    const char **names = malloc((size_t)(n + 1) * sizeof *names);
    for (int k = 0; k < n && names; k++) names[k] = name_of(s, k);
    REFUSE(s, "the scene has no %s '%.80s'%s", what, shown, bough_suggest(shown, names, names ? n : 0).text);
    free(names);
    return -1;
}

int bough_session_find(bough_session *s, const char *name) {
    return find_name(s, "channel", name, bough_session_count(s), bough_session_name);
}

const double *bough_session_values(bough_session *s) {
    if (!is_open(s)) return NULL;
    return s->run.channels.count > 0 ? bough_run_values(&s->run) : NULL;
}

double bough_session_read(bough_session *s, int channel) {
    const double *value = known(s, channel) ? bough_session_values(s) : NULL;
    return value ? value[channel] : (double)NAN;
}

double bough_session_estimate(const bough_session *s, int channel) {
    bool there = known(s, channel) && bough_companion_knows(s->run.companion, channel);
    return there ? s->run.companion->error[channel] : (double)NAN;
}

// -- poses ----------------------------------------------------------------------------------------

int bough_session_bodies(const bough_session *s) { return is_open(s) ? s->run.simulation->scene->n_body : 0; }

static bool is_body(const bough_session *s, int body) { return body >= 0 && body < bough_session_bodies(s); }

const char *bough_session_body_name(const bough_session *s, int body) {
    return is_body(s, body) ? s->run.simulation->scene->body[body].name : "";
}

int bough_session_stations(const bough_session *s, int body) {
    if (!is_body(s, body)) return 0;
    const bough_beam *beam = bough_simulation_beam(s->run.simulation, body);
    return beam ? beam->def.n_segment + 1 : 1;
}

int bough_session_poses(bough_session *s, int body, double *position, double *rotation) {
    if (!has_state(s, "poses")) return bough_session_code(s);
    if (!is_body(s, body) || !position || !rotation)
        return REFUSE(s, "poses: no body of index %d, or no memory is given (NULL)", body);
    bough_simulation *x = s->run.simulation;
    const bough_beam *beam = bough_simulation_beam(x, body);
    bough_simulation_update(x);
    if (beam) {
        bough_simulation_beam_motion(x, beam, s->vertex);
    } else {
        bough_transform pose = bough_tree_frame_pose(x->view, &x->tree->bodies[body]);
        s->vertex[0] = (bough_vertex_motion){.position = pose.position, .rotation = pose.rotation};
    }
    for (int k = 0; k < bough_session_stations(s, body); k++) {
        bough_mat3 rows = bough_mat3_transpose(s->vertex[k].rotation);
        bough_v3_store(s->vertex[k].position, position + 3 * k);
        bough_v3_store(rows.c1, rotation + 9 * k);
        bough_v3_store(rows.c2, rotation + 9 * k + 3);
        bough_v3_store(rows.c3, rotation + 9 * k + 6);
    }
    return conclude(s, bough_ok());
}

// -- inputs ---------------------------------------------------------------------------------------

static const bough_scene_input *input_at(const bough_session *s, int input) {
    return &s->run.simulation->scene->input[input];
}

static bool is_input(const bough_session *s, int input) {
    return input >= 0 && input < bough_session_inputs(s);
}

static bough_dimension input_dimension(const bough_session *s, int input) {
    return (bough_dimension)input_at(s, input)->dimension;
}

int bough_session_inputs(const bough_session *s) {
    return is_open(s) ? s->run.simulation->scene->n_input : 0;
}

const char *bough_session_input_name(const bough_session *s, int input) {
    return is_input(s, input) ? input_at(s, input)->name : "";
}

const char *bough_session_input_unit(const bough_session *s, int input) {
    return is_input(s, input) ? bough_dimension_unit(input_dimension(s, input)) : "";
}

int bough_session_input(bough_session *s, const char *name) {
    if (is_open(s) && bough_session_inputs(s) == 0) {
        REFUSE(s,
               "the scene has no input '%.80s': it declares none, as 'input: NAME' of a load or of the wind "
               "does",
               name ? name : "");
        return -1;
    }
    return find_name(s, "input", name, bough_session_inputs(s), bough_session_input_name);
}

double bough_session_input_value(const bough_session *s, int input) {
    return is_input(s, input) ? s->run.simulation->input[input] : (double)NAN;
}

int bough_session_set(bough_session *s, int input, double value) {
    if (!has_state(s, "set")) return bough_session_code(s);
    if (!is_input(s, input))
        return REFUSE(s, "the scene has no input of index %d: it has %d", input, bough_session_inputs(s));
    const char *name = bough_session_input_name(s, input);
    const char *range = input_at(s, input)->range; // what the scene's keys allow of the same quantity
    if (!isfinite(value)) return REFUSE(s, "input %s: expected a finite number, got %g", name, value);
    if (!bough_in_range(value, range))
        return REFUSE(s, "input %s: must be %s%s %s, got %g", name, range[0] == '[' ? "in " : "", range,
                      bough_session_input_unit(s, input), value);
    s->run.simulation->input[input] = value;
    return conclude(s, bough_ok());
}

int bough_session_set_text(bough_session *s, int input, const char *text) {
    double value = (double)NAN;
    char why[160] = "";
    if (!text) text = "";
    locale_t callers = bough_c_locale();
    bool good = !is_input(s, input) || bough_quantity(text, input_dimension(s, input), &value, why);
    uselocale(callers);
    if (!good)
        return REFUSE(s, "input %s: expected a value in %s, got '%.80s'%s%s",
                      bough_session_input_name(s, input), bough_session_input_unit(s, input), text,
                      why[0] ? ": " : "", why);
    return bough_session_set(s, input, value);
}

void bough_session_close(bough_session *s) {
    if (!s) return;
    bough_arena_destroy(s->arena);
    free(s);
}
