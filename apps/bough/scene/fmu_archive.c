#define _XOPEN_SOURCE 700 // nftw

#include "apps/bough/scene/scene_internal.h"

#include "core/base/bytes.h"
#include "core/base/input_file.h"

#include <errno.h>
#include <ftw.h>
#include <limits.h>
#include <sys/stat.h>
#include <zlib.h>

enum { LOCAL = 0x04034b50, CENTRAL = 0x02014b50, END = 0x06054b50 };
enum { LOCAL_SIZE = 30, CENTRAL_SIZE = 46, END_SIZE = 22 };
enum { STORED = 0, DEFLATED = 8, ENCRYPTED = 1, MOST_RATIO = 1032 }; // deflate's largest ratio

typedef struct archive {
    const char *path;
    const unsigned char *bytes; // (size)
    size_t size, at;            // position of the next entry of the directory
    unsigned left;              // entries from there on
} archive;

typedef struct entry {
    char name[PATH_MAX];
    unsigned method;
    uint32_t sum, packed, size;
    const unsigned char *data; // (packed)
} entry;

static uint32_t number(const unsigned char *at, int bytes) { return (uint32_t)bough_bytes(at, bytes); }

static bough_status damaged(const archive *a, const char *what) {
    return bough_fail(BOUGH_INVALID, "%.200s: %.200s", a->path, what);
}

// -- the directory --------------------------------------------------------------------------------

static bough_status open_archive(bough_arena *arena, const char *path, archive *a) {
    char why[BOUGH_INPUT_REASON];
    *a = (archive){.path = path};
    a->bytes = (unsigned char *)bough_input_read(arena, path, UINT32_MAX, &a->size, why);
    if (!a->bytes) return bough_fail(BOUGH_INVALID, "cannot read %.200s: %s", path, why);
    // the directory's end is followed by a comment of at most 65535 bytes
    for (size_t back = END_SIZE; back <= a->size && back <= END_SIZE + UINT16_MAX; back++) {
        const unsigned char *end = a->bytes + a->size - back;
        if (number(end, 4) != END) continue;
        a->left = number(end + 10, 2);
        a->at = number(end + 16, 4);
        return bough_ok();
    }
    return damaged(a, "no ZIP archive");
}

// Finds the bytes of a file, which follow its local header.
static bough_status find_data(const archive *a, size_t local, entry *e) {
    if (local + LOCAL_SIZE > a->size || number(a->bytes + local, 4) != LOCAL)
        return damaged(a, "the archive is damaged");
    size_t start = local + LOCAL_SIZE + number(a->bytes + local + 26, 2) + number(a->bytes + local + 28, 2);
    if (start + e->packed > a->size) return damaged(a, "the archive is damaged");
    e->data = a->bytes + start;
    return bough_ok();
}

static bough_status next_entry(archive *a, entry *e) {
    const unsigned char *head = a->bytes + a->at;
    if (a->at + CENTRAL_SIZE > a->size || number(head, 4) != CENTRAL)
        return damaged(a, "the archive's directory is damaged, or of ZIP64");
    size_t name = number(head + 28, 2), more = number(head + 30, 2) + number(head + 32, 2);
    if (a->at + CENTRAL_SIZE + name + more > a->size || name >= sizeof e->name)
        return damaged(a, "the archive's directory is damaged");
    memcpy(e->name, head + CENTRAL_SIZE, name);
    e->name[name] = '\0';
    e->method = number(head + 10, 2);
    e->sum = number(head + 16, 4);
    e->packed = number(head + 20, 4);
    e->size = number(head + 24, 4);
    a->at += CENTRAL_SIZE + name + more;
    a->left--;
    bool known = (e->method == STORED && e->packed == e->size) || e->method == DEFLATED;
    if (!known || number(head + 8, 2) & ENCRYPTED) return damaged(a, "a file is encrypted or not deflated");
    if (e->size > (uint64_t)MOST_RATIO * e->packed + MOST_RATIO) return damaged(a, "the archive is damaged");
    return find_data(a, number(head + 42, 4), e);
}

