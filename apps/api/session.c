#include "apps/api/bough.h"

#include "apps/scene/build.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { ERROR_TEXT = 2000 };

struct bough_session {
    bough_arena *arena;
    bough_simulation *simulation; // NULL when it could not be opened
    bough_channels channels;
    double *value; // (channels.count)
    bool sampled;  // value belongs to the current time
    int code;
    char error[ERROR_TEXT];
};

static int settle(bough_session *s, bough_status status) {
    s->code = bough_is_ok(&status) ? BOUGH_SESSION_OK : bough_exit_code(status.code);
    if (!bough_is_ok(&status) && status.message[0]) {
        snprintf(s->error, sizeof s->error, "%s", status.message);
    }
    return s->code;
}

// All errors of the scene, a line each; as many as there is room for.
static void keep_errors(bough_session *s, const bough_errors *errors) {
    FILE *text = fmemopen(s->error, sizeof s->error, "w");
    if (!text) return;
    bough_errors_print(errors, text);
    fclose(text);
    s->error[sizeof s->error - 1] = '\0';
}

static bough_status build(bough_session *s, const char *path, const char *const *set, int count) {
    bough_errors errors = {.arena = s->arena};
    bough_scene *scene = NULL;
    bough_status status = bough_scene_read(s->arena, path, set, count, &errors, &scene);
    if (!bough_is_ok(&status)) {
        if (errors.n > 0) keep_errors(s, &errors);
        if (errors.n > 0) status.message[0] = '\0';
        return status;
    }
    status = bough_simulation_build(s->arena, scene, &s->simulation);
    if (!bough_is_ok(&status)) s->simulation = NULL;
    if (!bough_is_ok(&status)) return status;
    s->channels = bough_channels_start(s->arena);
    status = bough_simulation_channels(s->simulation, &s->channels);
    s->value = bough_arena_doubles(s->arena, (size_t)s->channels.count + 1);
    if (s->value) return status;
    return bough_fail(BOUGH_OUT_OF_MEMORY, "out of memory");
}

bough_session *bough_session_open(const char *scene, const char *const *set, int count) {
    bough_session *s = calloc(1, sizeof *s);
    if (!s) return NULL;
    s->arena = bough_arena_create();
    settle(s, s->arena ? build(s, scene, set, count)
                       : bough_fail(BOUGH_OUT_OF_MEMORY, "out of memory"));
    return s;
}

int bough_session_code(const bough_session *s) { return s->code; }

const char *bough_session_error(const bough_session *s) { return s->error; }

const char *bough_session_warning(const bough_session *s) {
    return s->simulation ? s->simulation->master->verdict : "";
}

int bough_session_step(bough_session *s) {
    if (s->code != BOUGH_SESSION_OK) return s->code;
    if (bough_master_done(s->simulation->master)) return BOUGH_SESSION_DONE;
    s->sampled = false;
    return settle(s, bough_step(s->simulation->master));
}

double bough_session_time(const bough_session *s) {
    return s->simulation ? s->simulation->master->time : (double)NAN;
}

double bough_session_duration(const bough_session *s) {
    return s->simulation ? s->simulation->master->duration : (double)NAN;
}

int bough_session_count(const bough_session *s) { return s->channels.count; }

static bool known(const bough_session *s, int channel) {
    return channel >= 0 && channel < s->channels.count;
}

const char *bough_session_name(const bough_session *s, int channel) {
    return known(s, channel) ? s->channels.channel[channel].name : "";
}

const char *bough_session_unit(const bough_session *s, int channel) {
    return known(s, channel) ? s->channels.channel[channel].unit : "";
}

int bough_session_find(const bough_session *s, const char *name) {
    return s->channels.count > 0 ? bough_channels_find(&s->channels, name) : -1;
}

double bough_session_read(bough_session *s, int channel) {
    if (!known(s, channel) || s->code == BOUGH_SESSION_FAILED) return (double)NAN;
    if (!s->sampled) {
        bough_simulation_update(s->simulation);
        bough_channels_sample(&s->channels, s->simulation->master->time, s->value);
        s->sampled = true;
    }
    return s->value[channel];
}

void bough_session_close(bough_session *s) {
    if (!s) return;
    bough_arena_destroy(s->arena);
    free(s);
}
