// A ZIP archive whose files are stored as they are (PKWARE's APPNOTE 6.3, without ZIP64: at most 4 GB).
#ifndef BOUGH_APPS_RESULTS_ARCHIVE_H
#define BOUGH_APPS_RESULTS_ARCHIVE_H

#include "core/base/arena.h"
#include "core/base/status.h"

#include <stdint.h>
#include <stdio.h>

typedef struct bough_archive_entry {
    const char *name; // "resources/scene.yaml"; borrowed until the end
    uint32_t sum, size, at;
} bough_archive_entry;

typedef struct bough_archive {
    bough_arena *arena; // of copies and entries
    FILE *file;         // open for writing, at its start
    int n, room;
    bough_archive_entry *entry; // (room), n of them filled
} bough_archive;

// Appends a file of `size` bytes. BOUGH_INVALID when it does not fit: 4 GB or 65535 files.
bough_status bough_archive_add(bough_archive *archive, const char *name, const void *bytes, size_t size);

// Appends a copy of the file at `path`. BOUGH_IO when it cannot be read.
bough_status bough_archive_copy(bough_archive *archive, const char *name, const char *path);

// Writes the directory that ends the archive; the stream is the caller's to close.
void bough_archive_end(bough_archive *archive);

#endif
