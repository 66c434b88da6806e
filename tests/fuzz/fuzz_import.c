#include "apps/bough/import/import.h"
#include "apps/bough/results/folder.h"
#include "apps/bough/scene/scene.h"
#include "tests/fuzz/fuzz.h"
#include "tests/unit/decks.h"

enum { ROOM = 1 << 16 };

typedef struct deck {
    char text[ROOM];
    size_t size;
} deck;

static deck original[N_DECK];

static void load(int i) {
    char path[512];
    snprintf(path, sizeof path, "%s/tests/data/decks/%s", BOUGH_SOURCE_DIR, decks[i]);
    FILE *file = fopen(path, "rb");
    fuzz_demand(file != NULL, path);
    original[i].size = fread(original[i].text, 1, ROOM, file);
    fclose(file);
    fuzz_file(decks[i], original[i].text, original[i].size);
}

static void start(void) {
    static int started;
    if (started) return;
    started = 1;
    for (int k = 0; k < N_DECK_FOLDER; k++) {
        char path[SCRATCH_PATH];
        snprintf(path, sizeof path, "%s/%s", fuzz_folder(), deck_folders[k]);
        bough_status status = bough_folder_make(path);
        fuzz_demand(bough_is_ok(&status), "a folder for decks");
    }
    for (int i = 0; i < N_DECK; i++) load(i);
}

// The deck that begins most like the input.
static int likest(const uint8_t *data, size_t size) {
    int best = 0;
    size_t most = 0;
    for (int i = 0; i < N_DECK; i++) {
        const deck *d = &original[i];
        size_t same = 0;
        while (same < size && same < d->size && data[same] == (uint8_t)d->text[same]) same++;
        if (same > most) best = i;
        if (same > most) most = same;
    }
    return best;
}

// What becomes a scene can be read as one.
static void read_scene(const char *folder) {
    char path[SCRATCH_PATH + 32];
    bough_arena *arena = bough_arena_create();
    bough_errors errors = {.arena = arena};
    bough_scene *scene;
    snprintf(path, sizeof path, "%s/scene.yaml", folder);
    bough_status status = bough_scene_read(arena, NULL, path, NULL, 0, &errors, &scene);
    if (!bough_is_ok(&status)) bough_errors_print(&errors, stderr);
    fuzz_demand(bough_is_ok(&status), "a scene that can be read");
    bough_arena_destroy(arena);
}

// Any bytes as a file of a model that is good otherwise.
int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
    char path[SCRATCH_PATH], out[SCRATCH_PATH];
    start();
    int i = likest(data, size), version = decks[i][0] == 'v' ? 3 : 0;
    snprintf(path, sizeof path, "%s/%.*smain.fst", fuzz_folder(), version, decks[i]);
    snprintf(out, sizeof out, "%s/out", fuzz_folder());
    fuzz_file(decks[i], data, size);
    bough_status status = bough_import_openfast(path, out, &(bough_import_options){0}, NULL);
    fuzz_demand(bough_is_ok(&status) || status.message[0], "a reason");
    if (bough_is_ok(&status)) read_scene(out);
    fuzz_file(decks[i], original[i].text, original[i].size);
    return 0;
}
