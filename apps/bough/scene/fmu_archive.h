// The archive of an FMU: a ZIP file (PKWARE's APPNOTE 6.3) of at most 4 GB, stored or deflated.
#ifndef BOUGH_APPS_SCENE_FMU_ARCHIVE_H
#define BOUGH_APPS_SCENE_FMU_ARCHIVE_H

#include "core/base/arena.h"
#include "core/base/status.h"

#include <stdbool.h>
#include <stddef.h>

// Whether the name is that of an archive: it ends with ".fmu".
bool bough_fmu_is_archive(const char *path);

// Unpacks all files into a new folder below $TMPDIR, else /tmp, which is removed with the arena.
// BOUGH_INVALID: there is no such archive, it is damaged, encrypted or of ZIP64, or a file's name leads out
// of the folder. BOUGH_IO: the folder cannot be written.
bough_status bough_fmu_archive_unpack(bough_arena *arena, const char *path, const char **folder);

#endif
