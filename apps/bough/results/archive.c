#include "apps/bough/results/archive.h"

#include "core/base/input_file.h"

#include <string.h>
#include <zlib.h>

enum { LOCAL = 0x04034b50, CENTRAL = 0x02014b50, END = 0x06054b50 };
enum { DAY = 1 << 5 | 1, VERSION = 20, UTF8 = 1 << 11 }; // 1 January 1980: the same scene, the same file

static void put(FILE *file, uint32_t value, int bytes) {
    for (int i = 0; i < bytes; i++) fputc((int)(value >> 8 * i & 0xff), file);
}

// What the head of a file and its line in the directory share.
static void put_entry(FILE *file, const bough_archive_entry *entry) {
    put(file, VERSION, 2);
    put(file, UTF8, 2);
    put(file, 0, 2); // stored
    put(file, 0, 2); // midnight
    put(file, DAY, 2);
    put(file, entry->sum, 4);
    put(file, entry->size, 4);
    put(file, entry->size, 4);
    put(file, (uint32_t)strlen(entry->name), 2);
    put(file, 0, 2);
}

static bough_archive_entry *next_entry(bough_archive *a) {
    if (a->n == a->room) {
        bough_archive_entry *old = a->entry;
        a->room = 2 * a->room + 16;
        a->entry = bough_arena_take(a->arena, (size_t)a->room * sizeof *a->entry);
        if (a->n > 0) memcpy(a->entry, old, (size_t)a->n * sizeof *old);
    }
    return &a->entry[a->n++];
}

bough_status bough_archive_add(bough_archive *a, const char *name, const void *bytes, size_t size) {
    long at = ftell(a->file);
    if (a->n == UINT16_MAX || at < 0 || size + (size_t)at > UINT32_MAX - (1u << 20)) {
        return bough_fail(BOUGH_INVALID, "the archive has no room for '%.200s'", name);
    }
    bough_archive_entry *entry = next_entry(a);
    *entry = (bough_archive_entry){name, (uint32_t)crc32_z(0, bytes, size), (uint32_t)size, (uint32_t)at};
    put(a->file, LOCAL, 4);
    put_entry(a->file, entry);
    fputs(name, a->file);
    fwrite(bytes, 1, size, a->file);
    return bough_ok();
}

bough_status bough_archive_copy(bough_archive *a, const char *name, const char *path) {
    char why[BOUGH_INPUT_REASON];
    size_t size;
    bough_arena *own = bough_arena_child(a->arena);
    const char *bytes = bough_input_read(own, path, BOUGH_INPUT_DATA, &size, why);
    bough_status status = bytes ? bough_archive_add(a, name, bytes, size)
                                : bough_fail(BOUGH_IO, "cannot read '%.200s': %s", path, why);
    bough_arena_destroy(own);
    return status;
}

void bough_archive_end(bough_archive *a) {
    uint32_t at = (uint32_t)ftell(a->file);
    for (int k = 0; k < a->n; k++) {
        put(a->file, CENTRAL, 4);
        put(a->file, VERSION, 2);
        put_entry(a->file, &a->entry[k]);
        put(a->file, 0, 2); // comment
        put(a->file, 0, 2);
        put(a->file, 0, 2);
        put(a->file, 0, 4);
        put(a->file, a->entry[k].at, 4);
        fputs(a->entry[k].name, a->file);
    }
    uint32_t size = (uint32_t)ftell(a->file) - at;
    put(a->file, END, 4);
    put(a->file, 0, 4);
    put(a->file, (uint32_t)a->n, 2);
    put(a->file, (uint32_t)a->n, 2);
    put(a->file, size, 4);
    put(a->file, at, 4);
    put(a->file, 0, 2);
}
