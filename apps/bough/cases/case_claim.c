#include "apps/bough/cases/case_claim.h"

#include "apps/bough/results/folder.h"

#include <errno.h>
#include <fcntl.h>
#include <string.h>
#include <unistd.h>

static void release(void *self) { close(*(int *)self); }

bough_status bough_claims_open(bough_arena *arena, const char *folder, int *claims) {
    char path[BOUGH_PATH_MAX];
    int *file = bough_arena_take(arena, sizeof *file);
    bough_status status = bough_folder_path(folder, "cases/claims", path);
    if (!bough_is_ok(&status) || !file) return status;
    *claims = *file = open(path, O_RDWR | O_CREAT | O_NONBLOCK | O_CLOEXEC, 0666);
    if (*file < 0) return bough_fail(BOUGH_IO, "cannot write '%.200s': %s", path, strerror(errno));
    bough_arena_on_destroy(arena, release, file);
    return status;
}

static bool set_lock(int claims, int number, short type) {
    struct flock byte = {.l_type = type, .l_whence = SEEK_SET, .l_start = (off_t)number, .l_len = 1};
    return fcntl(claims, F_SETLK, &byte) == 0 || (errno != EACCES && errno != EAGAIN);
}

bool bough_claim(int claims, int number) { return set_lock(claims, number, F_WRLCK); }

void bough_claim_drop(int claims, int number) { set_lock(claims, number, F_UNLCK); }
