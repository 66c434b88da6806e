// A record lock of fcntl(2) on a file in the folder: the system knows its owner and drops it with the
// process. The file goes with the lock; a file that a killed process leaves blocks no other process.
#include "apps/bough/results/lock.h"

#include "apps/bough/results/folder.h"

#include <errno.h>
#include <fcntl.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

typedef struct lock {
    int file;
    char path[BOUGH_PATH_MAX];
} lock;

static void release(void *self) {
    lock *l = self;
    if (l->file < 0) return;
    unlink(l->path); // before the lock is released: no process may lock a file without a name
    close(l->file);
    l->file = -1;
}

static bough_status refuse(const char *folder, int file) {
    struct flock owner = {.l_type = F_WRLCK, .l_whence = SEEK_SET};
    if (fcntl(file, F_GETLK, &owner) == 0 && owner.l_type != F_UNLCK && owner.l_pid > 0) {
        return bough_fail(BOUGH_IO,
                          "process %ld is writing results into '%.200s'; wait for it, or name "
                          "another folder with --out",
                          (long)owner.l_pid, folder);
    }
    return bough_fail(BOUGH_IO, "another process is writing results into '%.200s'", folder);
}

// Whether the file still has its name: its last owner may have removed it between open and lock.
static bool is_named(const lock *l) {
    struct stat open_file, named;
    return fstat(l->file, &open_file) == 0 && stat(l->path, &named) == 0 &&
           open_file.st_ino == named.st_ino && open_file.st_dev == named.st_dev;
}

static bough_status take(lock *l, const char *folder) {
    for (;;) {
        l->file = open(l->path, O_RDWR | O_CREAT | O_NONBLOCK | O_CLOEXEC, 0666);
        if (l->file < 0) {
            return bough_fail(BOUGH_IO, "cannot write '%.200s': %s", l->path, strerror(errno));
        }
        struct flock mine = {.l_type = F_WRLCK, .l_whence = SEEK_SET};
        bool taken = fcntl(l->file, F_SETLK, &mine) == 0;
        bool held = !taken && (errno == EACCES || errno == EAGAIN);
        if (taken && is_named(l)) return bough_ok();
        bough_status status = held ? refuse(folder, l->file) : bough_ok();
        close(l->file);
        l->file = -1;
        // A file system without locks lets everybody write, as it always has.
        if (held || !taken) return status;
    }
}

bough_status bough_lock_folder(bough_arena *arena, const char *folder) {
    lock *l = bough_arena_take(arena, sizeof *l);
    l->file = -1;
    bough_arena_on_destroy(arena, release, l);
    bough_status status = bough_folder_path(folder, "running.lock", l->path);
    return bough_is_ok(&status) ? take(l, folder) : status;
}
