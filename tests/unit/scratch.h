// A folder of its own for a test that writes files, and the files' text.
#pragma once

#include "tests/unit/check.h"
#include "tests/unit/scratch_name.h"

#include <dirent.h>
#include <unistd.h>

enum { SCRATCH_TEXT = 1 << 20 };

// cmocka set-up and tear-down: *state is the folder's path. It may hold folders of files.
static inline int scratch_make(void **state) {
    char *path = malloc(SCRATCH_NAME);
    if (!path) return -1;
    *state = path;
    return mkdtemp(scratch_name(path)) ? 0 : -1;
}

static inline int scratch_empty(const char *path) {
    char name[512];
    DIR *folder = opendir(path);
    for (struct dirent *entry; folder && (entry = readdir(folder));) {
        snprintf(name, sizeof name, "%s/%s", path, entry->d_name);
        if (entry->d_name[0] != '.' && remove(name) != 0) scratch_empty(name);
    }
    if (folder) closedir(folder);
    return rmdir(path);
}

static inline int scratch_remove(void **state) {
    int result = scratch_empty(*state);
    free(*state);
    return result;
}

// A test that writes files: *context is the path of its folder.
#define TEST_IN_FOLDER(name) TEST_WITH(name, scratch_make, scratch_remove)

// folder/name, opened.
static inline FILE *scratch_open(const char *folder, const char *name, const char *mode) {
    char path[SCRATCH_PATH];
    snprintf(path, sizeof path, "%s/%s", folder, name);
    FILE *file = fopen(path, mode);
    if (!file) fail_msg("cannot open %s", path);
    return file;
}

static inline void scratch_write(const char *folder, const char *name, const char *text) {
    FILE *file = scratch_open(folder, name, "w");
    fputs(text, file);
    fclose(file);
}

// The whole text of folder/name, to be freed; NULL when there is no such file.
static inline char *scratch_read(const char *folder, const char *name) {
    char path[512];
    snprintf(path, sizeof path, "%s/%s", folder, name);
    FILE *file = fopen(path, "r");
    if (!file) return NULL;
    char *text = calloc(1, SCRATCH_TEXT);
    if (text) text[fread(text, 1, SCRATCH_TEXT - 1, file)] = '\0';
    fclose(file);
    return text;
}

// The number of files folder/name/*ending; `first` (256, or NULL) receives the path of one of them.
static inline int scratch_files(const char *folder, const char *name, const char *ending, char *first) {
    char path[512];
    int n = 0;
    snprintf(path, sizeof path, "%s/%s", folder, name);
    DIR *stream = opendir(path);
    for (struct dirent *entry; stream && (entry = readdir(stream));) {
        size_t length = strlen(entry->d_name), end = strlen(ending);
        if (length < end || strcmp(entry->d_name + length - end, ending) != 0) continue;
        if (first && n == 0) snprintf(first, 256, "%.60s/%.180s", name, entry->d_name);
        n++;
    }
    if (stream) closedir(stream);
    return n;
}

static inline bool scratch_has(const char *folder, const char *name) {
    char path[512];
    snprintf(path, sizeof path, "%s/%s", folder, name);
    return access(path, F_OK) == 0;
}
