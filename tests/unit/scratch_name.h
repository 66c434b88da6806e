// A name for mkdtemp or mkstemp in $TMPDIR, else in /tmp.
#pragma once

#include <stdio.h>
#include <stdlib.h>

enum { SCRATCH_NAME = 256, SCRATCH_PATH = SCRATCH_NAME + 128 };

static inline char *scratch_name(char name[SCRATCH_NAME]) {
    const char *folder = getenv("TMPDIR");
    snprintf(name, SCRATCH_NAME, "%s/bough-test-XXXXXX", folder && *folder ? folder : "/tmp");
    return name;
}
