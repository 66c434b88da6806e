// Studies of a test's own: written into its folder, read and performed there.
#pragma once

#include "apps/bough/cases/perform.h"
#include "tests/unit/scratch.h"

enum { STUDY_SHOWN = 8192 };

typedef struct study_text {
    bough_arena *arena;
    bough_errors errors;
    bough_study *study;
    char path[SCRATCH_PATH];
} study_text;

static inline bough_status study_open(study_text *s, const char *folder, const char *text) {
    *s = (study_text){.arena = check_memory()};
    s->errors.arena = s->arena;
    snprintf(s->path, sizeof s->path, "%s/study.yaml", folder);
    scratch_write(folder, "study.yaml", text);
    return bough_study_read(s->arena, s->path, 0, &s->errors, &s->study);
}

// One without errors.
static inline study_text study_opened(const char *folder, const char *text) {
    study_text s;
    bough_status status = study_open(&s, folder, text);
    bough_errors_print(&s.errors, stderr);
    check_ok(status);
    return s;
}

// Performs a good study; `options` need no stream, what was printed goes into `shown`.
static inline bough_status study_perform(const char *folder, const char *text, bough_study_options options,
                                         char shown[STUDY_SHOWN]) {
    study_text s = study_opened(folder, text);
    options.folder = folder;
    options.quiet = true;
    options.stream = tmpfile();
    assert_non_null(options.stream);
    bough_status status = bough_study_perform(s.arena, s.study, &options);
    rewind(options.stream);
    memset(shown, 0, STUDY_SHOWN);
    assert_true(fread(shown, 1, STUDY_SHOWN - 1, options.stream) < STUDY_SHOWN - 1);
    fclose(options.stream);
    bough_arena_destroy(s.arena);
    return status;
}

static inline int count(const char *text, const char *what) {
    int n = 0;
    for (; (text = strstr(text, what)); text += strlen(what)) n++;
    return n;
}

static inline int count_in(const char *folder, const char *name, const char *what) {
    char *text = scratch_read(folder, name);
    assert_non_null(text);
    int n = count(text, what);
    free(text);
    return n;
}

// Results in the folder, those of references among them.
static inline int count_results(const char *folder) { return scratch_files(folder, "cases", ".case", NULL); }
