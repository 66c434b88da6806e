// The folder that receives a run's results, and files in it that are complete or absent: they are
// written under another name and renamed at the end.
#pragma once

#include "core/base/arena.h"

enum { BOUGH_PATH_MAX = 4096 };

// Makes the folder and its missing parents. Refuses a path that is taken by a file, or a folder
// that cannot be written.
bough_status bough_folder_make(const char *path);

// path = folder/name; refuses what does not fit into BOUGH_PATH_MAX.
bough_status bough_folder_path(const char *folder, const char *name, char *path);

// Makes the folder and opens folder/name.partial for writing; the path without ".partial" goes to `path`
// (BOUGH_PATH_MAX).
bough_status bough_folder_open(const char *folder, const char *name, char *path, FILE **file);

// Writes a whole file of the folder, which is made: what `write` prints of `self`.
bough_status bough_folder_write(const char *folder, const char *name,
                                void (*write)(const void *self, FILE *file), const void *self);

// Removes the partial files that a process which died has left in an existing folder.
void bough_folder_clean(const char *folder);

// Removes folder/name if there is one.
bough_status bough_folder_remove(const char *folder, const char *name);

// Closes the file. If all has been written (`status` is good), path.partial gets its final name; a write
// error noticed only now is reported, and the partial file is then left as it is. With any other status
// path.partial is removed, and that status is returned.
bough_status bough_folder_close(const char *path, FILE *file, bough_status status);

// -- a file that grows with a run ------------------------------------------------------------------

// The part of it that is on the disk.
typedef struct bough_kept {
    long count; // rows or frames
    long bytes;
} bough_kept;

typedef struct bough_growing {
    char path[BOUGH_PATH_MAX]; // of path.partial until it is finished
    FILE *file;                // NULL once it is
    long count;                // rows or frames so far
} bough_growing;

// Opens folder/name: a new file, or one that continues after the part that an earlier process has kept, with
// the rest cut off. A file that has its final name becomes partial again. BOUGH_INVALID when there is
// less than was kept. The arena closes what is not finished.
bough_status bough_growing_open(bough_arena *arena, const char *folder, const char *name, bough_kept kept,
                                bough_growing *growing);

// Brings what is written to the disk.
bough_status bough_growing_keep(const bough_growing *growing, bough_kept *kept);

// Gives the file its name.
bough_status bough_growing_finish(bough_growing *growing);

// -- one process at a time writes into a folder ---------------------------------------------------

// Locks an existing folder until the arena is destroyed or the process ends, in whatever way. A folder
// that another process holds is refused with that process's number.
bough_status bough_lock_folder(bough_arena *arena, const char *folder);
