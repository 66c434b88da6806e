// Feeds a target without libFuzzer: every seed as it is, then mutations of them, always the same.
// BOUGH_FUZZ_COUNT is their number, or BOUGH_FUZZ_SECONDS the time. driver STATE SEED...; what a crash was
// fed stays in the file STATE, and `driver STATE STATE` with a count of 0 feeds it again.
#include "tests/fuzz/fuzz.h"

#include <dirent.h>
#include <string.h>
#include <sys/stat.h>
#include <time.h>

enum { MOST_SEEDS = 200, MOST_BYTES = 1 << 16, COUNT = 1500, CHANGES = 6 };

typedef struct seed {
    uint8_t *data;
    size_t size;
} seed;

typedef struct fuzzer {
    uint64_t random;
    int n;
    seed item[MOST_SEEDS];
    const char *state;
    uint8_t data[MOST_BYTES];
    size_t size;
} fuzzer;

// What parsers trip over.
static const char *const words[] = {
    "\n",         "\n  ",
    "- ",         ": ",
    "{",          "}",
    "[",          "]",
    "&a ",        "*a",
    "<<: *a",     "!t ",
    "|",          ">",
    "'",          "\"",
    "#",          "0",
    "-1",         "1e999",
    "-1e308",     "1e-320",
    "nan",        "inf",
    "0x1p9",      "99999999999999999999",
    "2147483648", "1 s",
    "deg",        "m^99",
    ".",          ",",
    "\t",         "\x80",
    "\xff\xfe",   "\xef\xbb\xbf",
    "%",          "@",
    "---\n",      "...\n",
};
enum { WORDS = sizeof words / sizeof *words };

// -- mutations ------------------------------------------------------------------------------------

static size_t below(fuzzer *f, size_t n) { // xorshift64*
    f->random ^= f->random >> 12;
    f->random ^= f->random << 25;
    f->random ^= f->random >> 27;
    return (size_t)((f->random * UINT64_C(2685821657736338717)) >> 33) % n;
}

// Puts bytes in place of `gone` others at `at`, if there is room.
static void splice(fuzzer *f, size_t at, size_t gone, const void *bytes, size_t n) {
    if (gone > f->size - at) gone = f->size - at;
    if (f->size - gone + n > MOST_BYTES) return;
    memmove(f->data + at + n, f->data + at + gone, f->size - at - gone);
    memcpy(f->data + at, bytes, n);
    f->size += n - gone;
}

static void mix_in(fuzzer *f, size_t at) {
    const seed *other = &f->item[below(f, (size_t)f->n)];
    if (other->size == 0) return;
    size_t from = below(f, other->size), n = 1 + below(f, 200);
    splice(f, at, below(f, 2) * n, other->data + from, n < other->size - from ? n : other->size - from);
}

static void change(fuzzer *f) {
    size_t at = below(f, f->size + 1), width = 1 + below(f, 40);
    const char *word = words[below(f, WORDS)];
    uint8_t byte = (uint8_t)below(f, 256), again[40];
    switch (below(f, 7)) {
    case 0: splice(f, at, 0, word, strlen(word)); break;
    case 1: splice(f, at, width, word, strlen(word)); break;
    case 2: splice(f, at, 1, &byte, 1); break;
    case 3: splice(f, at, width, "", 0); break;
    case 4: f->size = below(f, 4) ? f->size : at; break;
    case 5: mix_in(f, at); break;
    default:
        if (width > f->size - at) width = f->size - at;
        memcpy(again, f->data + at, width);
        for (size_t i = below(f, 20); i > 0; i--) splice(f, at, 0, again, width);
    }
}

// -- seeds ----------------------------------------------------------------------------------------

static void add_file(fuzzer *f, const char *path) {
    FILE *file = fopen(path, "rb");
    fuzz_demand(file != NULL, path);
    fuzz_demand(f->n < MOST_SEEDS, "at most 200 seeds");
    seed *s = &f->item[f->n++];
    s->data = malloc(MOST_BYTES);
    fuzz_demand(s->data != NULL, "memory for a seed");
    s->size = fread(s->data, 1, MOST_BYTES, file);
    fclose(file);
}

static void add(fuzzer *f, const char *path) {
    struct stat about;
    fuzz_demand(stat(path, &about) == 0, path);
    if (!S_ISDIR(about.st_mode)) {
        add_file(f, path);
        return;
    }
    struct dirent **entry;
    int n = scandir(path, &entry, NULL, alphasort);
    for (int i = 0; i < n; i++) {
        char name[512];
        snprintf(name, sizeof name, "%s/%s", path, entry[i]->d_name);
        if (stat(name, &about) == 0 && S_ISREG(about.st_mode)) add_file(f, name);
        free(entry[i]);
    }
    if (n >= 0) free(entry);
}

// -- running --------------------------------------------------------------------------------------

static void feed(fuzzer *f) {
    remove(f->state);
    FILE *state = fopen(f->state, "wb");
    if (state) fwrite(f->data, 1, f->size, state);
    if (state) fclose(state);
    // A block of its own size, so that a sanitizer sees who reads beyond it.
    uint8_t *copy = malloc(f->size ? f->size : 1);
    fuzz_demand(copy != NULL, "memory for an input");
    memcpy(copy, f->data, f->size);
    LLVMFuzzerTestOneInput(copy, f->size);
    free(copy);
}

static void start_from(fuzzer *f, const seed *s) {
    memcpy(f->data, s->data, s->size);
    f->size = s->size;
}

int main(int argc, char **argv) {
    static fuzzer f = {.random = UINT64_C(88172645463325252)};
    const char *count = getenv("BOUGH_FUZZ_COUNT");
    const char *seconds = getenv("BOUGH_FUZZ_SECONDS");
    long n = count ? strtol(count, NULL, 10) : COUNT, done = 0;
    time_t end = seconds ? time(NULL) + strtol(seconds, NULL, 10) : 0;
    fuzz_demand(argc > 2, "usage: driver STATE SEED...");
    f.state = argv[1];
    for (int i = 2; i < argc; i++) add(&f, argv[i]);
    for (int i = 0; i < f.n; i++) {
        start_from(&f, &f.item[i]);
        feed(&f);
    }
    for (; seconds ? time(NULL) < end : done < n; done++) {
        start_from(&f, &f.item[below(&f, (size_t)f.n)]);
        for (size_t changes = 1 + below(&f, CHANGES); changes > 0; changes--) change(&f);
        feed(&f);
    }
    for (int i = 0; i < f.n; i++) free(f.item[i].data);
    remove(f.state);
    printf("%d seeds, %ld mutations\n", f.n, done);
    return 0;
}
