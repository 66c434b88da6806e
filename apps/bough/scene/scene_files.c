#include "apps/bough/scene/scene_files.h"

#include "core/base/input_file.h"

#include <dirent.h>
#include <limits.h>
#include <sys/stat.h>

enum { MOST_DEPTH = 16 }; // of folders: a link may lead to a folder above it

typedef struct list {
    bough_arena *arena;
    bough_scene_files files;
    int room;
} list;

static bool is_file(const char *path) {
    struct stat about;
    return stat(path, &about) == 0 && S_ISREG(about.st_mode);
}

static bool is_folder(const char *path) {
    struct stat about;
    return stat(path, &about) == 0 && S_ISDIR(about.st_mode);
}

static void add(list *l, bough_scene_file file) {
    bough_scene_files *f = &l->files;
    for (int k = 0; k < f->n; k++) {
        if (strcmp(f->item[k].path, file.path) == 0) return;
    }
    f->item = bough_arena_grow(l->arena, f->item, f->n, &l->room, sizeof *f->item);
    f->item[f->n++] = file;
}

// Sorted by name, so that a copy of the folder gives the same list.
static void add_folder(list *l, const bough_scene_file *folder, int depth) {
    struct dirent **entry;
    int n = depth < MOST_DEPTH ? scandir(folder->path, &entry, NULL, alphasort) : -1;
    for (int k = 0; k < n; k++) {
        const char *name = entry[k]->d_name;
        bool dots = strcmp(name, ".") == 0 || strcmp(name, "..") == 0;
        bough_scene_file inner = {folder->key, bough_arena_print(l->arena, "%s/%s", folder->path, name),
                                  folder->absolute};
        if (is_file(inner.path)) add(l, inner);
        if (!dots && is_folder(inner.path)) add_folder(l, &inner, depth + 1);
        free(entry[k]);
    }
    if (n >= 0) free(entry);
}

// A controller looks for files that its input names in the folder of the input.
static void add_words(list *l, const char *input) {
    static const char between[] = " \t\r\n\"',;=()";
    char why[BOUGH_INPUT_REASON];
    size_t size;
    bough_arena *own = bough_arena_child(l->arena);
    char *text = bough_input_read(own, input, BOUGH_INPUT_TEXT, &size, why), *rest = text;
    int folder = (int)(bough_file_name(input) - input);
    for (char *word; text && (word = strtok_r(rest, between, &rest));) {
        char path[PATH_MAX];
        bool absolute = word[0] == '/';
        int length = snprintf(path, sizeof path, "%.*s%s", absolute ? 0 : folder, input, word);
        if (length >= (int)sizeof path || !is_file(path)) continue;
        add(l, (bough_scene_file){"control.input", bough_arena_string(l->arena, path), absolute});
    }
    bough_arena_destroy(own);
}

// The list has the last file first.
static void add_named(list *l, const bough_schema_file *file) {
    if (!file) return;
    add_named(l, file->next);
    if (file->schema) return;
    bough_scene_file named = {file->key, file->path, file->absolute};
    if (is_folder(file->path)) {
        add_folder(l, &named, 0);
    } else {
        add(l, named);
    }
}

bough_scene_files bough_scene_list_files(bough_arena *arena, const bough_scene *scene) {
    list l = {.arena = arena};
    add(&l, (bough_scene_file){"", scene->file, false});
    add_named(&l, scene->named);
    const bough_scene_control *control = &scene->control;
    if (control->node && control->kind == BOUGH_SCENE_BLADED && control->input[0])
        add_words(&l, control->input);
    return l.files;
}

// -- fingerprints ---------------------------------------------------------------------------------

void bough_mix(uint64_t *hash, const void *bytes, size_t n) {
    const unsigned char *byte = bytes;
    for (size_t i = 0; i < n; i++) *hash = (*hash ^ byte[i]) * UINT64_C(1099511628211);
}

void bough_mix_text(uint64_t *hash, const char *text) { bough_mix(hash, text, strlen(text) + 1); }

// The same for large files, eight bytes at a time, with zeros after the last ones.
static void mix_words(uint64_t *hash, const char *bytes, size_t n) {
    for (size_t i = 0; i < n; i += 8) {
        uint64_t word = 0;
        memcpy(&word, bytes + i, n - i < 8 ? n - i : 8);
        *hash = (*hash ^ word) * UINT64_C(1099511628211);
        *hash ^= *hash >> 32; // a product changes the upper half only
    }
    bough_mix(hash, &n, sizeof n);
}

// Adds the content of a file; nothing of one that cannot be read.
static void mix_file(uint64_t *hash, const char *path) {
    char block[1 << 16], why[BOUGH_INPUT_REASON];
    FILE *file = bough_input_open(path, BOUGH_INPUT_DATA, why);
    if (!file) return;
    for (size_t n; (n = fread(block, 1, sizeof block, file)) > 0;) mix_words(hash, block, n);
    fclose(file);
}

struct bough_file_sum {
    struct bough_file_sum *next;
    const char *path;
    uint64_t sum;
};

static uint64_t sum_of(bough_file_sums *sums, const char *path) {
    for (const struct bough_file_sum *s = sums->known; s; s = s->next) {
        if (strcmp(s->path, path) == 0) return s->sum;
    }
    struct bough_file_sum *s = bough_arena_take(sums->arena, sizeof *s);
    *s = (struct bough_file_sum){sums->known, bough_arena_string(sums->arena, path), BOUGH_FINGERPRINT_START};
    mix_file(&s->sum, path);
    sums->known = s;
    return s->sum;
}

void bough_mix_scene(uint64_t *hash, bough_file_sums *sums, const bough_scene *scene) {
    bough_arena *own = bough_arena_child(sums->arena);
    bough_scene_files files = bough_scene_list_files(own, scene);
    for (int k = 0; k < files.n; k++) {
        uint64_t sum = sum_of(sums, files.item[k].path);
        bough_mix_text(hash, files.item[k].key);
        bough_mix(hash, &sum, sizeof sum);
    }
    bough_arena_destroy(own);
}

void bough_mix_program(uint64_t *hash) { mix_file(hash, "/proc/self/exe"); }
