#include "apps/bough/results/folder.h"

#include <dirent.h>
#include <errno.h>
#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

static bough_status make_one(const char *path) {
    if (mkdir(path, 0777) == 0) return bough_ok();
    int error = errno;
    struct stat info;
    if (stat(path, &info) == 0) {
        if (S_ISDIR(info.st_mode)) return bough_ok();
        return bough_fail(BOUGH_IO, "'%.200s' is a file; results need a folder: name another with --out",
                          path);
    }
    return bough_fail(BOUGH_IO, "cannot create the folder '%.200s': %s", path, strerror(error));
}

bough_status bough_folder_make(const char *path) {
    char part[BOUGH_PATH_MAX];
    size_t length = strlen(path);
    if (length == 0) return bough_fail(BOUGH_INVALID, "the results folder has an empty name");
    if (length >= sizeof part) return bough_fail(BOUGH_INVALID, "the results folder's name is too long");
    memcpy(part, path, length + 1);
    for (size_t i = 1; i < length; i++) {
        if (part[i] != '/') continue;
        part[i] = '\0';
        BOUGH_TRY(make_one(part));
        part[i] = '/';
    }
    BOUGH_TRY(make_one(part));
    if (access(path, W_OK | X_OK) == 0) return bough_ok();
    return bough_fail(BOUGH_IO, "cannot write into the folder '%.200s': %s", path, strerror(errno));
}

bough_status bough_folder_path(const char *folder, const char *name, char *path) {
    int length = snprintf(path, BOUGH_PATH_MAX, "%s/%s", folder, name);
    if (length < BOUGH_PATH_MAX) return bough_ok();
    return bough_fail(BOUGH_INVALID, "the path of '%s' in the results folder is too long", name);
}

typedef char partial_path[BOUGH_PATH_MAX + sizeof ".partial"];

static void name_partial(const char *path, partial_path partial) {
    snprintf(partial, sizeof(partial_path), "%s.partial", path);
}

bough_status bough_folder_open(const char *folder, const char *name, char *path, FILE **file) {
    partial_path partial;
    BOUGH_TRY(bough_folder_make(folder));
    BOUGH_TRY(bough_folder_path(folder, name, path));
    name_partial(path, partial);
    // without O_NONBLOCK the call would wait for a pipe's reader
    int descriptor = open(partial, O_WRONLY | O_CREAT | O_TRUNC | O_NONBLOCK | O_CLOEXEC, 0666);
    *file = descriptor < 0 ? NULL : fdopen(descriptor, "w");
    if (*file) return bough_ok();
    bough_status status = bough_fail(BOUGH_IO, "cannot write '%.200s': %s", partial, strerror(errno));
    if (descriptor >= 0) close(descriptor);
    return status;
}

bough_status bough_folder_write(const char *folder, const char *name,
                                void (*write)(const void *self, FILE *file), const void *self) {
    char path[BOUGH_PATH_MAX];
    FILE *file = NULL;
    BOUGH_TRY(bough_folder_open(folder, name, path, &file));
    write(self, file);
    return bough_folder_close(path, file, bough_ok());
}

// Regular files only: a symbolic link is not one that bough has made.
void bough_folder_clean(const char *folder) {
    DIR *directory = opendir(folder);
    if (!directory) return;
    for (const struct dirent *entry; (entry = readdir(directory)) != NULL;) {
        char path[BOUGH_PATH_MAX];
        struct stat info;
        const char *end = strrchr(entry->d_name, '.');
        if (!end || strcmp(end, ".partial") != 0) continue;
        bough_status status = bough_folder_path(folder, entry->d_name, path);
        if (bough_is_ok(&status) && lstat(path, &info) == 0 && S_ISREG(info.st_mode)) unlink(path);
    }
    closedir(directory);
}

bough_status bough_folder_remove(const char *folder, const char *name) {
    char path[BOUGH_PATH_MAX];
    bough_status status = bough_folder_path(folder, name, path);
    if (!bough_is_ok(&status) || unlink(path) == 0 || errno == ENOENT) return status;
    return bough_fail(BOUGH_IO, "cannot replace '%.200s': %s", path, strerror(errno));
}

bough_status bough_folder_close(const char *path, FILE *file, bough_status status) {
    partial_path partial;
    name_partial(path, partial);
    bool broken = ferror(file) != 0;
    broken = fclose(file) != 0 || broken;
    if (!bough_is_ok(&status)) {
        unlink(partial);
        return status;
    }
    if (broken) {
        return bough_fail(BOUGH_IO, "cannot finish '%.200s': %s", partial,
                          errno ? strerror(errno) : "an earlier write failed");
    }
    if (rename(partial, path) == 0) return bough_ok();
    return bough_fail(BOUGH_IO, "cannot rename '%.200s': %s", partial, strerror(errno));
}

// -- files that grow ------------------------------------------------------------------------------

static bough_status reopen(const char *path, long bytes, FILE **file) {
    partial_path partial;
    struct stat info;
    name_partial(path, partial);
    if (stat(partial, &info) != 0 && errno == ENOENT) rename(path, partial);
    if (stat(partial, &info) != 0 || info.st_size < bytes) {
        return bough_fail(
            BOUGH_INVALID,
            "'%.200s' lacks rows that the checkpoint needs; without --resume the run starts anew", partial);
    }
    *file = fopen(partial, "r+");
    if (*file && ftruncate(fileno(*file), bytes) == 0 && fseek(*file, bytes, SEEK_SET) == 0)
        return bough_ok();
    return bough_fail(BOUGH_IO, "cannot write '%.200s': %s", partial, strerror(errno));
}

static void close_growing(void *self) {
    bough_growing *g = self;
    if (g->file) fclose(g->file);
}

bough_status bough_growing_open(bough_arena *arena, const char *folder, const char *name, bough_kept kept,
                                bough_growing *g) {
    *g = (bough_growing){.count = kept.count};
    bough_arena_on_destroy(arena, close_growing, g);
    if (kept.count == 0) return bough_folder_open(folder, name, g->path, &g->file);
    BOUGH_TRY(bough_folder_path(folder, name, g->path));
    return reopen(g->path, kept.bytes, &g->file);
}

bough_status bough_growing_keep(const bough_growing *g, bough_kept *kept) {
    errno = 0;
    bool good = !ferror(g->file) && fflush(g->file) == 0 && fsync(fileno(g->file)) == 0;
    *kept = (bough_kept){g->count, good ? ftell(g->file) : -1};
    if (kept->bytes >= 0) return bough_ok();
    return bough_fail(BOUGH_IO, "cannot write '%.200s.partial': %s", g->path,
                      errno ? strerror(errno) : "an earlier write failed");
}

bough_status bough_growing_finish(bough_growing *g) {
    FILE *file = g->file;
    g->file = NULL;
    return bough_folder_close(g->path, file, bough_ok());
}

// -- the lock -------------------------------------------------------------------------------------

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
        return bough_fail(
            BOUGH_IO,
            "process %ld is writing results into '%.200s'; wait for it, or name another folder with --out",
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
        // on a file system without locks several processes can write
        if (held || !taken) return status;
    }
}

bough_status bough_lock_folder(bough_arena *arena, const char *folder) {
    lock *l = bough_arena_take(arena, sizeof *l);
    l->file = -1;
    bough_arena_on_destroy(arena, release, l);
    BOUGH_TRY(bough_folder_path(folder, "running.lock", l->path));
    return take(l, folder);
}
