#include "core/base/input_file.h"

#include <errno.h>
#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

// Whether it may be read; else errno and the reason.
static bool is_readable(int file, int64_t most, char *reason) {
    struct stat info;
    errno = 0;
    // a folder, pipe or device opens without error but has no end
    if (fstat(file, &info) != 0) {
        snprintf(reason, BOUGH_INPUT_REASON, "%s", strerror(errno));
    } else if (S_ISDIR(info.st_mode)) {
        errno = EISDIR;
        snprintf(reason, BOUGH_INPUT_REASON, "%s", strerror(errno));
    } else if (!S_ISREG(info.st_mode)) {
        errno = EINVAL;
        snprintf(reason, BOUGH_INPUT_REASON, "it is a %s, not a regular file",
                 S_ISFIFO(info.st_mode) ? "pipe" : "device");
    } else if (info.st_size > most) {
        errno = EFBIG;
        snprintf(reason, BOUGH_INPUT_REASON, "the file is larger than %lld MB", (long long)(most >> 20));
    }
    return errno == 0;
}

FILE *bough_input_open(const char *path, int64_t most, char reason[BOUGH_INPUT_REASON]) {
    // Without O_NONBLOCK the call would wait until somebody writes into a pipe.
    int file = open(path, O_RDONLY | O_NONBLOCK | O_CLOEXEC | O_NOCTTY);
    if (file < 0) {
        snprintf(reason, BOUGH_INPUT_REASON, "%s", strerror(errno));
        return NULL;
    }
    FILE *stream = is_readable(file, most, reason) ? fdopen(file, "rb") : NULL;
    if (stream) return stream;
    // errno is the caller's reason: closing must not change it
    int error = errno;
    if (error == ENOMEM) snprintf(reason, BOUGH_INPUT_REASON, "memory is exhausted");
    close(file);
    errno = error;
    return NULL;
}

static void close_file(void *stream) { fclose(stream); }

char *bough_input_read(bough_arena *arena, const char *path, int64_t most, size_t *size,
                       char reason[BOUGH_INPUT_REASON]) {
    FILE *stream = bough_input_open(path, most, reason);
    if (!stream) return NULL;
    bough_arena *own = bough_arena_child(arena); // closes the file also where there is no memory
    bough_arena_on_destroy(own, close_file, stream);
    // the size, and room for one byte more to see that it does not grow
    fseek(stream, 0, SEEK_END);
    long end = ftell(stream);
    size_t expected = end > 0 ? (size_t)end : 0;
    rewind(stream);
    char *bytes = bough_arena_take(arena, expected + 1);
    errno = 0;
    *size = fread(bytes, 1, expected + 1, stream);
    // exactly the bytes of the file, else it changed meanwhile
    bool whole = end >= 0 && !ferror(stream) && *size <= expected;
    if (!whole)
        snprintf(reason, BOUGH_INPUT_REASON, "%s", errno ? strerror(errno) : "it grows during reading");
    bytes[whole ? *size : 0] = '\0';
    bough_arena_destroy(own);
    return whole ? bytes : NULL;
}