// -- files ----------------------------------------------------------------------------------------

static bool inflated(const entry *e, unsigned char *out) {
    z_stream z = {.next_in = (unsigned char *)e->data,
                  .avail_in = e->packed,
                  .next_out = out,
                  .avail_out = e->size + 1};
    if (inflateInit2(&z, -MAX_WBITS) != Z_OK) return false;
    bool ended = inflate(&z, Z_FINISH) == Z_STREAM_END;
    inflateEnd(&z);
    return ended && z.total_out == e->size;
}

// The content of a file; NULL: it is damaged.
static const unsigned char *extract(bough_arena *arena, const entry *e) {
    if (e->method == STORED) return crc32(0, e->data, e->packed) == e->sum ? e->data : NULL;
    unsigned char *out = bough_arena_take(arena, (size_t)e->size + 1);
    return inflated(e, out) && crc32(0, out, e->size) == e->sum ? out : NULL;
}

bool bough_fmu_is_archive(const char *path) {
    size_t length = strlen(path);
    return length > 4 && strcmp(path + length - 4, ".fmu") == 0;
}

// -- unpacked -------------------------------------------------------------------------------------

// A path below the folder: relative, and without "..".
static bool stays_inside(const char *name) {
    if (name[0] == '/' || name[0] == '\0') return false;
    for (const char *part = name; part; part = strchr(part, '/')) {
        part += *part == '/';
        if (strncmp(part, "..", 2) == 0 && (part[2] == '/' || part[2] == '\0')) return false;
    }
    return true;
}

static bough_status cannot_write(const char *path) {
    return bough_fail(BOUGH_IO, "cannot write %.200s: %s", path, strerror(errno));
}

// Writes a file with the folders above it; a name that ends with a slash is a folder.
static bough_status write_file(char *path, size_t inside, const unsigned char *bytes, size_t size) {
    for (char *slash = path + inside; (slash = strchr(slash, '/')) != NULL; slash++) {
        *slash = '\0';
        bool made = mkdir(path, 0700) == 0 || errno == EEXIST;
        if (!made) return cannot_write(path);
        *slash = '/';
        if (slash[1] == '\0') return bough_ok();
    }
    FILE *file = fopen(path, "wb");
    if (!file) return cannot_write(path);
    bool good = fwrite(bytes, 1, size, file) == size;
    return fclose(file) == 0 && good ? bough_ok() : cannot_write(path);
}

static bough_status unpack_entry(bough_arena *arena, archive *a, const char *folder) {
    entry e;
    BOUGH_TRY(next_entry(a, &e));
    if (!stays_inside(e.name)) return damaged(a, "the name of a file leads out of the archive");
    bough_arena *own = bough_arena_child(arena);
    char *path = bough_arena_print(own, "%s/%s", folder, e.name);
    const unsigned char *bytes = extract(own, &e);
    bough_status status = bytes ? write_file(path, strlen(folder) + 1, bytes, e.size)
                                : damaged(a, "a file of the archive is damaged");
    bough_arena_destroy(own);
    return status;
}

static int remove_one(const char *path, const struct stat *about, int kind, struct FTW *place) {
    (void)about, (void)kind, (void)place;
    return remove(path);
}

static void remove_folder(void *folder) { nftw(folder, remove_one, 16, FTW_DEPTH | FTW_PHYS); }

bough_status bough_fmu_archive_unpack(bough_arena *arena, const char *path, const char **folder) {
    const char *above = getenv("TMPDIR");
    char *made = bough_arena_print(arena, "%s/bough-fmu-XXXXXX", above && *above ? above : "/tmp");
    archive a;
    if (!mkdtemp(made)) return cannot_write(made);
    bough_arena_on_destroy(arena, remove_folder, made);
    *folder = made;
    bough_arena *own = bough_arena_child(arena);
    bough_status status = open_archive(own, path, &a);
    while (bough_is_ok(&status) && a.left > 0) status = unpack_entry(own, &a, made);
    bough_arena_destroy(own);
    return status;
}
